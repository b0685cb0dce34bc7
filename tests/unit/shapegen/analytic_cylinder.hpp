// Signed distance of a perfect cylinder (axis z, centre in the origin): a referee that shares no code with the mesh queries.
#pragma once

#include <algorithm>
#include <cmath>

#include "meshes/signed_distance.hpp"

namespace pelletlab::shapegen {

class AnalyticCylinder final : public meshes::SignedDistance {
public:
    AnalyticCylinder(double diameter, double height) : radius_(0.5 * diameter), half_(0.5 * height) {}

    double value(const Vec3& p) const override {
        const double side = std::hypot(p.x(), p.y()) - radius_, top = std::abs(p.z()) - half_;
        return std::hypot(std::max(side, 0.0), std::max(top, 0.0)) + std::min(std::max(side, top), 0.0);
    }

    Vec3 gradient(const Vec3& p) const override {
        const double rho = std::hypot(p.x(), p.y());
        const double side = rho - radius_, top = std::abs(p.z()) - half_;
        const Vec3 outward = rho > 0.0 ? Vec3(p.x() / rho, p.y() / rho, 0.0) : Vec3::UnitX();
        const Vec3 up(0.0, 0.0, p.z() < 0.0 ? -1.0 : 1.0);
        if (side > 0.0 && top > 0.0) return (side * outward + top * up).normalized();
        return side > top ? outward : up;
    }

    double error_bound() const override { return 0.0; }

private:
    double radius_, half_;
};

}  // namespace pelletlab::shapegen
