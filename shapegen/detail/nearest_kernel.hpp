// The inner loop of the fit: for eight points, which of a few spheres has the least |p − c| − r. Single precision; AVX2 where the machine has it.
#pragma once

#include <cstdint>
#include <vector>

namespace pelletlab::shapegen::detail {

/// Spheres in single precision, one array a coordinate.
struct SphereArrays {
    std::vector<float> x, y, z, radius;
    void resize(std::size_t n);
    std::size_t size() const { return x.size(); }
};

/// For 8 points: gap = least |p − c| − r over the candidates (at least one), nearest = which one (the first of equals).
/// The AVX2 version and its scalar twin give the same bits.
void nearest_of_candidates(const float* x, const float* y, const float* z, const std::uint32_t* candidates, std::size_t count, const SphereArrays& spheres,
                           float* gap, std::uint32_t* nearest);
void nearest_of_candidates_scalar(const float* x, const float* y, const float* z, const std::uint32_t* candidates, std::size_t count,
                                  const SphereArrays& spheres, float* gap, std::uint32_t* nearest);

/// distance[i] = |p − c_i| − r_i of the first `count` spheres from one point.
void distances_to_spheres(float x, float y, float z, const SphereArrays& spheres, std::size_t count, float* distance);
void distances_to_spheres_scalar(float x, float y, float z, const SphereArrays& spheres, std::size_t count, float* distance);

}  // namespace pelletlab::shapegen::detail
