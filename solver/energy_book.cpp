#include "solver/energy_book.hpp"

#include <algorithm>

#include "solver/detail/state.hpp"

namespace pelletlab::solver {

double EnergyReport::input() const {
    double sum = fed + body_force_work;
    for (const double work : wall_work) sum += work;
    return sum;
}

void Simulation::State::book_contacts() {
    if (!definition.physics.energy_book) return;
    detail::LoadRow sum{};
    const auto add = [&sum](const detail::LoadRow& row) {
        for (int k = 0; k < 8; ++k) sum.row[k] += row.row[k];
    };
    for (const detail::LoadRow& row : pairs.books) add(row);
    for (const detail::Wall& wall : walls)
        for (const detail::LoadRow& row : wall.books) add(row);
    for (std::size_t k = 0; k < 3; ++k) book.stored[k] = sum.row[k];
    for (std::size_t k = 0; k < 5; ++k) book.gone[k] += sum.row[3 + k];
}

void Simulation::State::book_work() {
    for (std::size_t w = 0; w < walls.size(); ++w) book.wall_work[w] += wall_loads[w].power * definition.time_step;
    book.body_force_work += body_force_power * definition.time_step;
}

EnergyReport Simulation::energy() const {
    const State& s = *state_;
    EnergyReport e;
    for (std::size_t id = 0; id < s.bodies.size(); ++id) {
        const std::size_t i = s.bodies.place_of(id);
        const detail::BodyTemplate& t = s.templates[s.bodies.template_of(i)];
        const Vec3 l = s.bodies.angular_momentum(i);
        e.kinetic_translation += 0.5 * t.mass * s.bodies.velocity(i).squaredNorm();
        e.kinetic_rotation += 0.5 * l.dot(detail::spin_of(t, s.bodies.orientation(i), l));
        e.gravity -= t.mass * s.definition.gravity.dot(s.bodies.position(i));
    }
    e.elastic_normal = s.book.stored[0], e.elastic_tangential = s.book.stored[1], e.elastic_rolling = s.book.stored[2];
    e.normal_damping = s.book.gone[0], e.tangential_damping = s.book.gone[1], e.sliding = s.book.gone[2], e.rolling = s.book.gone[3];
    e.fed = s.book.gone[4];
    e.body_force_work = s.book.body_force_work;
    e.wall_work = s.book.wall_work;
    return e;
}

}  // namespace pelletlab::solver
