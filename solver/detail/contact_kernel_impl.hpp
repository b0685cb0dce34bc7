// The contact kernel over a batch, for any lane type and any law. Included by kernel files only.
#pragma once

#include "solver/detail/cohesion_impl.hpp"
#include "solver/detail/rolling_law_impl.hpp"

namespace pelletlab::solver::detail {
namespace {

/// Copies of the last contact behind it: the last register is full, and what it writes twice is the same twice.
inline void pad_batch(ContactBatch& b) {
    double* const columns[9] = {b.dx, b.dy, b.dz, b.ax, b.ay, b.az, b.ra, b.rb, b.share};
    const std::size_t last = b.size - 1;
    for (std::size_t k = b.size; k < b.size + widest - 1; ++k) {
        for (double* column : columns) column[k] = column[last];
        b.slot[k] = b.slot[last];
        b.spring[k] = b.spring[last];
    }
}

template <class L>
inline Triple<typename L::Real> load_triple(const double* x, const double* y, const double* z, std::size_t k) {
    return {L::load(x + k), L::load(y + k), L::load(z + k)};
}

/// Addresses of the history rows of a register full of contacts.
template <class L, class Rolling>
struct HistoryRows {
    double *spring[L::width], *torque[L::width];
    HistoryRows(const ContactBatch& b, std::size_t k) {
        constexpr std::size_t rows = Rolling::remembers ? 2 : 1;
        for (std::size_t lane = 0; lane < L::width; ++lane) {
            spring[lane] = b.springs[b.spring[k + lane] * rows].row;
            if constexpr (Rolling::remembers) torque[lane] = b.springs[b.spring[k + lane] * rows + 1].row;
        }
    }
};

/// What the contacts store and dissipate; see BookColumn. `spring` and `torque` are those of the last step, carried to this one.
template <class Law, class L, class V = typename L::Real>
inline void book_contacts(const ContactState<V>& c, const NormalForce<V>& normal, const ContactResult<V>& result, const V& cohesion,
                          const Triple<V>& tangential_velocity, const V& tangential_stiffness, const Triple<V>& old_spring, const V& last_overlap,
                          const Triple<V>& trial, const V& old_torque2, const RollingResult<V>& rolling, double step, double* const* targets) {
    const V zero = L::all(0.0), half = L::all(0.5), dt = L::all(step);
    const V overlap = L::larger(c.overlap, zero), normal_speed = dot(c.velocity, c.normal);
    const V ratio = stiffness_ratio<Law, L>(overlap, last_overlap);
    const V stored = half * tangential_stiffness * dot(result.spring, result.spring);
    // The spring before this step's growth, at the present stiffness, and how its energy came to be that.
    const Triple<V> before = trial - tangential_velocity * dt;
    const V stored_before = half * tangential_stiffness * dot(before, before);
    V fed = stored_before - half * tangential_stiffness * ratio * dot(old_spring, old_spring);
    const Triple<V> tangential = result.force - c.normal * dot(result.force, c.normal);
    const V lost = zero - dot(tangential, tangential_velocity) * dt - (stored - stored_before);
    const V slipped = trial.x - result.spring.x, slipped_y = trial.y - result.spring.y, slipped_z = trial.z - result.spring.z;
    const auto slides = L::greater(slipped * slipped + slipped_y * slipped_y + slipped_z * slipped_z, zero);
    V rolling_stored = zero, rolling_lost = zero - dot(rolling.moment, c.spin) * dt;
    const auto rolls = L::greater(rolling.stiffness * ratio, zero);
    const V compliance = half / L::choose(rolls, rolling.stiffness, L::all(1.0));
    rolling_stored = L::choose(rolls, dot(rolling.torque, rolling.torque) * compliance, zero);
    const V rolling_before = L::choose(rolls, old_torque2 * compliance, zero);
    rolling_lost = rolling_lost - (rolling_stored - rolling_before);
    fed = fed + L::choose(rolls, rolling_before - rolling_before / L::choose(rolls, ratio, L::all(1.0)), zero);
    fed = fed - cohesion * normal_speed * dt;
    const V potential = L::all(Law::hertz ? 0.4 : 0.5) * normal.elastic * overlap;
    const V normal_lost = (normal.elastic - normal.total) * normal_speed * dt;
    V row[8] = {potential, stored, rolling_stored, normal_lost, L::choose(slides, zero, lost), L::choose(slides, lost, zero), rolling_lost, fed};
    L::store_rows(targets, row);
}

template <class L, class Law, class Rolling, bool rich>
void contact_forces(const LawRow& law, ContactBatch& b, const PairSlot* slots, const StepClock& clock) {
    using V = typename L::Real;
    if (b.size == 0) return;
    pad_batch(b);
    const V zero = L::all(0.0);
    for (std::size_t k = 0; k < b.size; k += L::width) {
        const double* rows[L::width];
        for (std::size_t lane = 0; lane < L::width; ++lane) rows[lane] = slots[b.slot[k + lane]].row;
        V slot[8];
        L::load_rows(rows, slot);
        const Triple<V> d = load_triple<L>(b.dx, b.dy, b.dz, k), origin = load_triple<L>(b.ax, b.ay, b.az, k);
        const V ra = L::load(b.ra + k), rb = L::load(b.rb + k), reach = ra + rb;
        const V distance = L::square_root(dot(d, d));
        ContactState<V> c;
        c.normal = d * (L::all(1.0) / L::larger(distance, L::all(1e-300)));
        c.overlap = reach - distance;
        // Between spheres the contact point is in the middle of the overlap, on a wall it is the wall's nearest point.
        c.radius = law.wall ? rb : ra * rb / reach;
        const Triple<V> point = law.wall ? origin : origin + c.normal * (ra - L::all(0.5) * c.overlap);
        c.spin = {slot[3], slot[4], slot[5]};
        c.velocity = Triple<V>{slot[0], slot[1], slot[2]} + cross(c.spin, point);
        c.mass = slot[6];
        c.inertia = slot[7];
        const HistoryRows<L, Rolling> history(b, k);
        V old[4];
        L::load_short_rows(history.spring, old);
        const Triple<V> old_spring{old[0], old[1], old[2]};
        const V normal_speed = dot(c.velocity, c.normal);
        const Triple<V> tangential_velocity = c.velocity - c.normal * normal_speed;
        const Triple<V> spring = rescaled<Law, L>(carried<L>(old_spring, c.normal, c.spin, clock.spring_step), c, old[3]);
        c.spring = spring + tangential_velocity * L::all(clock.spring_step);

        const V overlap = rich ? L::larger(c.overlap, zero) : c.overlap;
        const NormalForce<V> normal = Law::template normal<L>(law, c, overlap, normal_speed);
        V friction = L::all(law.sliding_friction), limit_force = L::larger(normal.total, zero), cohesion = zero, broken = zero;
        if constexpr (rich) {
            if (law.friction_drop != 0.0) {
                const V slip = L::square_root(dot(tangential_velocity, tangential_velocity));
                const V speed = L::all(law.friction_speed);
                friction = friction - L::all(law.friction_drop) * (slip / (slip + speed));
            }
            if (law.cohesion != Cohesion::none) {
                const CohesiveForce<V> f = cohesive_force<L>(law, c, normal.elastic, L::choose(L::greater(zero, old[3]), L::all(1.0), zero));
                limit_force = L::larger(normal.total + f.limit_gain, zero);
                cohesion = f.pull;
                broken = f.broken;
            }
        }
        ContactResult<V> result = with_friction<L>(c, normal, L::all(law.tangential_ratio), friction * limit_force, tangential_velocity);
        RollingResult<V> rolling{{zero, zero, zero}, {zero, zero, zero}, zero};
        V old_torque2 = zero;
        const V rolling_force = rich ? limit_force : result.normal_force;
        if constexpr (Rolling::remembers) {
            V old_row[4];
            L::load_short_rows(history.torque, old_row);
            const Triple<V> old_torque = carried<L>(Triple<V>{old_row[0], old_row[1], old_row[2]}, c.normal, c.spin, clock.spring_step);
            old_torque2 = dot(old_torque, old_torque);
            const V secant = normal.elastic / L::larger(overlap, L::all(1e-300));
            const V arm = law.wall ? rb : L::all(0.5) * reach;
            rolling = Rolling::template moment<L>(law, c, rolling_force, secant, arm, old_torque, clock.spring_step);
        } else {
            rolling.moment = Rolling::template moment<L>(law, c, rolling_force, clock.step);
        }
        if constexpr (rich) {
            result.force = result.force - c.normal * cohesion;
            const V share = law.shared ? L::load(b.share + k) : L::all(1.0);
            if (law.booked) {
                double* book[L::width];
                for (std::size_t lane = 0; lane < L::width; ++lane) book[lane] = b.book[k + lane].row;
                book_contacts<Law, L>(c, normal, result, cohesion, tangential_velocity, L::all(law.tangential_ratio) * normal.stiffness, old_spring, old[3],
                                      c.spring, old_torque2, rolling, clock.spring_step, book);
                if (law.shared)
                    for (std::size_t lane = 0; lane < L::width; ++lane)
                        for (int column = 0; column < 8; ++column) book[lane][column] *= b.share[k + lane];
            }
            if (law.shared) {
                result.force = result.force * share;
                rolling.moment = rolling.moment * share;
            }
        }
        const Triple<V> moment = rolling.moment + cross(point, result.force);
        if (clock.spring_step > 0.0) {
            const V grown[4] = {result.spring.x, result.spring.y, result.spring.z, rich ? L::choose(L::greater(broken, zero), L::all(-1.0), overlap) : overlap};
            L::store_short_rows(history.spring, grown);
            if constexpr (Rolling::remembers) {
                const V turned[4] = {rolling.torque.x, rolling.torque.y, rolling.torque.z, zero};
                L::store_short_rows(history.torque, turned);
            }
        }
        const V out[8] = {result.force.x, result.force.y, result.force.z, moment.x, moment.y, moment.z, result.normal_force, zero};
        double* targets[L::width];
        for (std::size_t lane = 0; lane < L::width; ++lane) targets[lane] = b.result[k + lane].row;
        L::store_rows(targets, out);
    }
}

}  // namespace
}  // namespace pelletlab::solver::detail
