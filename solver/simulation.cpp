#include "solver/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <sstream>

#include "core/error.hpp"
#include "solver/detail/motion.hpp"
#include "solver/detail/state.hpp"
#include "solver/time_step.hpp"

namespace pelletlab::solver {

namespace {

constexpr std::size_t most_spheres = 32767;  ///< a candidate keeps its sphere in 15 bits

void check_template(const RigidTemplate& t) {
    const std::string what = "template «" + t.name + "»";
    if (t.spheres.empty()) throw bad_input(what + " has no spheres", "make it with `pelletlab shape`");
    if (t.spheres.size() > most_spheres) throw bad_input(what + " has more than 32767 spheres", "fit it with fewer spheres");
    for (const Sphere& s : t.spheres)
        if (!s.centre.allFinite() || !(s.radius > 0.0) || !std::isfinite(s.radius))
            throw bad_input(what + " has a sphere without a positive radius or a finite centre", "make the template again");
    const MassProperties& m = t.mass_properties;
    const Vec3& i = m.principal_inertia;
    if (!(m.mass > 0.0) || !std::isfinite(m.mass) || !(i.minCoeff() > 0.0) || !i.allFinite())
        throw bad_input(what + " has no positive mass and moments of inertia", "make the template again");
    for (int k = 0; k < 3; ++k)
        if (i[k] > (i[(k + 1) % 3] + i[(k + 2) % 3]) * (1.0 + 1e-9))
            throw bad_input(what + " has moments of inertia that no body can have: one is larger than the sum of the others", "make the template again");
}

Box default_domain(const SimulationDefinition& d) {
    Box box;
    for (const WallDefinition& wall : d.walls)
        if (!wall.mesh.vertices.empty()) box.extend(bounding_box(wall.mesh));
    if (box.isEmpty()) return {Vec3::Constant(-1e100), Vec3::Constant(1e100)};
    const Vec3 margin = Vec3::Constant(box.diagonal().norm());
    return {box.min() - margin, box.max() + margin};
}

Pose pose_of(const detail::Kinematic& k) {
    return {Vec3(k.position()[0], k.position()[1], k.position()[2]), Quat(k.turn()[0], k.turn()[1], k.turn()[2], k.turn()[3])};
}

/// Deepest overlap of two bodies against the smaller of their smallest radii.
double deepest_overlap(const detail::Kinematic& a, const detail::BodyTemplate& ta, const detail::Kinematic& b, const detail::BodyTemplate& tb) {
    const Pose pa = pose_of(a), pb = pose_of(b);
    double deepest = 0.0;
    for (const auto& s : ta.balls) {
        const Vec3 c = pb.to_body(pa.to_world({s.x, s.y, s.z}));
        if (c.norm() > s.r + tb.bounding_radius) continue;
        for (const auto& t : tb.balls) deepest = std::max(deepest, s.r + t.r - (c - Vec3(t.x, t.y, t.z)).norm());
    }
    return deepest / std::min(ta.smallest_radius, tb.smallest_radius);
}

const detail::Kernels* choose_kernels(InstructionSet wanted) {
    const detail::Kernels* kernels = &detail::best_kernels();
    if (wanted == InstructionSet::scalar) kernels = &detail::scalar_kernels();
    if (wanted == InstructionSet::avx2) kernels = detail::avx2_kernels();
    if (wanted == InstructionSet::avx512) kernels = detail::avx512_kernels();
    if (!kernels) throw bad_input("this processor lacks the instruction set that was asked for", "leave the choice to the program");
    return kernels;
}

std::string percent(double share) {
    std::ostringstream text;
    text << 100.0 * share;
    return text.str();
}

/// Speed bound [m/s] of the wall's surface over its whole motion.
double fastest_surface(const detail::Wall& wall, const WallMotion& m) {
    double reach = 0.0;  // furthest vertex from the axis; surfaces in closed form are judged by their centre
    for (const Vec3& v : wall.mesh.vertices) reach = std::max(reach, (wall.pose.to_world(v) - m.point).cross(m.axis).norm());
    const double omega = 2.0 * M_PI * m.frequency;
    double shift = m.velocity.norm() + omega * m.oscillation.norm(), turn = std::abs(m.rotation_speed) + omega * std::abs(m.swing);
    double steepest_shift = 0.0, steepest_turn = 0.0;
    for (std::size_t k = 1; k < m.table.size(); ++k) {
        const double time = m.table[k].time - m.table[k - 1].time;
        steepest_shift = std::max(steepest_shift, (m.table[k].shift - m.table[k - 1].shift).norm() / time);
        steepest_turn = std::max(steepest_turn, std::abs(m.table[k].angle - m.table[k - 1].angle) / time);
    }
    shift += 1.5 * steepest_shift, turn += 1.5 * steepest_turn;  // a cubic between rows is at most that much steeper than its secant
    return shift + turn * reach;
}

std::string place(const Vec3& p) {
    std::ostringstream text;
    text << "(" << p.x() << ", " << p.y() << ", " << p.z() << ") m";
    return text.str();
}

/// A wall that moves further than the smallest sphere's radius in one step passes through the bodies that it should push.
void check_pace(const Simulation::State& s, const detail::Wall& wall, const WallMotion& motion) {
    double smallest = std::numeric_limits<double>::infinity();
    for (const detail::BodyTemplate& t : s.templates) smallest = std::min(smallest, t.smallest_radius);
    const double jump = fastest_surface(wall, motion) * s.definition.time_step;
    if (jump <= smallest) return;
    std::ostringstream text;
    text << "wall «" << wall.name << "» jumps: from time " << s.time() << " s on it moves by up to " << jump << " m in a step of " << s.definition.time_step
         << " s, more than the " << smallest << " m of the smallest sphere's radius";
    throw bad_input(text.str(), "move it more slowly, or use a smaller time step");
}

}  // namespace

Simulation::State::State(SimulationDefinition given) : definition(std::move(given)) {
    const SimulationDefinition& d = definition;
    if (d.templates.empty()) throw bad_input("the simulation has no pellet template", "give it at least one");
    for (const RigidTemplate& t : d.templates) check_template(t);
    if (!(d.time_step > 0.0) || !std::isfinite(d.time_step)) throw bad_input("the time step must be positive", "see advise_time_step");
    if (!d.gravity.allFinite()) throw bad_input("gravity must be finite", "correct it");
    for (const double skin : {d.skins.bodies, d.skins.spheres, d.skins.wall_faces, d.skins.wall_candidates})
        if (!(skin >= 0.0) || !std::isfinite(skin)) throw bad_input("search skins must be zero or positive", "leave them at 0 to have them chosen");
    std::set<std::string> names;
    for (const WallDefinition& w : d.walls) {
        if (!names.insert(w.name).second) throw bad_input("two walls are called «" + w.name + "»", "give every wall its own name");
        if (!(w.feature_angle >= 0.0 && w.feature_angle < M_PI))
            throw bad_input("wall «" + w.name + "»: the feature angle must be in [0, pi)", "30 degrees is usual");
        check_motion(w.motion, w.name);
    }
    detail::check_physics(d.physics);
    detail::check_body_forces(d.body_forces);
    const TimeStepAdvice advice = advise_time_step(d);
    if (d.time_step > advice.contact_limit) {
        std::ostringstream text;
        text << "a time step of " << d.time_step << " s is unstable: " << advice.percent_of_limit(d.time_step) << " % of the limit " << advice.contact_limit
             << " s set by " << advice.limited_by;
        throw bad_input(text.str(), "use a smaller step; a third of the limit is a usual choice");
    }
    double largest = 0.0;
    for (const RigidTemplate& t : d.templates) {
        templates.push_back(detail::make_body_template(t));
        largest = std::max(largest, templates.back().bounding_radius);
    }
    for (const detail::BodyTemplate& t : templates) {
        balls.push_back(t.balls.data());
        constants.push_back(detail::motion_constants(t));
    }
    double largest_sphere = 0.0;
    for (const detail::BodyTemplate& t : templates) largest_sphere = std::max(largest_sphere, t.largest_radius);
    pellet_law = detail::make_law_row(d.pellet_material, d.pellet_material, d.pellet_contact, d.physics, 0.5 * largest_sphere, "pellet-pellet");
    kernels = choose_kernels(d.instructions);
    pellet_contact = detail::contact_kernel(*kernels, d.physics, pellet_law);
    pairs.spring_rows = detail::spring_rows(d.physics);
    pairs.hold = pellet_law.reach;
    pairs.skin = d.skins.bodies > 0.0 ? d.skins.bodies : 0.15 * largest;
    if (!(d.skins.bodies > 0.0)) pairs.smallest_skin = 0.05 * largest, pairs.largest_skin = 0.4 * largest;
    pairs.pair_skin = d.skins.spheres > 0.0 ? d.skins.spheres : 0.02 * largest;
    wall_skins.faces = d.skins.wall_faces > 0.0 ? d.skins.wall_faces : 0.25 * largest;
    wall_skins.candidates = d.skins.wall_candidates > 0.0 ? d.skins.wall_candidates : 0.02 * largest;
    pairs.skin = std::max(pairs.skin, 1.01 * pellet_law.reach);
    walls.reserve(d.walls.size());
    for (const WallDefinition& w : d.walls) {
        const detail::LawRow law = detail::make_law_row(d.pellet_material, w.material, w.contact, d.physics, largest_sphere, "pellet-" + w.name);
        walls.emplace_back(w, law, detail::contact_kernel(*kernels, d.physics, law), pairs.spring_rows);
        wall_skins.faces = std::max(wall_skins.faces, 1.01 * law.reach);
    }
    for (const detail::Wall& wall : walls) check_pace(*this, wall, wall.motion);
    wall_loads.resize(walls.size());
    book.wall_work.resize(walls.size(), 0.0);
    domain = d.domain.isEmpty() ? default_domain(d) : d.domain;
    fit_to_body_count();
}

void Simulation::State::fit_to_body_count() {
    const std::size_t n = bodies.size();
    kinematics.resize(detail::padded_count(n));
    for (detail::Wall& wall : walls) {
        wall.watches.resize(n);
        wall.wake.resize(n, detail::always_awake);
        wall.loads.resize(n);
        wall.touching.resize(n, 0);
        wall.books.assign((n + detail::wall_grain - 1) / detail::wall_grain, detail::LoadRow{});
    }
    if (pairs.body_count != n || pairs.rebuilds == 0) detail::rebuild_pairs(pairs, bodies, templates);
}

Simulation::Simulation(SimulationDefinition definition) : state_(std::make_unique<State>(std::move(definition))) {}
Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

void Simulation::add_bodies(std::span<const BodyPlacement> added, double overlap_allowed) {
    State& s = *state_;
    const std::size_t before = s.bodies.size(), n = before + added.size();
    for (const BodyPlacement& b : added) {
        if (b.template_index >= s.templates.size()) throw bad_input("a body has a template that does not exist", "use an index into the templates");
        if (!b.pose.position.allFinite() || !b.velocity.allFinite() || !b.spin.allFinite() || !(std::abs(b.pose.orientation.norm() - 1.0) < 1e-6))
            throw bad_input("a body has a pose or velocity that is not finite, or an orientation that is no unit quaternion", "correct the placement");
        if (!s.domain.contains(b.pose.position))
            throw bad_input("a body starts outside the domain, at " + place(b.pose.position), "place it inside or enlarge the domain");
    }
    const auto shrink = [&s](std::size_t count) {
        s.bodies.resize(count);
        s.fit_to_body_count();
    };
    s.bodies.resize(n);
    for (std::size_t k = 0; k < added.size(); ++k) {
        const BodyPlacement& b = added[k];
        const std::size_t i = before + k;
        detail::Bodies& all = s.bodies;
        const detail::BodyTemplate& t = s.templates[b.template_index];
        const Quat q = b.pose.orientation.normalized();
        all.set_template(i, b.template_index);
        all.set_position(i, b.pose.position);
        all.set_orientation(i, q);
        all.set_velocity(i, b.velocity);
        all.set_angular_momentum(i, detail::angular_momentum_of(t, q, b.spin));
    }
    s.fit_to_body_count();
    for (std::size_t i = 0; i < n; ++i) detail::fill_record(s.bodies, s.templates[s.bodies.template_of(i)], i, s.kinematics[i]);

    for (const detail::PairRecord& pair : s.pairs.records) {  // new bodies lie behind the others until all is checked
        if (pair.i < before && pair.j < before) continue;
        const double ratio =
            deepest_overlap(s.kinematics[pair.i], s.templates[s.bodies.template_of(pair.i)], s.kinematics[pair.j], s.templates[s.bodies.template_of(pair.j)]);
        if (ratio <= overlap_allowed) continue;
        std::ostringstream text;
        text << "bodies " << s.bodies.id(pair.i) << " and " << s.bodies.id(pair.j) << " overlap by " << 100.0 * ratio
             << " % of their smallest sphere's radius, near " << place(s.bodies.position(pair.j));
        shrink(before);
        throw bad_input(text.str(), "place bodies apart: at most " + percent(overlap_allowed) + " % is allowed");
    }
    std::vector<detail::WallOverlap> overlaps;
    for (const detail::Wall& wall : s.walls)
        for (std::size_t i = before; i < n; ++i) {
            const detail::BodyTemplate& t = s.templates[s.bodies.template_of(i)];
            overlaps.clear();
            detail::wall_overlaps(wall, s.kinematics[i], t, overlaps);
            for (const detail::WallOverlap& o : overlaps) {
                const double ratio = o.overlap / t.smallest_radius;
                if (ratio <= overlap_allowed) continue;
                std::ostringstream text;
                text << "body " << i << " overlaps wall «" << wall.name << "» by " << 100.0 * ratio << " % of its smallest sphere's radius, near "
                     << place(s.bodies.position(i));
                shrink(before);
                throw bad_input(text.str(), "place bodies apart: at most " + percent(overlap_allowed) + " % is allowed");
            }
        }
    s.order_bodies();
    detail::rebuild_pairs(s.pairs, s.bodies, s.templates);
    s.pairs.ordered_spread = s.pairs.spread;
    s.look_at_forces();
}

void Simulation::set_wall_motion(std::size_t index, const WallMotion& motion) {
    State& s = *state_;
    if (index >= s.walls.size()) throw bad_input("there is no wall with index " + std::to_string(index), "see definition().walls");
    detail::Wall& wall = s.walls[index];
    check_motion(motion, wall.name);
    check_pace(s, wall, motion);
    wall.motion = motion;
    wall.motion_start = s.steps;
    wall.start_pose = wall.pose;
    detail::move_wall(wall, s.steps, s.definition.time_step);
    std::fill(wall.wake.begin(), wall.wake.end(), detail::always_awake);
}

double Simulation::time() const {
    return state_->time();
}

std::uint64_t Simulation::step_count() const {
    return state_->steps;
}

const SimulationDefinition& Simulation::definition() const {
    return state_->definition;
}

const BodyState& Simulation::bodies() const {
    const State& s = *state_;
    if (!s.view_is_current) {
        const std::size_t n = s.bodies.size();
        BodyState& v = s.view;
        v.template_index.resize(n), v.position.resize(n), v.orientation.resize(n), v.velocity.resize(n), v.spin.resize(n), v.force.resize(n),
            v.torque.resize(n);
        for (std::size_t id = 0; id < n; ++id) {
            const std::size_t i = s.bodies.place_of(id);
            v.template_index[id] = s.bodies.template_of(i);
            v.position[id] = s.bodies.position(i);
            v.orientation[id] = s.bodies.orientation(i);
            v.velocity[id] = s.bodies.velocity(i);
            v.spin[id] = detail::spin_of(s.templates[s.bodies.template_of(i)], v.orientation[id], s.bodies.angular_momentum(i));
            v.force[id] = s.bodies.force(i);
            v.torque[id] = s.bodies.torque(i);
        }
        s.view_is_current = true;
    }
    return s.view;
}

std::vector<Pose> Simulation::wall_poses() const {
    std::vector<Pose> poses;
    for (const detail::Wall& wall : state_->walls) poses.push_back(wall.pose);
    return poses;
}

const std::vector<WallLoad>& Simulation::wall_loads() const {
    return state_->wall_loads;
}

}  // namespace pelletlab::solver
