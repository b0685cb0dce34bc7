// Arithmetic on lanes: one double for the scalar twin, or a register full. Included by kernel files only; everything stays in an unnamed
// namespace because the same text is compiled for several instruction sets.
#pragma once

#include <cmath>
#include <cstddef>

namespace pelletlab::solver::detail {
namespace {

/// The scalar twin: one lane.
struct ScalarLanes {
    using Real = double;
    using Mask = bool;
    static constexpr std::size_t width = 1;
    static Real load(const double* p) { return *p; }
    static void store(double* p, Real a) { *p = a; }
    static Real all(double a) { return a; }
    static Real square_root(Real a) { return std::sqrt(a); }
    static Real smaller(Real a, Real b) { return a < b ? a : b; }
    static Real larger(Real a, Real b) { return a > b ? a : b; }
    static Real choose(Mask m, Real a, Real b) { return m ? a : b; }
    static Mask greater(Real a, Real b) { return a > b; }
};

template <class V>
struct Triple {
    V x, y, z;
};

template <class V>
inline Triple<V> operator+(const Triple<V>& a, const Triple<V>& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class V>
inline Triple<V> operator-(const Triple<V>& a, const Triple<V>& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class V>
inline Triple<V> operator*(const Triple<V>& a, const V& s) {
    return {a.x * s, a.y * s, a.z * s};
}
template <class V>
inline V dot(const Triple<V>& a, const Triple<V>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class V>
inline Triple<V> cross(const Triple<V>& a, const Triple<V>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

}  // namespace
}  // namespace pelletlab::solver::detail
