// Surface points packed for the nearest-sphere search: groups of eight neighbours in single precision, each group with a ball around it.
#pragma once

#include <cstdint>
#include <vector>

#include "core/vec.hpp"
#include "shapegen/detail/surface_samples.hpp"

namespace pelletlab::shapegen::detail {

struct SampleBlocks {
    static constexpr std::size_t width = 8;                      ///< points of a block: one AVX2 register of floats
    static constexpr std::size_t group = 16;                     ///< blocks of a group, the coarse level of the search
    std::vector<Vec3> points, normals;                           ///< count rounded down to whole blocks
    std::vector<double> weight;                                  ///< of each point in the loss, 1 on average
    std::vector<float> x, y, z;                                  ///< the same points
    std::vector<float> ball_x, ball_y, ball_z, ball_radius;      ///< one a block
    std::vector<float> group_x, group_y, group_z, group_radius;  ///< one a group

    std::size_t size() const { return points.size(); }
    std::size_t block_count() const { return ball_x.size(); }
    std::size_t group_count() const { return group_x.size(); }
};

/// Needs samples in an order in which neighbours in the list are neighbours in space.
SampleBlocks make_blocks(SurfaceSamples samples);

}  // namespace pelletlab::shapegen::detail
