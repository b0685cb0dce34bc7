// Bodies and templates as the engine holds them: structure of arrays for motion, one compact record a body for contacts.
#pragma once

#include <cstdint>
#include <vector>

#include "core/rigid_template.hpp"
#include "core/vec.hpp"

namespace pelletlab::solver::detail {

/// A template turned into what the loops need. Spheres are stored (x, y, z, radius), 32-byte aligned.
struct BodyTemplate {
    struct alignas(32) Ball {
        double x, y, z, r;
    };
    std::vector<Ball> balls;
    double mass = 0.0, inverse_mass = 0.0;
    Vec3 inertia = Vec3::Zero(), inverse_inertia = Vec3::Zero();
    double smallest_inertia = 0.0;
    double bounding_radius = 0.0;  ///< [m], about the centre of mass
    double largest_offset = 0.0;   ///< [m], of a sphere centre from the centre of mass
    double smallest_radius = 0.0;  ///< [m]
    double density = 0.0;          ///< [kg/m³], for the Rayleigh step
    // Free rotation: see motion.hpp.
    Vec3 axis = Vec3::UnitZ();         ///< symmetry axis (the two other moments are the closest)
    Vec3 second_axis = Vec3::UnitX();  ///< the axis that carries what is left of asymmetry
    double inverse_transverse = 0.0;   ///< 1 / I of the transverse axes
    double axial_excess = 0.0;         ///< 1/I_axis − 1/I_transverse
    double second_excess = 0.0;        ///< 1/I_second − 1/I_transverse, 0 for a symmetric top
};

BodyTemplate make_body_template(const RigidTemplate& rigid);

/// One body as contacts see it, at the instant at which forces are computed.
struct alignas(64) Kinematic {
    double p[3];             ///< [m]
    double q[4];             ///< w, x, y, z
    double v[3];             ///< [m/s]
    double w[3];             ///< [rad/s], world
    double inverse_mass;     ///< [1/kg]; 0 for a wall
    double inverse_inertia;  ///< [1/(kg m²)], of the smallest principal moment; 0 for a wall
    double unused;
};

/// Structure of arrays: position, orientation, velocity, angular momentum about the centre of mass (world), force, torque.
struct Bodies {
    std::vector<std::uint32_t> template_index;
    std::vector<double> px, py, pz, qw, qx, qy, qz, vx, vy, vz, lx, ly, lz, fx, fy, fz, tx, ty, tz;

    std::size_t size() const { return template_index.size(); }
    void resize(std::size_t n);

    Vec3 position(std::size_t i) const { return {px[i], py[i], pz[i]}; }
    Quat orientation(std::size_t i) const { return {qw[i], qx[i], qy[i], qz[i]}; }
    Vec3 velocity(std::size_t i) const { return {vx[i], vy[i], vz[i]}; }
    Vec3 angular_momentum(std::size_t i) const { return {lx[i], ly[i], lz[i]}; }
    Vec3 force(std::size_t i) const { return {fx[i], fy[i], fz[i]}; }
    Vec3 torque(std::size_t i) const { return {tx[i], ty[i], tz[i]}; }

    /// Every array of doubles, in a fixed order: for checkpoints, hashes and resizing.
    template <class Visit>
    void each_array(const Visit& visit) {
        for (std::vector<double>* a : {&px, &py, &pz, &qw, &qx, &qy, &qz, &vx, &vy, &vz, &lx, &ly, &lz, &fx, &fy, &fz, &tx, &ty, &tz}) visit(*a);
    }
    template <class Visit>
    void each_array(const Visit& visit) const {
        const_cast<Bodies*>(this)->each_array([&](const std::vector<double>& a) { visit(a); });
    }
};

/// Spin [rad/s] in the world frame from angular momentum L (world): ω = R I⁻¹ Rᵀ L.
inline Vec3 spin_of(const BodyTemplate& t, const Quat& orientation, const Vec3& angular_momentum) {
    const Mat3 r = orientation.toRotationMatrix();
    return r * t.inverse_inertia.cwiseProduct(r.transpose() * angular_momentum);
}

inline Vec3 angular_momentum_of(const BodyTemplate& t, const Quat& orientation, const Vec3& spin) {
    const Mat3 r = orientation.toRotationMatrix();
    return r * t.inertia.cwiseProduct(r.transpose() * spin);
}

}  // namespace pelletlab::solver::detail
