#include "shapegen/detail/sample_blocks.hpp"

#include <algorithm>
#include <cmath>

namespace pelletlab::shapegen::detail {

namespace {

// Ball around points[begin, end), its radius rounded up.
void add_ball(const std::vector<Vec3>& points, std::size_t begin, std::size_t end, std::vector<float>& x, std::vector<float>& y, std::vector<float>& z,
              std::vector<float>& radius) {
    Box box;
    for (std::size_t i = begin; i < end; ++i) box.extend(points[i]);
    const Vec3 c = box.center();
    double reach = 0.0;
    for (std::size_t i = begin; i < end; ++i) reach = std::max(reach, (points[i] - c).norm());
    x.push_back(static_cast<float>(c.x()));
    y.push_back(static_cast<float>(c.y()));
    z.push_back(static_cast<float>(c.z()));
    radius.push_back(static_cast<float>(reach * (1.0 + 1e-6) + 1e-6));
}

}  // namespace

SampleBlocks make_blocks(SurfaceSamples samples) {
    SampleBlocks blocks;
    const std::size_t count = samples.points.size() / SampleBlocks::width * SampleBlocks::width;
    samples.points.resize(count);
    samples.normals.resize(count);
    blocks.points = std::move(samples.points);
    blocks.normals = std::move(samples.normals);
    blocks.weight.assign(count, 1.0);
    for (const Vec3& p : blocks.points) {
        blocks.x.push_back(static_cast<float>(p.x()));
        blocks.y.push_back(static_cast<float>(p.y()));
        blocks.z.push_back(static_cast<float>(p.z()));
    }
    for (std::size_t i = 0; i < count; i += SampleBlocks::width) {
        add_ball(blocks.points, i, i + SampleBlocks::width, blocks.ball_x, blocks.ball_y, blocks.ball_z, blocks.ball_radius);
    }
    constexpr std::size_t stretch = SampleBlocks::width * SampleBlocks::group;
    for (std::size_t i = 0; i < count; i += stretch) {
        add_ball(blocks.points, i, std::min(count, i + stretch), blocks.group_x, blocks.group_y, blocks.group_z, blocks.group_radius);
    }
    return blocks;
}

}  // namespace pelletlab::shapegen::detail
