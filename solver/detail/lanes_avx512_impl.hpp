// Eight doubles in a register. Included by kernel files compiled for AVX-512 (F, VL, DQ) only.
#pragma once

#include "solver/detail/lanes_avx2_impl.hpp"

namespace pelletlab::solver::detail {
namespace {

struct Real8 {
    __m512d v;
    PELLETLAB_LANES friend Real8 operator+(Real8 a, Real8 b) { return {_mm512_add_pd(a.v, b.v)}; }
    PELLETLAB_LANES friend Real8 operator-(Real8 a, Real8 b) { return {_mm512_sub_pd(a.v, b.v)}; }
    PELLETLAB_LANES friend Real8 operator*(Real8 a, Real8 b) { return {_mm512_mul_pd(a.v, b.v)}; }
    PELLETLAB_LANES friend Real8 operator/(Real8 a, Real8 b) { return {_mm512_div_pd(a.v, b.v)}; }
};

/// Eight rows become eight columns: pairs of lanes, then quarters, then halves.
PELLETLAB_LANES inline void transpose8(__m512d* r) {
    __m512d t[8];
    for (int k = 0; k < 8; k += 2) {
        t[k] = _mm512_unpacklo_pd(r[k], r[k + 1]);
        t[k + 1] = _mm512_unpackhi_pd(r[k], r[k + 1]);
    }
    __m512d u[8];
    for (int k = 0; k < 2; ++k) {
        u[k] = _mm512_shuffle_f64x2(t[k], t[k + 2], 0x88);
        u[k + 2] = _mm512_shuffle_f64x2(t[k], t[k + 2], 0xdd);
        u[k + 4] = _mm512_shuffle_f64x2(t[k + 4], t[k + 6], 0x88);
        u[k + 6] = _mm512_shuffle_f64x2(t[k + 4], t[k + 6], 0xdd);
    }
    for (int k = 0; k < 4; ++k) {
        r[k] = _mm512_shuffle_f64x2(u[k], u[k + 4], 0x88);
        r[k + 4] = _mm512_shuffle_f64x2(u[k], u[k + 4], 0xdd);
    }
}

struct Avx512Lanes {
    using Real = Real8;
    using Mask = __mmask8;
    static constexpr std::size_t width = 8;
    PELLETLAB_LANES static Real load(const double* p) { return {_mm512_loadu_pd(p)}; }
    PELLETLAB_LANES static void store(double* p, Real a) { _mm512_storeu_pd(p, a.v); }
    PELLETLAB_LANES static Real all(double a) { return {_mm512_set1_pd(a)}; }
    PELLETLAB_LANES static Real square_root(Real a) { return {_mm512_sqrt_pd(a.v)}; }
    PELLETLAB_LANES static Real smaller(Real a, Real b) { return {_mm512_min_pd(a.v, b.v)}; }
    PELLETLAB_LANES static Real larger(Real a, Real b) { return {_mm512_max_pd(a.v, b.v)}; }
    PELLETLAB_LANES static Real choose(Mask m, Real a, Real b) { return {_mm512_mask_blend_pd(m, b.v, a.v)}; }
    PELLETLAB_LANES static Mask greater(Real a, Real b) { return _mm512_cmp_pd_mask(a.v, b.v, _CMP_GT_OQ); }
    PELLETLAB_LANES static unsigned bits(Mask m) { return m; }
    PELLETLAB_LANES static void load_rows(const double* const* p, Real* c) {
        __m512d r[8];
        for (int k = 0; k < 8; ++k) r[k] = _mm512_loadu_pd(p[k]);
        transpose8(r);
        for (int k = 0; k < 8; ++k) c[k].v = r[k];
    }
    PELLETLAB_LANES static void load_short_rows(const double* const* p, Real* c) {
        Real4 low[4], high[4];
        Avx2Lanes::load_short_rows(p, low);
        Avx2Lanes::load_short_rows(p + 4, high);
        for (int k = 0; k < 4; ++k) c[k].v = _mm512_insertf64x4(_mm512_castpd256_pd512(low[k].v), high[k].v, 1);
    }
    PELLETLAB_LANES static void store_short_rows(double* const* p, const Real* c) {
        Real4 low[4], high[4];
        for (int k = 0; k < 4; ++k) low[k].v = _mm512_castpd512_pd256(c[k].v), high[k].v = _mm512_extractf64x4_pd(c[k].v, 1);
        Avx2Lanes::store_short_rows(p, low);
        Avx2Lanes::store_short_rows(p + 4, high);
    }
    PELLETLAB_LANES static void load_float_rows(const float* const* p, Real* c) {
        __m512d r[8];
        for (int k = 0; k < 8; ++k) r[k] = _mm512_cvtps_pd(_mm256_loadu_ps(p[k]));
        transpose8(r);
        for (int k = 0; k < 8; ++k) c[k].v = r[k];
    }
    PELLETLAB_LANES static void store_rows(double* const* p, const Real* c) {
        __m512d r[8];
        for (int k = 0; k < 8; ++k) r[k] = c[k].v;
        transpose8(r);
        for (int k = 0; k < 8; ++k) _mm512_storeu_pd(p[k], r[k]);
    }
    PELLETLAB_LANES static void store_chosen(double* p, unsigned bits, Real a) {
        _mm512_storeu_pd(p, _mm512_maskz_compress_pd(static_cast<__mmask8>(bits), a.v));
    }
};

/// Four lanes again, with the chosen ones packed by one instruction.
struct Avx512ShortLanes : Avx2Lanes {
    using Mask = __mmask8;
    PELLETLAB_LANES static Real choose(Mask m, Real a, Real b) { return {_mm256_mask_blend_pd(m, b.v, a.v)}; }
    PELLETLAB_LANES static Mask greater(Real a, Real b) { return _mm256_cmp_pd_mask(a.v, b.v, _CMP_GT_OQ); }
    PELLETLAB_LANES static unsigned bits(Mask m) { return m; }
    PELLETLAB_LANES static void store_chosen(double* p, unsigned bits, Real a) {
        _mm256_storeu_pd(p, _mm256_maskz_compress_pd(static_cast<__mmask8>(bits), a.v));
    }
};

}  // namespace
}  // namespace pelletlab::solver::detail
