#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "meshes/detail/clean.hpp"
#include "meshes/detail/fast_winding.hpp"
#include "meshes/detail/triangle_tree.hpp"
#include "meshes/signed_distance.hpp"

namespace pelletlab::meshes {
namespace {

class WindingDistance final : public SignedDistance {
public:
    explicit WindingDistance(const TriangleMesh& mesh) : tree_(mesh), winding_(mesh) {
        normals_.reserve(mesh.faces.size());
        Box box;
        for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
            normals_.push_back((mesh.corner(f, 1) - mesh.corner(f, 0)).cross(mesh.corner(f, 2) - mesh.corner(f, 0)).normalized());
            for (int k = 0; k < 3; ++k) box.extend(mesh.corner(f, k));
        }
        const double magnitude = std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff()) + box.diagonal().norm();
        error_bound_ = 16.0 * std::numeric_limits<double>::epsilon() * magnitude;
    }
    double value(const Vec3& p) const override { return sample(p).value; }
    Vec3 gradient(const Vec3& p) const override { return sample(p).gradient; }
    double error_bound() const override { return error_bound_; }
    DistanceSample sample(const Vec3& p) const override {
        const detail::NearestPoint nearest = tree_.nearest(p);
        const double distance = std::sqrt(nearest.squared_distance);
        if (distance <= error_bound_) return {distance, normals_[nearest.face]};
        const double side = sign(p);
        return {side * distance, (p - nearest.point) * (side / (p - nearest.point).norm())};
    }

private:
    double sign(const Vec3& p) const { return winding_(p) > 0.5 ? -1.0 : 1.0; }

    detail::TriangleTree tree_;
    detail::FastWinding winding_;
    std::vector<Vec3> normals_;
    double error_bound_ = 0.0;
};

}  // namespace

std::unique_ptr<SignedDistance> winding_signed_distance(const TriangleMesh& mesh) {
    const char* remedy = "pass the mesh through require_closed_body or repair_to_closed_body first";
    if (mesh.empty()) throw bad_input("a mesh without triangles has no distance", remedy);
    for (const Triangle& t : mesh.faces)
        if (detail::is_degenerate(mesh, t)) throw bad_input("the signed distance needs triangles with an area", remedy);
    return std::make_unique<WindingDistance>(mesh);
}

}  // namespace pelletlab::meshes
