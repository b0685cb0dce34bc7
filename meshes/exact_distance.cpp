#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "meshes/detail/clean.hpp"
#include "meshes/detail/topology.hpp"
#include "meshes/detail/triangle_tree.hpp"
#include "meshes/signed_distance.hpp"

namespace pelletlab::meshes {
namespace {

/// Throws unless every point off the surface has a clear side.
void require_two_sided(const TriangleMesh& mesh) {
    const char* remedy = "pass the mesh through require_closed_body first";
    if (mesh.empty()) throw bad_input("a mesh without triangles has no distance", remedy);
    for (const Triangle& t : mesh.faces)
        if (detail::is_degenerate(mesh, t)) throw bad_input("the signed distance needs triangles with an area", remedy);
    const std::vector<detail::HalfEdge> half_edges = detail::sorted_half_edges(mesh);
    detail::for_each_edge(half_edges, [&](const detail::HalfEdge* begin, const detail::HalfEdge* end) {
        if (end - begin != 2 || begin[0].forward == begin[1].forward)
            throw bad_input("the signed distance needs a closed and consistently oriented mesh", remedy);
    });
    if (!detail::pinched_vertices(mesh, half_edges).empty()) throw bad_input("the signed distance needs a mesh that does not touch itself in a point", remedy);
}

class ExactDistance final : public SignedDistance {
public:
    explicit ExactDistance(const TriangleMesh& mesh);
    double value(const Vec3& p) const override { return sample(p).value; }
    Vec3 gradient(const Vec3& p) const override { return sample(p).gradient; }
    double error_bound() const override { return error_bound_; }
    DistanceSample sample(const Vec3& p) const override;

private:
    /// Pseudonormals of one triangle's three corners, three sides and inside: a unit vector, or on sides and corners a positive multiple.
    using FaceNormals = std::array<Vec3, 7>;

    /// The corner or side of the triangle that the point lies on within rounding, else its inside.
    std::size_t feature_at(std::uint32_t face, const Vec3& p) const;

    TriangleMesh mesh_;
    detail::TriangleTree tree_;
    std::vector<FaceNormals> normals_;
    double error_bound_ = 0.0;
    double on_surface_ = 0.0;  ///< [m], closer than this the direction to the nearest point is noise
};

ExactDistance::ExactDistance(const TriangleMesh& mesh) : mesh_((require_two_sided(mesh), mesh)), tree_(mesh), normals_(mesh.faces.size()) {
    std::vector<Vec3> at_vertex(mesh.vertices.size(), Vec3::Zero());
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const Vec3 a = mesh.corner(f, 0), b = mesh.corner(f, 1), c = mesh.corner(f, 2);
        const Vec3 normal = (b - a).cross(c - a).normalized();
        normals_[f][6] = normal;
        for (int k = 0; k < 3; ++k) {
            const Vec3 p = mesh.corner(f, k), u = mesh.corner(f, (k + 1) % 3) - p, v = mesh.corner(f, (k + 2) % 3) - p;
            const double angle = std::atan2(u.cross(v).norm(), u.dot(v));
            at_vertex[mesh.faces[f][static_cast<std::size_t>(k)]] += angle * normal;
        }
    }
    detail::for_each_edge(detail::sorted_half_edges(mesh), [&](const detail::HalfEdge* begin, const detail::HalfEdge*) {
        const Vec3 sum = (normals_[begin[0].face][6] + normals_[begin[1].face][6]).normalized();
        for (int i = 0; i < 2; ++i) normals_[begin[i].face][3U + begin[i].side] = sum;
    });
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
        for (std::size_t k = 0; k < 3; ++k) normals_[f][k] = at_vertex[mesh.faces[f][k]].normalized();
    const Box box = bounding_box(mesh);
    const double magnitude = std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff()) + box.diagonal().norm();
    error_bound_ = 16.0 * std::numeric_limits<double>::epsilon() * magnitude;  // a handful of roundings of coordinates
    on_surface_ = error_bound_;
}

std::size_t ExactDistance::feature_at(std::uint32_t face, const Vec3& p) const {
    for (int k = 0; k < 3; ++k)
        if ((p - mesh_.corner(face, k)).norm() <= 2.0 * on_surface_) return static_cast<std::size_t>(k);
    for (int k = 0; k < 3; ++k) {
        const Vec3 a = mesh_.corner(face, k), side = mesh_.corner(face, (k + 1) % 3) - a;
        if (side.cross(p - a).norm() <= 2.0 * on_surface_ * side.norm()) return static_cast<std::size_t>(3 + k);
    }
    return 6;
}

DistanceSample ExactDistance::sample(const Vec3& p) const {
    const detail::NearestPoint nearest = tree_.nearest(p);
    const Vec3& normal = normals_[nearest.face][static_cast<std::size_t>(nearest.feature)];
    const Vec3 offset = p - nearest.point;
    const double distance = std::sqrt(nearest.squared_distance);
    const double sign = offset.dot(normal) < 0.0 ? -1.0 : 1.0;
    if (distance <= on_surface_) return {sign * distance, normals_[nearest.face][feature_at(nearest.face, p)]};
    return {sign * distance, offset * (sign / offset.norm())};
}

}  // namespace

std::unique_ptr<SignedDistance> exact_signed_distance(const TriangleMesh& mesh) {
    return std::make_unique<ExactDistance>(mesh);
}

}  // namespace pelletlab::meshes
