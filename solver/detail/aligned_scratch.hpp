// Scratch memory of one worker: grows and is used again for every block of pairs.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "solver/detail/kernels.hpp"

namespace pelletlab::solver::detail {

/// Owner of the arrays of a ContactBatch, with room for a full register behind the last contact.
class BatchStorage {
public:
    ContactBatch batch{};

    /// Makes room for `count` contacts; what the batch holds stays.
    void reserve(std::size_t count, bool booked) {
        if (count > capacity_) grow(count);
        if (booked && books_.size() < results_.size()) books_.resize(results_.size());
        batch.book = books_.data();
    }

private:
    static constexpr std::size_t array_count = 9;
    std::size_t capacity_ = 0;
    std::vector<double> numbers_;
    std::vector<std::uint32_t> indices_;
    std::vector<LoadRow> results_, books_;

    void grow(std::size_t count) {
        const std::size_t larger = std::max<std::size_t>({count, 2 * capacity_, 256}), stride = larger + 2 * widest;
        std::vector<double> numbers(array_count * stride);
        std::vector<std::uint32_t> indices(2 * stride);
        double** fields[array_count] = {&batch.dx, &batch.dy, &batch.dz, &batch.ax, &batch.ay, &batch.az, &batch.ra, &batch.rb, &batch.share};
        for (std::size_t f = 0; f < array_count; ++f) {
            double* target = numbers.data() + f * stride;
            std::copy_n(*fields[f], batch.size, target);
            *fields[f] = target;
        }
        std::uint32_t** index_fields[2] = {&batch.slot, &batch.spring};
        for (std::size_t f = 0; f < 2; ++f) {
            std::uint32_t* target = indices.data() + f * stride;
            std::copy_n(*index_fields[f], batch.size, target);
            *index_fields[f] = target;
        }
        numbers_ = std::move(numbers);
        indices_ = std::move(indices);
        results_.resize(stride);
        batch.result = results_.data();
        capacity_ = larger;
    }
};

/// Owner of the arrays of a PairScratch.
class PairScratchStorage {
public:
    PairScratch scratch{};

    void reserve(std::size_t pairs) {
        if (scratch.stale && pairs <= capacity_) return;
        capacity_ = pairs;
        const std::size_t stride = pairs + widest + 1;
        poses_.resize(stride);
        indices_.resize(3 * stride);
        stale_.resize(stride);
        counts_.resize(stride);
        slots_.resize(stride);
        rows_.resize(2 * stride);
        scratch.poses = poses_.data();
        scratch.stale = stale_.data();
        scratch.counts = counts_.data();
        scratch.active = indices_.data();
        scratch.first_contact = indices_.data() + stride;
        scratch.listed = indices_.data() + 2 * stride;
        scratch.slots = slots_.data();
        scratch.sums = rows_.data();
        scratch.loads_i = rows_.data() + stride;
    }

private:
    std::size_t capacity_ = 0;
    std::vector<PairPose> poses_;
    std::vector<std::uint32_t> indices_;
    std::vector<std::uint8_t> stale_;
    std::vector<std::uint16_t> counts_;
    std::vector<PairSlot> slots_;
    std::vector<LoadRow> rows_;
};

}  // namespace pelletlab::solver::detail
