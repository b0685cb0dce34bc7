// A rigid sledge in a turning rigid polygon, in the plane: what Coulomb's law and Newton's impacts alone give, without any contact stiffness. A referee for
// the same sledge in the solver, whose walls are meshes and whose contacts are springs.
//
// Moreau's time stepping (Moreau 1988; Jean 1999): v⁺ = v + g Δt + M⁻¹ Σ Jᵀ p, with impulses p at the contacts that are closed at the middle of the step,
//   0 ≤ p_n ⊥ u_n⁺ + e u_n⁻ ≥ 0,   |p_t| ≤ μ p_n, p_t = −μ p_n sign(u_t⁺) while it slides,
// found by Gauss–Seidel sweeps over the contacts. A round runner inside a convex polygon is closed to a facet when its centre's distance along the facet's
// outward normal reaches apothem − r: corners need no rule of their own.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Core>

namespace pelletlab::verification {

struct RigidSledge {
    double mass = 0.0, inertia = 0.0;  ///< [kg], [kg m²] about the centre of mass
    double b = 0.0, h = 0.0, r = 0.0;  ///< [m], runners at (± b, −h) of radius r
    double apothem = 0.0;              ///< [m], of the polygon
    int facets = 0;
    double speed = 0.0;  ///< [rad/s]
    double friction = 0.0, restitution = 0.0, gravity = 9.81;

    using Vec2 = Eigen::Vector2d;

    /// Mean of the torque about the axis that the sledge takes from the drum, over `facets_counted` facets after `rest` seconds, from an angle φ [N m].
    double mean_torque(double phi, double time_step, double rest, int facets_counted) const {
        Eigen::Vector3d q(0.0, 0.0, phi), v(0.0, 0.0, 0.0);  // x, z, angle; x counted with the sense of rotation
        const double start = std::sqrt(std::pow(apothem - r, 2) - b * b) - h - 0.01 * apothem;
        q.head<2>() = start * Vec2(std::sin(phi), -std::cos(phi));
        const double facet = 2.0 * M_PI / facets, period = facet / speed;
        const auto first = static_cast<long>(std::ceil(rest / time_step)), count = static_cast<long>(std::llround(facets_counted * period / time_step));
        double impulse = 0.0;  // of the drum on the sledge, about the axis
        for (long k = 0; k < first + count; ++k) {
            const double angle = step(q, v, (static_cast<double>(k) + 0.5) * time_step, time_step);
            if (k >= first) impulse += angle;
        }
        return impulse / (static_cast<double>(count) * time_step);
    }

private:
    struct Contact {
        Vec2 normal, tangent, arm, place;  ///< inward; with the wall's motion; of the contact about the centre of mass; about the axis
        double before = 0.0, p_n = 0.0, p_t = 0.0;
    };

    static double cross(const Vec2& a, const Vec2& c) { return a.x() * c.y() - a.y() * c.x(); }

    /// One step; the moment of its impulses about the axis.
    double step(Eigen::Vector3d& q, Eigen::Vector3d& v, double time, double dt) const {
        q += 0.5 * dt * v;
        const Eigen::Matrix2d turn = (Eigen::Matrix2d() << std::cos(q.z()), -std::sin(q.z()), std::sin(q.z()), std::cos(q.z())).finished();
        std::vector<Contact> closed;
        for (const double side : {-b, b}) {
            const Vec2 arm = turn * Vec2(side, -h), centre = q.head<2>() + arm;
            const double facet = 2.0 * M_PI / facets, nearest = std::floor((std::atan2(centre.y(), centre.x()) - speed * time) / facet);
            for (const double k : {nearest - 1.0, nearest, nearest + 1.0}) {
                const double a = speed * time + (k + 0.5) * facet;  // a corner on the first axis at time 0
                const Vec2 out(std::cos(a), std::sin(a));
                if (centre.dot(out) < apothem - r) continue;
                Contact c{-out, {-out.y(), out.x()}, arm + r * out, centre + r * out};
                c.before = approach(c, v).x();
                closed.push_back(c);
            }
        }
        v.y() -= gravity * dt;
        for (int sweep = 0; sweep < 100; ++sweep)
            for (Contact& c : closed) {
                const double old_n = c.p_n, old_t = c.p_t, u_n = approach(c, v).x();
                c.p_n = std::max(0.0, c.p_n - (u_n + restitution * std::min(c.before, 0.0)) * effective_mass(c.arm, c.normal));
                apply(c, (c.p_n - old_n) * c.normal, v);
                const double wanted = c.p_t - approach(c, v).y() * effective_mass(c.arm, c.tangent);
                c.p_t = std::clamp(wanted, -friction * c.p_n, friction * c.p_n);
                apply(c, (c.p_t - old_t) * c.tangent, v);
            }
        double moment = 0.0;
        for (const Contact& c : closed) moment += cross(c.place, c.p_n * c.normal + c.p_t * c.tangent);
        q += 0.5 * dt * v;
        return moment;
    }
    /// Velocity of the runner against the wall there: along the normal, along the tangent.
    Vec2 approach(const Contact& c, const Eigen::Vector3d& v) const {
        const Vec2 body(v.x() - v.z() * c.arm.y(), v.y() + v.z() * c.arm.x()), wall(-speed * c.place.y(), speed * c.place.x());
        return {(body - wall).dot(c.normal), (body - wall).dot(c.tangent)};
    }
    double effective_mass(const Vec2& arm, const Vec2& direction) const { return 1.0 / (1.0 / mass + std::pow(cross(arm, direction), 2) / inertia); }
    void apply(const Contact& c, const Vec2& p, Eigen::Vector3d& v) const {
        v.head<2>() += p / mass;
        v.z() += cross(c.arm, p) / inertia;
    }
};

}  // namespace pelletlab::verification
