// The fit works on a body of volume 1 around the origin, so that lengths, steps and tolerances mean the same for every pellet.
#pragma once

#include <cmath>
#include <vector>

#include "core/rigid_template.hpp"
#include "core/triangle_mesh.hpp"
#include "meshes/signed_distance.hpp"

namespace pelletlab::shapegen::detail {

/// x_unit = (x − centre) / length, length = volume^⅓.
struct UnitFrame {
    Vec3 centre = Vec3::Zero();
    double length = 1.0;

    Vec3 to_unit(const Vec3& p) const { return (p - centre) / length; }
    Vec3 to_mesh(const Vec3& p) const { return centre + length * p; }

    TriangleMesh to_unit(TriangleMesh mesh) const {
        for (Vec3& vertex : mesh.vertices) vertex = to_unit(vertex);
        return mesh;
    }
    std::vector<Sphere> to_mesh(std::vector<Sphere> spheres) const {
        for (Sphere& sphere : spheres) sphere = {to_mesh(sphere.centre), length * sphere.radius};
        return spheres;
    }
    std::vector<Sphere> to_unit(std::vector<Sphere> spheres) const {
        for (Sphere& sphere : spheres) sphere = {to_unit(sphere.centre), sphere.radius / length};
        return spheres;
    }
};

/// The same distance in that frame.
class UnitDistance final : public meshes::SignedDistance {
public:
    UnitDistance(const meshes::SignedDistance& distance, const UnitFrame& frame) : distance_(distance), frame_(frame) {}
    double value(const Vec3& p) const override { return distance_.value(frame_.to_mesh(p)) / frame_.length; }
    Vec3 gradient(const Vec3& p) const override { return distance_.gradient(frame_.to_mesh(p)); }
    meshes::DistanceSample sample(const Vec3& p) const override {
        meshes::DistanceSample at = distance_.sample(frame_.to_mesh(p));
        at.value /= frame_.length;
        return at;
    }
    double error_bound() const override { return distance_.error_bound() / frame_.length; }

private:
    const meshes::SignedDistance& distance_;
    UnitFrame frame_;
};

}  // namespace pelletlab::shapegen::detail
