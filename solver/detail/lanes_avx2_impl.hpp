// Four doubles in a register. Included by kernel files compiled for AVX2 or AVX-512 only.
#pragma once

#include <immintrin.h>

#include "solver/detail/lanes_impl.hpp"

namespace pelletlab::solver::detail {
namespace {

struct Real4 {
    __m256d v;
    PELLETLAB_LANES friend Real4 operator+(Real4 a, Real4 b) { return {_mm256_add_pd(a.v, b.v)}; }
    PELLETLAB_LANES friend Real4 operator-(Real4 a, Real4 b) { return {_mm256_sub_pd(a.v, b.v)}; }
    PELLETLAB_LANES friend Real4 operator*(Real4 a, Real4 b) { return {_mm256_mul_pd(a.v, b.v)}; }
    PELLETLAB_LANES friend Real4 operator/(Real4 a, Real4 b) { return {_mm256_div_pd(a.v, b.v)}; }
};

/// Rows a b c d become columns.
PELLETLAB_LANES inline void transpose4(__m256d& a, __m256d& b, __m256d& c, __m256d& d) {
    const __m256d ab_low = _mm256_unpacklo_pd(a, b), ab_high = _mm256_unpackhi_pd(a, b);
    const __m256d cd_low = _mm256_unpacklo_pd(c, d), cd_high = _mm256_unpackhi_pd(c, d);
    a = _mm256_permute2f128_pd(ab_low, cd_low, 0x20);
    b = _mm256_permute2f128_pd(ab_high, cd_high, 0x20);
    c = _mm256_permute2f128_pd(ab_low, cd_low, 0x31);
    d = _mm256_permute2f128_pd(ab_high, cd_high, 0x31);
}

/// For each set of bits: which halves (32 bits) of a register come to the front.
alignas(32) constexpr std::int32_t front_order[16][8] = {
    {0, 1, 2, 3, 4, 5, 6, 7}, {0, 1, 2, 3, 4, 5, 6, 7}, {2, 3, 0, 1, 4, 5, 6, 7}, {0, 1, 2, 3, 4, 5, 6, 7}, {4, 5, 0, 1, 2, 3, 6, 7}, {0, 1, 4, 5, 2, 3, 6, 7},
    {2, 3, 4, 5, 0, 1, 6, 7}, {0, 1, 2, 3, 4, 5, 6, 7}, {6, 7, 0, 1, 2, 3, 4, 5}, {0, 1, 6, 7, 2, 3, 4, 5}, {2, 3, 6, 7, 0, 1, 4, 5}, {0, 1, 2, 3, 6, 7, 4, 5},
    {4, 5, 6, 7, 0, 1, 2, 3}, {0, 1, 4, 5, 6, 7, 2, 3}, {2, 3, 4, 5, 6, 7, 0, 1}, {0, 1, 2, 3, 4, 5, 6, 7}};

struct Avx2Lanes {
    using Real = Real4;
    using Mask = Real4;
    static constexpr std::size_t width = 4;
    PELLETLAB_LANES static Real load(const double* p) { return {_mm256_loadu_pd(p)}; }
    PELLETLAB_LANES static void store(double* p, Real a) { _mm256_storeu_pd(p, a.v); }
    PELLETLAB_LANES static Real all(double a) { return {_mm256_set1_pd(a)}; }
    PELLETLAB_LANES static Real square_root(Real a) { return {_mm256_sqrt_pd(a.v)}; }
    PELLETLAB_LANES static Real smaller(Real a, Real b) { return {_mm256_min_pd(a.v, b.v)}; }
    PELLETLAB_LANES static Real larger(Real a, Real b) { return {_mm256_max_pd(a.v, b.v)}; }
    PELLETLAB_LANES static Real choose(Mask m, Real a, Real b) { return {_mm256_blendv_pd(b.v, a.v, m.v)}; }
    PELLETLAB_LANES static Mask greater(Real a, Real b) { return {_mm256_cmp_pd(a.v, b.v, _CMP_GT_OQ)}; }
    PELLETLAB_LANES static unsigned bits(Mask m) { return static_cast<unsigned>(_mm256_movemask_pd(m.v)); }
    PELLETLAB_LANES static void load_short_rows(const double* const* p, Real* c) {
        __m256d a = _mm256_loadu_pd(p[0]), b = _mm256_loadu_pd(p[1]), e = _mm256_loadu_pd(p[2]), d = _mm256_loadu_pd(p[3]);
        transpose4(a, b, e, d);
        c[0].v = a, c[1].v = b, c[2].v = e, c[3].v = d;
    }
    PELLETLAB_LANES static void store_short_rows(double* const* p, const Real* c) {
        __m256d a = c[0].v, b = c[1].v, e = c[2].v, d = c[3].v;
        transpose4(a, b, e, d);
        _mm256_storeu_pd(p[0], a), _mm256_storeu_pd(p[1], b), _mm256_storeu_pd(p[2], e), _mm256_storeu_pd(p[3], d);
    }
    PELLETLAB_LANES static void load_rows(const double* const* p, Real* c) {
        const double* second[4] = {p[0] + 4, p[1] + 4, p[2] + 4, p[3] + 4};
        load_short_rows(p, c);
        load_short_rows(second, c + 4);
    }
    PELLETLAB_LANES static void load_float_rows(const float* const* p, Real* c) {
        for (int half = 0; half < 2; ++half) {
            __m256d r[4];
            for (int k = 0; k < 4; ++k) r[k] = _mm256_cvtps_pd(_mm_loadu_ps(p[k] + 4 * half));
            transpose4(r[0], r[1], r[2], r[3]);
            for (int k = 0; k < 4; ++k) c[4 * half + k].v = r[k];
        }
    }
    PELLETLAB_LANES static void store_rows(double* const* p, const Real* c) {
        for (int half = 0; half < 2; ++half) {
            __m256d r[4];
            for (int k = 0; k < 4; ++k) r[k] = c[4 * half + k].v;
            transpose4(r[0], r[1], r[2], r[3]);
            for (int k = 0; k < 4; ++k) _mm256_storeu_pd(p[k] + 4 * half, r[k]);
        }
    }
    PELLETLAB_LANES static void store_chosen(double* p, unsigned bits, Real a) {
        const __m256i order = _mm256_load_si256(reinterpret_cast<const __m256i*>(front_order[bits]));
        _mm256_storeu_pd(p, _mm256_castps_pd(_mm256_permutevar8x32_ps(_mm256_castpd_ps(a.v), order)));
    }
};

}  // namespace
}  // namespace pelletlab::solver::detail
