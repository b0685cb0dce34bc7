#include "solver/detail/bodies.hpp"

#include <algorithm>
#include <cmath>

namespace pelletlab::solver::detail {

namespace {

/// Splits the rotational energy into a symmetric top and one axis: ½ Σ π_k²/I_k = ½ |π|²/I_t + ½ (1/I_a − 1/I_t) π_a² + ½ (1/I_s − 1/I_t) π_s².
void choose_axes(BodyTemplate& t) {
    const Vec3& i = t.inertia;
    int axis = 0;
    double closest = 2.0;
    for (int k = 0; k < 3; ++k) {
        const double a = i[(k + 1) % 3], b = i[(k + 2) % 3];
        const double difference = std::abs(a - b) / std::max(a, b);
        if (difference < closest) closest = difference, axis = k;
    }
    const int second = (axis + 1) % 3, third = (axis + 2) % 3;
    t.axis = Vec3::Unit(axis);
    t.second_axis = Vec3::Unit(second);
    t.inverse_transverse = 1.0 / i[third];
    t.axial_excess = 1.0 / i[axis] - 1.0 / i[third];
    t.second_excess = closest < 1e-13 ? 0.0 : 1.0 / i[second] - 1.0 / i[third];
}

void fill_columns(BodyTemplate& t) {
    const std::size_t stride = padded_count(t.balls.size());
    t.columns.assign(4 * stride, 0.0);
    std::fill(t.columns.end() - static_cast<std::ptrdiff_t>(stride), t.columns.end(), -1e100);
    for (std::size_t a = 0; a < t.balls.size(); ++a) {
        const Ball& ball = t.balls[a];
        t.columns[a] = ball.x, t.columns[stride + a] = ball.y, t.columns[2 * stride + a] = ball.z, t.columns[3 * stride + a] = ball.r;
    }
}

}  // namespace

BallColumns columns_of(const BodyTemplate& t) {
    const std::size_t stride = padded_count(t.balls.size());
    const double* c = t.columns.data();
    return {c, c + stride, c + 2 * stride, c + 3 * stride, t.balls.size(), t.bounding_radius};
}

BodyTemplate make_body_template(const RigidTemplate& rigid) {
    BodyTemplate t;
    t.balls.reserve(rigid.spheres.size());
    t.smallest_radius = t.largest_radius = rigid.spheres.front().radius;
    for (const Sphere& s : rigid.spheres) {
        t.balls.push_back({s.centre.x(), s.centre.y(), s.centre.z(), s.radius});
        t.smallest_radius = std::min(t.smallest_radius, s.radius);
        t.largest_radius = std::max(t.largest_radius, s.radius);
        t.largest_offset = std::max(t.largest_offset, s.centre.norm());
    }
    fill_columns(t);
    t.bounding_radius = bounding_radius(rigid.spheres);
    const MassProperties& m = rigid.mass_properties;
    t.mass = m.mass;
    t.inverse_mass = 1.0 / m.mass;
    t.inertia = m.principal_inertia;
    t.inverse_inertia = t.inertia.cwiseInverse();
    t.smallest_inertia = t.inertia.minCoeff();
    t.density = m.density > 0.0 ? m.density : (m.volume > 0.0 ? m.mass / m.volume : 0.0);
    t.equivalent_diameter = std::cbrt(6.0 / M_PI * m.volume);
    choose_axes(t);
    return t;
}

MotionConstants motion_constants(const BodyTemplate& t) {
    return {{t.inverse_mass, t.mass, t.inverse_inertia.x(), t.inverse_inertia.y(), t.inverse_inertia.z(), t.inverse_transverse, t.axial_excess, t.second_excess,
             t.axis.x(), t.axis.y(), t.axis.z(), t.second_axis.x(), t.second_axis.y(), t.second_axis.z(), t.largest_offset, 1.0 / t.smallest_inertia}};
}

template <class Self, class Visit>
void Bodies::each_column(Self& self, const Visit& visit) {
    for (auto& c : self.position_) visit(c);
    for (auto& c : self.turn_) visit(c);
    for (auto* group : {&self.velocity_, &self.momentum_, &self.force_, &self.torque_})
        for (auto& c : *group) visit(c);
}

void Bodies::resize(std::size_t n) {
    const std::size_t padded = padded_count(n);
    for (std::size_t i = n; i < count_; ++i) set_numbers(i, {});  // the padding holds zeros
    for (std::size_t i = n; i < count_; ++i) template_index_[i] = 0;
    for (std::size_t i = count_; i < n; ++i) id_.push_back(static_cast<std::uint32_t>(i)), place_of_.push_back(static_cast<std::uint32_t>(i));
    id_.resize(n), place_of_.resize(n);
    count_ = n;
    template_index_.resize(padded, 0);
    each_column(*this, [padded](LargeVector<double>& c) { c.resize(padded, 0.0); });
    for (auto& c : reference_) c.resize(padded, 0.0);
    path_.resize(padded, 0.0);
}

void Bodies::reorder(const std::vector<std::uint32_t>& order) {
    const auto move = [&](auto& column) {
        auto old = column;
        for (std::size_t k = 0; k < count_; ++k) column[k] = old[order[k]];
    };
    each_column(*this, move);
    for (auto& c : reference_) move(c);
    move(path_);
    move(template_index_);
    move(id_);
    for (std::size_t k = 0; k < count_; ++k) place_of_[id_[k]] = static_cast<std::uint32_t>(k);
}

void Bodies::mark_reference() {
    reference_ = position_;
}

BodyArrays Bodies::arrays(const MotionConstants* constants, Kinematic* records) {
    BodyArrays a{};
    a.count = count_;
    for (std::size_t k = 0; k < 3; ++k) {
        a.position[k] = position_[k].data();
        a.velocity[k] = velocity_[k].data();
        a.momentum[k] = momentum_[k].data();
        a.force[k] = force_[k].data();
        a.torque[k] = torque_[k].data();
        a.reference[k] = reference_[k].data();
    }
    for (std::size_t k = 0; k < 4; ++k) a.turn[k] = turn_[k].data();
    a.path = path_.data();
    a.template_index = template_index_.data();
    a.constants = constants;
    a.records = records;
    return a;
}

std::array<double, Bodies::number_count> Bodies::numbers(std::size_t i) const {
    std::array<double, number_count> values{};
    std::size_t k = 0;
    each_column(*this, [&](const LargeVector<double>& c) { values[k++] = c[i]; });
    return values;
}

void Bodies::set_numbers(std::size_t i, const std::array<double, number_count>& values) {
    std::size_t k = 0;
    each_column(*this, [&](LargeVector<double>& c) { c[i] = values[k++]; });
}

}  // namespace pelletlab::solver::detail
