// Arithmetic on lanes: one double for the scalar twin, or a register full. Included by kernel files only; everything stays in an unnamed
// namespace because the same text is compiled for several instruction sets. All lane types round every operation alike, so all give the same bits.
#pragma once

#include <cstddef>
#include <cstdint>

/// For operations on registers: a call would pass them through memory, and where kernels grow, compilers begin to call.
#define PELLETLAB_LANES [[gnu::always_inline]]

namespace pelletlab::solver::detail {
namespace {

/// The scalar twin: one lane.
struct ScalarLanes {
    using Real = double;
    using Mask = bool;
    static constexpr std::size_t width = 1;
    PELLETLAB_LANES static Real load(const double* p) { return *p; }
    PELLETLAB_LANES static void store(double* p, Real a) { *p = a; }
    PELLETLAB_LANES static Real all(double a) { return a; }
    PELLETLAB_LANES static Real square_root(Real a) { return __builtin_sqrt(a); }
    PELLETLAB_LANES static Real smaller(Real a, Real b) { return a < b ? a : b; }
    PELLETLAB_LANES static Real larger(Real a, Real b) { return a > b ? a : b; }
    PELLETLAB_LANES static Real choose(Mask m, Real a, Real b) { return m ? a : b; }
    PELLETLAB_LANES static Mask greater(Real a, Real b) { return a > b; }
    PELLETLAB_LANES static unsigned bits(Mask m) { return m ? 1u : 0u; }
    /// Column k of the rows at p[0] … p[width − 1], eight columns each.
    PELLETLAB_LANES static void load_rows(const double* const* p, Real* column) {
        for (int k = 0; k < 8; ++k) column[k] = p[0][k];
    }
    PELLETLAB_LANES static void load_float_rows(const float* const* p, Real* column) {
        for (int k = 0; k < 8; ++k) column[k] = static_cast<double>(p[0][k]);
    }
    PELLETLAB_LANES static void store_rows(double* const* p, const Real* column) {
        for (int k = 0; k < 8; ++k) p[0][k] = column[k];
    }
    /// Four columns.
    PELLETLAB_LANES static void load_short_rows(const double* const* p, Real* column) {
        for (int k = 0; k < 4; ++k) column[k] = p[0][k];
    }
    PELLETLAB_LANES static void store_short_rows(double* const* p, const Real* column) {
        for (int k = 0; k < 4; ++k) p[0][k] = column[k];
    }
    /// Writes the lanes whose bit is set, one after the other, and may write rubbish behind them, up to `width` numbers in all.
    PELLETLAB_LANES static void store_chosen(double* p, unsigned, Real a) { *p = a; }
};

/// to += from, eight columns.
template <class L>
PELLETLAB_LANES inline void add_row(double* to, const double* from) {
    for (std::size_t k = 0; k < 8; k += L::width) L::store(to + k, L::load(to + k) + L::load(from + k));
}

template <class V>
struct Triple {
    V x, y, z;
};

template <class V>
PELLETLAB_LANES inline Triple<V> operator+(const Triple<V>& a, const Triple<V>& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class V>
PELLETLAB_LANES inline Triple<V> operator-(const Triple<V>& a, const Triple<V>& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class V>
PELLETLAB_LANES inline Triple<V> operator*(const Triple<V>& a, const V& s) {
    return {a.x * s, a.y * s, a.z * s};
}
template <class V>
PELLETLAB_LANES inline V dot(const Triple<V>& a, const Triple<V>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class V>
PELLETLAB_LANES inline Triple<V> cross(const Triple<V>& a, const Triple<V>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Rotation matrix by rows.
template <class V>
struct Rotation {
    Triple<V> x, y, z;
};

template <class L, class V = typename L::Real>
PELLETLAB_LANES inline Rotation<V> rotation_of(const V& w, const V& x, const V& y, const V& z) {
    const V one = L::all(1.0), two = L::all(2.0);
    return {{one - two * (y * y + z * z), two * (x * y - w * z), two * (x * z + w * y)},
            {two * (x * y + w * z), one - two * (x * x + z * z), two * (y * z - w * x)},
            {two * (x * z - w * y), two * (y * z + w * x), one - two * (x * x + y * y)}};
}

template <class V>
PELLETLAB_LANES inline Triple<V> rotate(const Rotation<V>& r, const Triple<V>& a) {
    return {dot(r.x, a), dot(r.y, a), dot(r.z, a)};
}

/// Rᵀ a
template <class V>
PELLETLAB_LANES inline Triple<V> rotate_back(const Rotation<V>& r, const Triple<V>& a) {
    return r.x * a.x + r.y * a.y + r.z * a.z;
}

template <class V>
struct Turn {
    V w, x, y, z;
};

template <class V>
PELLETLAB_LANES inline Turn<V> product(const Turn<V>& a, const Turn<V>& b) {
    return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
            a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}

}  // namespace
}  // namespace pelletlab::solver::detail
