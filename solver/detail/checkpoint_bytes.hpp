// Numbers to bytes and back. What is read is checked: a damaged checkpoint ends in an error and not in a run.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

#include "core/error.hpp"
#include "core/vec.hpp"

namespace pelletlab::solver::detail {

class CheckpointWriter {
public:
    template <class T>
    void put(const T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
    }
    void put(const Vec3& v) {
        for (int k = 0; k < 3; ++k) put(v[k]);
    }
    void put(const Quat& q) {
        for (int k = 0; k < 4; ++k) put(q.coeffs()[k]);
    }
    std::string bytes;
};

class CheckpointReader {
public:
    CheckpointReader(std::string_view bytes, const std::string& file) : bytes_(bytes), file_(file) {}
    template <class T>
    T get() {
        need(sizeof(T));
        T value;
        std::memcpy(&value, bytes_.data() + at_, sizeof(T));
        at_ += sizeof(T);
        return value;
    }
    double get_number() {
        const auto x = get<double>();
        if (!std::isfinite(x)) broken();
        return x;
    }
    Vec3 get_vec() {
        Vec3 v;
        for (int k = 0; k < 3; ++k) v[k] = get_number();
        return v;
    }
    Quat get_quat() {
        Quat q;
        for (int k = 0; k < 4; ++k) q.coeffs()[k] = get_number();
        return q;
    }
    /// A count of things of `size` bytes each that must fit into what is left.
    std::size_t get_count(std::size_t size) {
        const auto n = get<std::uint64_t>();
        if (n > (bytes_.size() - at_) / size) broken();
        return static_cast<std::size_t>(n);
    }
    void end() const {
        if (at_ != bytes_.size()) broken();
    }
    [[noreturn]] void broken() const { throw bad_input("the checkpoint contradicts itself", "it is damaged: use an older one", {file_}); }

private:
    std::string_view bytes_;
    std::string file_;
    std::size_t at_ = 0;
    void need(std::size_t n) const {
        if (n > bytes_.size() - at_) broken();
    }
};

}  // namespace pelletlab::solver::detail
