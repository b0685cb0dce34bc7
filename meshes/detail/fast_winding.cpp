#include "meshes/detail/fast_winding.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "meshes/detail/winding.hpp"

namespace pelletlab::meshes::detail {
namespace {

constexpr std::uint32_t leaf_size = 8;
constexpr double far_ratio = 3.0;

Vec3 centroid(const std::array<Vec3, 3>& t) {
    return (t[0] + t[1] + t[2]) / 3.0;
}
Vec3 area_normal(const std::array<Vec3, 3>& t) {
    return 0.5 * (t[1] - t[0]).cross(t[2] - t[0]);
}

}  // namespace

FastWinding::FastWinding(const TriangleMesh& mesh) {
    corners_.reserve(mesh.faces.size());
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) corners_.push_back({mesh.corner(f, 0), mesh.corner(f, 1), mesh.corner(f, 2)});
    if (!corners_.empty()) build(0, static_cast<std::uint32_t>(corners_.size()));
}

void FastWinding::build(std::uint32_t begin, std::uint32_t end) {
    Cluster cluster;
    cluster.begin = begin;
    cluster.end = end;
    double area = 0.0;
    Box box;
    for (std::uint32_t i = begin; i < end; ++i) {
        const double a = area_normal(corners_[i]).norm();
        area += a;
        cluster.centre += a * centroid(corners_[i]);
        box.extend(centroid(corners_[i]));
    }
    cluster.centre = area > 0.0 ? Vec3(cluster.centre / area) : box.center();
    for (std::uint32_t i = begin; i < end; ++i) {
        const Vec3 normal = area_normal(corners_[i]);
        cluster.dipole += normal;
        cluster.first += normal * (centroid(corners_[i]) - cluster.centre).transpose();
        for (const Vec3& corner : corners_[i]) cluster.radius = std::max(cluster.radius, (corner - cluster.centre).norm());
    }
    const std::size_t self = clusters_.size();
    clusters_.push_back(cluster);
    if (end - begin <= leaf_size) return;
    int axis = 0;
    box.sizes().maxCoeff(&axis);
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(corners_.begin() + begin, corners_.begin() + middle, corners_.begin() + end,
                     [axis](const auto& a, const auto& b) { return centroid(a)[axis] < centroid(b)[axis]; });
    build(begin, middle);
    clusters_[self].right = static_cast<std::uint32_t>(clusters_.size());
    build(middle, end);
}

double FastWinding::operator()(const Vec3& p) const {
    if (clusters_.empty()) return 0.0;
    double sum = 0.0;
    std::array<std::uint32_t, 64> stack;
    std::size_t depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
        const std::uint32_t index = stack[--depth];
        const Cluster& cluster = clusters_[index];
        const Vec3 r = cluster.centre - p;
        const double squared = r.squaredNorm();
        if (squared > far_ratio * far_ratio * cluster.radius * cluster.radius) {
            const double inverse = 1.0 / (squared * std::sqrt(squared));
            const double first = cluster.first.trace() - 3.0 * r.dot(cluster.first * r) / squared;
            sum += (cluster.dipole.dot(r) + first) * inverse / (4.0 * std::numbers::pi);
        } else if (cluster.right == 0) {
            for (std::uint32_t i = cluster.begin; i < cluster.end; ++i) sum += solid_angle_fraction(p, corners_[i][0], corners_[i][1], corners_[i][2]);
        } else {
            stack[depth++] = cluster.right;
            stack[depth++] = index + 1;
        }
    }
    return sum;
}

}  // namespace pelletlab::meshes::detail
