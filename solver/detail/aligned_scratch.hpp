// Scratch memory of one worker: contact batch and slots grow once and are used again for every block of pairs.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <new>
#include <utility>
#include <vector>

#include "solver/detail/kernels.hpp"

namespace pelletlab::solver::detail {

/// Owner of the arrays of a ContactBatch; padded so that a kernel may read and write full registers past the end.
class BatchStorage {
public:
    ContactBatch batch;

    /// Makes room for one more contact and returns its index.
    std::size_t add() {
        if (batch.size == capacity_) grow();
        return batch.size++;
    }
    /// Fills the padding behind the last contact with copies of harmless numbers, so that full registers hold no NaN.
    void pad() {
        if (capacity_ == 0) grow();
        for (std::size_t k = batch.size; k < batch.size + padding; ++k) {
            batch.nx[k] = 1.0, batch.ny[k] = 0.0, batch.nz[k] = 0.0;
            batch.overlap[k] = 1.0, batch.radius[k] = 1.0;
            batch.x[k] = batch.y[k] = batch.z[k] = 0.0;
            batch.sx[k] = batch.sy[k] = batch.sz[k] = 0.0;
            batch.slot[k] = 0;
        }
    }

private:
    static constexpr std::size_t padding = 8, array_count = 18;
    std::size_t capacity_ = 0;
    struct Free {
        void operator()(double* p) const { ::operator delete[](p, std::align_val_t{64}); }
    };
    std::unique_ptr<double[], Free> memory_;
    std::vector<std::uint32_t> slots_;

    void grow() {
        const std::size_t larger = capacity_ == 0 ? 512 : 2 * capacity_;
        const std::size_t stride = larger + padding;
        std::unique_ptr<double[], Free> fresh(static_cast<double*>(::operator new[](array_count* stride * sizeof(double), std::align_val_t{64})));
        double** fields[array_count] = {&batch.nx, &batch.ny, &batch.nz, &batch.overlap, &batch.radius, &batch.x,  &batch.y,  &batch.z,  &batch.sx,
                                        &batch.sy, &batch.sz, &batch.fx, &batch.fy,      &batch.fz,     &batch.mx, &batch.my, &batch.mz, &batch.normal_force};
        for (std::size_t f = 0; f < array_count; ++f) {
            double* target = fresh.get() + f * stride;
            for (std::size_t k = 0; k < batch.size; ++k) target[k] = (*fields[f])[k];
            *fields[f] = target;
        }
        memory_ = std::move(fresh);
        slots_.resize(stride, 0);
        batch.slot = slots_.data();
        capacity_ = larger;
    }
};

}  // namespace pelletlab::solver::detail
