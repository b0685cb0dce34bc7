// Bodies and templates as the engine holds them: structure of arrays for motion, one compact record a body for contacts.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/large_pages.hpp"
#include "core/rigid_template.hpp"
#include "core/vec.hpp"
#include "solver/detail/kernels.hpp"

namespace pelletlab::solver::detail {

/// A template turned into what the loops need.
struct BodyTemplate {
    std::vector<Ball> balls;
    std::vector<double> columns;  ///< of the balls: x, y, z, r
    double mass = 0.0, inverse_mass = 0.0;
    Vec3 inertia = Vec3::Zero(), inverse_inertia = Vec3::Zero();
    double smallest_inertia = 0.0;
    double bounding_radius = 0.0;                        ///< [m], about the centre of mass
    double largest_offset = 0.0;                         ///< [m], of a sphere centre from the centre of mass
    double smallest_radius = 0.0, largest_radius = 0.0;  ///< [m], of its spheres
    double equivalent_diameter = 0.0;                    ///< [m], of the sphere of the body's volume
    double density = 0.0;                                ///< [kg/m³], for the Rayleigh step
    // Free rotation: see motion.hpp.
    Vec3 axis = Vec3::UnitZ();         ///< symmetry axis (the two other moments are the closest)
    Vec3 second_axis = Vec3::UnitX();  ///< the axis that carries what is left of asymmetry
    double inverse_transverse = 0.0;   ///< 1 / I of the transverse axes
    double axial_excess = 0.0;         ///< 1/I_axis − 1/I_transverse
    double second_excess = 0.0;        ///< 1/I_second − 1/I_transverse, 0 for a symmetric top
};

BallColumns columns_of(const BodyTemplate& t);
BodyTemplate make_body_template(const RigidTemplate& rigid);
MotionConstants motion_constants(const BodyTemplate& t);

/// Structure of arrays, padded to full registers: position, orientation, velocity, angular momentum about the centre of mass (world), force, torque.
class Bodies {
public:
    std::size_t size() const { return count_; }
    void resize(std::size_t n);

    /// A body's id is the order in which it was added; where it lies in memory may change (body_order.hpp). Everything else here takes the place.
    std::uint32_t id(std::size_t i) const { return id_[i]; }
    std::uint32_t place_of(std::size_t id) const { return place_of_[id]; }
    /// Moves the body at place order[k] to place k.
    void reorder(const std::vector<std::uint32_t>& order);

    std::uint32_t template_of(std::size_t i) const { return template_index_[i]; }
    Vec3 position(std::size_t i) const { return get(position_, i); }
    Quat orientation(std::size_t i) const { return {turn_[0][i], turn_[1][i], turn_[2][i], turn_[3][i]}; }
    Vec3 velocity(std::size_t i) const { return get(velocity_, i); }
    Vec3 angular_momentum(std::size_t i) const { return get(momentum_, i); }
    Vec3 force(std::size_t i) const { return get(force_, i); }
    Vec3 torque(std::size_t i) const { return get(torque_, i); }

    void set_template(std::size_t i, std::uint32_t index) { template_index_[i] = index; }
    void set_position(std::size_t i, const Vec3& a) { set(position_, i, a); }
    void set_orientation(std::size_t i, const Quat& q) { turn_[0][i] = q.w(), turn_[1][i] = q.x(), turn_[2][i] = q.y(), turn_[3][i] = q.z(); }
    void set_velocity(std::size_t i, const Vec3& a) { set(velocity_, i, a); }
    void set_angular_momentum(std::size_t i, const Vec3& a) { set(momentum_, i, a); }

    /// Remembers the present positions: neighbour lists hold while no body is too far from there.
    void mark_reference();

    /// How far body i has gone in all [m].
    double path(std::size_t i) const { return path_[i]; }

    /// What kernels work on; `constants` per template, `records` padded like the bodies.
    BodyArrays arrays(const MotionConstants* constants, Kinematic* records);

    /// Numbers of body i that decide the future, in a fixed order: for checkpoints and hashes.
    static constexpr std::size_t number_count = 19;
    std::array<double, number_count> numbers(std::size_t i) const;
    void set_numbers(std::size_t i, const std::array<double, number_count>& values);

private:
    template <std::size_t N>
    using Columns = std::array<LargeVector<double>, N>;
    std::size_t count_ = 0;
    std::vector<std::uint32_t> template_index_, id_, place_of_;
    Columns<3> position_, velocity_, momentum_, force_, torque_, reference_;
    Columns<4> turn_;
    LargeVector<double> path_;

    static Vec3 get(const Columns<3>& c, std::size_t i) { return {c[0][i], c[1][i], c[2][i]}; }
    static void set(Columns<3>& c, std::size_t i, const Vec3& a) { c[0][i] = a.x(), c[1][i] = a.y(), c[2][i] = a.z(); }
    template <class Self, class Visit>
    static void each_column(Self& self, const Visit& visit);
};

inline std::size_t padded_count(std::size_t n) {
    return (n + widest - 1) / widest * widest;
}

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
