// Square root, subtraction and comparison are exact operations of IEEE 754 in every width and nothing is fused, so both versions give the same bits.
#include "shapegen/detail/nearest_kernel.hpp"

#include <cmath>
#include <limits>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace pelletlab::shapegen::detail {

void SphereArrays::resize(std::size_t n) {
    x.resize(n);
    y.resize(n);
    z.resize(n);
    radius.resize(n);
}

void nearest_of_candidates_scalar(const float* x, const float* y, const float* z, const std::uint32_t* candidates, std::size_t count,
                                  const SphereArrays& spheres, float* gap, std::uint32_t* nearest) {
    for (int k = 0; k < 8; ++k) {
        gap[k] = std::numeric_limits<float>::max();
        nearest[k] = 0;
        for (std::size_t c = 0; c < count; ++c) {
            const std::uint32_t i = candidates[c];
            const float dx = x[k] - spheres.x[i], dy = y[k] - spheres.y[i], dz = z[k] - spheres.z[i];
            const float d = std::sqrt(dx * dx + dy * dy + dz * dz) - spheres.radius[i];
            if (d < gap[k]) {
                gap[k] = d;
                nearest[k] = i;
            }
        }
    }
}

void distances_to_spheres_scalar(float x, float y, float z, const SphereArrays& spheres, std::size_t count, float* distance) {
    for (std::size_t i = 0; i < count; ++i) {
        const float dx = x - spheres.x[i], dy = y - spheres.y[i], dz = z - spheres.z[i];
        distance[i] = std::sqrt(dx * dx + dy * dy + dz * dz) - spheres.radius[i];
    }
}

#if defined(__x86_64__)

namespace {

__attribute__((target("avx2"))) void nearest_avx2(const float* x, const float* y, const float* z, const std::uint32_t* candidates, std::size_t count,
                                                  const SphereArrays& spheres, float* gap, std::uint32_t* nearest) {
    const __m256 px = _mm256_loadu_ps(x), py = _mm256_loadu_ps(y), pz = _mm256_loadu_ps(z);
    __m256 best = _mm256_set1_ps(std::numeric_limits<float>::max());
    __m256 which = _mm256_setzero_ps();  // integers, blended as floats
    for (std::size_t c = 0; c < count; ++c) {
        const std::uint32_t i = candidates[c];
        const __m256 dx = _mm256_sub_ps(px, _mm256_broadcast_ss(&spheres.x[i]));
        const __m256 dy = _mm256_sub_ps(py, _mm256_broadcast_ss(&spheres.y[i]));
        const __m256 dz = _mm256_sub_ps(pz, _mm256_broadcast_ss(&spheres.z[i]));
        const __m256 squared = _mm256_add_ps(_mm256_add_ps(_mm256_mul_ps(dx, dx), _mm256_mul_ps(dy, dy)), _mm256_mul_ps(dz, dz));
        const __m256 d = _mm256_sub_ps(_mm256_sqrt_ps(squared), _mm256_broadcast_ss(&spheres.radius[i]));
        const __m256 closer = _mm256_cmp_ps(d, best, _CMP_LT_OQ);
        best = _mm256_blendv_ps(best, d, closer);
        which = _mm256_blendv_ps(which, _mm256_castsi256_ps(_mm256_set1_epi32(static_cast<int>(i))), closer);
    }
    _mm256_storeu_ps(gap, best);
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(nearest), _mm256_castps_si256(which));
}

__attribute__((target("avx2"))) void distances_avx2(float x, float y, float z, const SphereArrays& spheres, std::size_t count, float* distance) {
    const __m256 px = _mm256_set1_ps(x), py = _mm256_set1_ps(y), pz = _mm256_set1_ps(z);
    std::size_t i = 0;
    for (; i + 8 <= count; i += 8) {
        const __m256 dx = _mm256_sub_ps(px, _mm256_loadu_ps(&spheres.x[i]));
        const __m256 dy = _mm256_sub_ps(py, _mm256_loadu_ps(&spheres.y[i]));
        const __m256 dz = _mm256_sub_ps(pz, _mm256_loadu_ps(&spheres.z[i]));
        const __m256 squared = _mm256_add_ps(_mm256_add_ps(_mm256_mul_ps(dx, dx), _mm256_mul_ps(dy, dy)), _mm256_mul_ps(dz, dz));
        _mm256_storeu_ps(distance + i, _mm256_sub_ps(_mm256_sqrt_ps(squared), _mm256_loadu_ps(&spheres.radius[i])));
    }
    for (; i < count; ++i) {
        const float dx = x - spheres.x[i], dy = y - spheres.y[i], dz = z - spheres.z[i];
        distance[i] = std::sqrt(dx * dx + dy * dy + dz * dz) - spheres.radius[i];
    }
}

bool has_avx2() {
    static const bool yes = __builtin_cpu_supports("avx2") != 0;
    return yes;
}

}  // namespace

void nearest_of_candidates(const float* x, const float* y, const float* z, const std::uint32_t* candidates, std::size_t count, const SphereArrays& spheres,
                           float* gap, std::uint32_t* nearest) {
    if (has_avx2()) {
        nearest_avx2(x, y, z, candidates, count, spheres, gap, nearest);
    } else {
        nearest_of_candidates_scalar(x, y, z, candidates, count, spheres, gap, nearest);
    }
}

void distances_to_spheres(float x, float y, float z, const SphereArrays& spheres, std::size_t count, float* distance) {
    if (has_avx2()) {
        distances_avx2(x, y, z, spheres, count, distance);
    } else {
        distances_to_spheres_scalar(x, y, z, spheres, count, distance);
    }
}

#else

void nearest_of_candidates(const float* x, const float* y, const float* z, const std::uint32_t* candidates, std::size_t count, const SphereArrays& spheres,
                           float* gap, std::uint32_t* nearest) {
    nearest_of_candidates_scalar(x, y, z, candidates, count, spheres, gap, nearest);
}

void distances_to_spheres(float x, float y, float z, const SphereArrays& spheres, std::size_t count, float* distance) {
    distances_to_spheres_scalar(x, y, z, spheres, count, distance);
}

#endif

}  // namespace pelletlab::shapegen::detail
