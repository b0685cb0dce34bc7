#include "solver/contact_events.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "core/error.hpp"
#include "solver/detail/contact_recorder.hpp"
#include "solver/detail/state.hpp"

namespace pelletlab::solver {

namespace {

using detail::OpenEvent;

void close(ContactEvents& kind, const OpenEvent& event, std::uint64_t step, double dt) {
    kind.dissipated += event.total;
    if (event.impact < 0.0) return;  // its beginning is not known
    kind.complete += 1.0;
    kind.duration += static_cast<double>(step - event.since) * dt;
    kind.dissipated_complete += event.total;
    const std::array<double, event_energies> energies{event.impact, event.normal, event.total};
    for (std::size_t k = 0; k < event_energies; ++k) {
        const std::size_t bin = spectrum_bin(energies[k]);
        kind.spectra[k].count[bin] += 1.0;
        kind.spectra[k].energy[bin] += energies[k];
    }
}

/// Those that ended in this step, in an order that does not depend on where bodies lie in memory.
void close_all(ContactEvents& kind, std::vector<OpenEvent>& ended, std::uint64_t step, double dt) {
    std::sort(ended.begin(), ended.end(), [](const OpenEvent& a, const OpenEvent& b) { return a.key < b.key; });
    for (const OpenEvent& event : ended) close(kind, event, step, dt);
    ended.clear();
}

double dissipated(const detail::LoadRow& book) {
    using namespace detail;
    return book.row[book_normal_damping] + book.row[book_tangential_damping] + book.row[book_sliding] + book.row[book_rolling];
}

Vec3 velocity_at(const detail::Kinematic& k, const Vec3& point) {
    const Vec3 place(k.place[0], k.place[1], k.place[2]), v(k.motion[0], k.motion[1], k.motion[2]), spin(k.motion[3], k.motion[4], k.motion[5]);
    return v + spin.cross(point - place);
}

double impact_energy(const detail::Kinematic& i, const detail::Kinematic& j, const Vec3& point, const Vec3& normal_from_i_to_j) {
    const double approach = std::max(0.0, -(velocity_at(j, point) - velocity_at(i, point)).dot(normal_from_i_to_j));
    return 0.5 * approach * approach / (i.motion[6] + j.motion[6]);
}

/// At the deepest sphere contact of the pair.
double impact_of_pair(const Simulation::State& s, const detail::PairRecord& r, const detail::PairBlock& block) {
    const detail::Kinematic &ki = s.kinematics[r.i], &kj = s.kinematics[r.j];
    const auto pose = [](const detail::Kinematic& k) {
        return Pose{Vec3(k.place[0], k.place[1], k.place[2]), Quat(k.place[3], k.place[4], k.place[5], k.place[6])};
    };
    const Pose pi = pose(ki), pj = pose(kj);
    double deepest = 0.0, energy = 0.0;
    for (std::size_t c = r.first; c < r.first + std::size_t{r.count}; ++c) {
        const detail::Candidate& candidate = block.candidates[c];
        if (!candidate.touching()) continue;
        const detail::Ball &a = s.balls[r.template_i][candidate.sphere_a()], &b = s.balls[r.template_j][candidate.b];
        const Vec3 from = pi.to_world({a.x, a.y, a.z}), d = pj.to_world({b.x, b.y, b.z}) - from;
        const double distance = d.norm(), overlap = a.r + b.r - distance;
        if (overlap <= deepest || !(distance > 0.0)) continue;
        deepest = overlap;
        energy = impact_energy(ki, kj, from + d * ((a.r - 0.5 * overlap) / distance), d / distance);
    }
    return energy;
}

double impact_with_wall(const Simulation::State& s, const detail::Wall& wall, std::size_t i) {
    const detail::BodyTemplate& t = s.templates[s.bodies.template_of(i)];
    std::vector<detail::WallOverlap> overlaps;
    detail::wall_overlaps(wall, s.kinematics[i], t, overlaps);
    const detail::Kinematic& k = s.kinematics[i];
    const Pose body{Vec3(k.place[0], k.place[1], k.place[2]), Quat(k.place[3], k.place[4], k.place[5], k.place[6])};
    double deepest = 0.0, energy = 0.0;
    for (const detail::WallOverlap& o : overlaps) {
        if (o.overlap <= deepest) continue;
        deepest = o.overlap;
        const detail::Ball& ball = t.balls[o.sphere];
        const Vec3 normal = wall.pose.orientation * o.normal;
        energy = impact_energy(wall.record, k, body.to_world({ball.x, ball.y, ball.z}) - (ball.r - o.overlap) * normal, normal);
    }
    return energy;
}

/// Brings the events of pairs to the records of a list that was made anew. Pairs that are listed no more have ended before.
void follow_rebuild(detail::ContactRecorder& recorder, const Simulation::State& s) {
    std::unordered_map<std::uint64_t, OpenEvent> open;
    for (const OpenEvent& event : recorder.pairs)
        if (event.goes_on()) open.emplace(event.key, event);
    recorder.pairs.assign(s.pairs.records.size(), OpenEvent{});
    for (std::size_t k = 0; k < s.pairs.records.size(); ++k) {
        const detail::PairRecord& r = s.pairs.records[k];
        OpenEvent& event = recorder.pairs[k];
        event.key = (std::uint64_t{s.bodies.id(r.i)} << 32) | s.bodies.id(r.j);
        if (const auto found = open.find(event.key); found != open.end()) {
            event = found->second;
            open.erase(found);
        }
    }
    for (const auto& [key, event] : open) recorder.ended.push_back(event);
    recorder.seen_rebuilds = s.pairs.rebuilds;
}

/// Events of walls lie by body id, which no reordering moves.
void begin_or_end(OpenEvent& event, bool touches, std::uint64_t key, std::uint64_t step, bool old, std::vector<OpenEvent>& ended, const auto& impact) {
    if (touches && !event.goes_on()) event = {key, step, old ? -1.0 : impact(), 0.0, 0.0};
    if (!touches && event.goes_on()) {
        ended.push_back(event);
        event = {key, 0, -1.0, 0.0, 0.0};
    }
}

void add(OpenEvent& event, const detail::LoadRow& book) {
    event.normal += book.row[detail::book_normal_damping];
    event.total += dissipated(book);
}

/// Adds what the events that still go on have dissipated so far, in the order of their keys.
void add_open(ContactEvents& kind, std::vector<OpenEvent> events) {
    std::sort(events.begin(), events.end(), [](const OpenEvent& a, const OpenEvent& b) { return a.key < b.key; });
    for (const OpenEvent& event : events)
        if (event.goes_on()) kind.dissipated += event.total;
}

}  // namespace

double spectrum_edge(std::size_t bin) {
    return spectrum_lowest * std::pow(10.0, static_cast<double>(bin) / static_cast<double>(spectrum_bins_a_decade));
}

std::size_t spectrum_bin(double energy) {
    if (!(energy > spectrum_lowest)) return 0;
    const double place = std::log10(energy / spectrum_lowest) * static_cast<double>(spectrum_bins_a_decade);
    return std::min(spectrum_bins - 1, static_cast<std::size_t>(place));
}

void Simulation::record_contact_events() {
    State& s = *state_;
    if (!s.definition.physics.energy_book)
        throw bad_input("contact events need the energy book", "set physics.energy_book in the definition of the simulation");
    s.recorder.kinds.assign(1 + s.walls.size(), {});
    s.recorder.pairs.clear();
    s.recorder.walls.assign(s.walls.size(), {});
    s.recorder.seen_rebuilds = 0;
    s.recorder.started = s.steps + 1;
}

std::vector<ContactEvents> Simulation::contact_events() const {
    const detail::ContactRecorder& recorder = state_->recorder;
    std::vector<ContactEvents> kinds = recorder.kinds;
    if (kinds.empty()) return kinds;
    add_open(kinds[0], recorder.pairs);
    for (std::size_t w = 0; w < recorder.walls.size(); ++w) add_open(kinds[1 + w], recorder.walls[w]);
    return kinds;
}

void Simulation::State::record_events() {
    if (recorder.started == 0) return;
    const bool first = steps == recorder.started;  // what touches now began before
    const double dt = definition.time_step;
    if (recorder.seen_rebuilds != pairs.rebuilds || recorder.pairs.size() != pairs.records.size()) follow_rebuild(recorder, *this);
    ContactEvents& between = recorder.kinds[0];
    for (const detail::PairBlock& block : pairs.blocks)
        for (std::size_t k = block.pair_begin; k < block.pair_end; ++k) {
            OpenEvent& event = recorder.pairs[k];
            if (!pairs.touching[k] && !event.goes_on()) continue;
            begin_or_end(event, pairs.touching[k] != 0, event.key, steps, first, recorder.ended,
                         [&] { return impact_of_pair(*this, pairs.records[k], block); });
            if (pairs.touching[k]) add(event, pairs.pair_books[k]);
        }
    close_all(between, recorder.ended, steps, dt);
    for (std::size_t w = 0; w < walls.size(); ++w) {
        const detail::Wall& wall = walls[w];
        std::vector<OpenEvent>& events = recorder.walls[w];
        events.resize(bodies.size());
        for (std::uint32_t id = 0; id < bodies.size(); ++id) {
            const std::size_t i = bodies.place_of(id);
            if (!wall.touching[i] && !events[id].goes_on()) continue;
            begin_or_end(events[id], wall.touching[i] != 0, id, steps, first, recorder.ended, [&] { return impact_with_wall(*this, wall, i); });
            if (wall.touching[i]) add(events[id], wall.body_books[i]);
        }
        close_all(recorder.kinds[1 + w], recorder.ended, steps, dt);
    }
}

}  // namespace pelletlab::solver
