// What a simulation tells of itself besides bodies and loads: contacts, the neighbour search, time spent, and the hash of its state.
#include <algorithm>
#include <bit>

#include "core/parallel.hpp"
#include "solver/detail/state.hpp"
#include "solver/simulation.hpp"

namespace pelletlab::solver {

std::vector<WallReport> Simulation::wall_reports() const {
    std::vector<WallReport> reports;
    for (const detail::Wall& wall : state_->walls) reports.push_back(wall.mesh.report);
    return reports;
}

std::uint64_t Simulation::neighbour_rebuilds() const {
    return state_->pairs.rebuilds;
}

SearchReport Simulation::search_report() const {
    const State& s = *state_;
    const auto bytes = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
    SearchReport report;
    report.listed_pairs = s.pairs.records.size();
    for (const detail::PairRecord& r : s.pairs.records) {
        report.candidates += r.count;
        if (r.count > 0) ++report.pairs_with_candidates;
    }
    for (const detail::PairBlock& block : s.pairs.blocks) report.bytes += bytes(block.candidates) + bytes(block.springs);
    report.bytes += bytes(s.pairs.records) + bytes(s.pairs.own_loads) + bytes(s.pairs.loads_j) + bytes(s.pairs.touching) + bytes(s.pairs.incoming) +
                    bytes(s.pairs.incoming_first) + bytes(s.pairs.rows.first) + bytes(s.pairs.rows.partner) + bytes(s.kinematics) +
                    s.bodies.size() * 23 * sizeof(double);
    for (const detail::Wall& wall : s.walls) {
        report.bytes += bytes(wall.watches) + bytes(wall.loads) + bytes(wall.touching);
        for (const detail::WallWatch& watch : wall.watches) {
            if (!watch.near) continue;
            ++report.bodies_near_walls;
            report.wall_candidates += watch.near->candidates.size();
            report.bytes += sizeof(detail::NearWall) + bytes(watch.near->faces) + bytes(watch.near->candidates) + bytes(watch.near->history);
        }
    }
    return report;
}

std::vector<StageTime> Simulation::stage_times() const {
    std::vector<StageTime> times;
    for (std::size_t k = 0; k < detail::stage_names.size(); ++k) times.push_back({detail::stage_names[k], state_->stage_seconds[k]});
    return times;
}

namespace {

/// Calls visit(candidate, d, overlap) for the touching spheres of a pair; d from the first sphere's centre to the second's, world.
template <class Visit>
void for_each_overlap(const Simulation::State& s, const detail::PairRecord& r, const detail::PairBlock& block, const Visit& visit) {
    const Pose pi{s.bodies.position(r.i), s.bodies.orientation(r.i)}, pj{s.bodies.position(r.j), s.bodies.orientation(r.j)};
    const auto &ti = s.templates[r.template_i], &tj = s.templates[r.template_j];
    for (std::size_t c = r.first; c < r.first + std::size_t{r.count}; ++c) {
        const auto &a = ti.balls[block.candidates[c].sphere_a()], &b = tj.balls[block.candidates[c].b];
        const Vec3 d = pj.to_world({b.x, b.y, b.z}) - pi.to_world({a.x, a.y, a.z});
        const double overlap = a.r + b.r - d.norm();
        if (overlap > 0.0) visit(c, d, overlap);
    }
}

ContactSummary joined(const ContactSummary& a, const ContactSummary& b) {
    return {a.sphere_contacts + b.sphere_contacts, a.wall_contacts + b.wall_contacts, a.touching_pairs + b.touching_pairs,
            std::max(a.largest_overlap_ratio, b.largest_overlap_ratio)};
}

ContactSummary pair_summary(const Simulation::State& s, const detail::PairBlock& block) {
    ContactSummary sum;
    for (std::uint32_t k = block.pair_begin; k < block.pair_end; ++k) {
        const detail::PairRecord& r = s.pairs.records[k];
        const auto &ti = s.templates[r.template_i], &tj = s.templates[r.template_j];
        const std::size_t before = sum.sphere_contacts;
        for_each_overlap(s, r, block, [&](std::size_t c, const Vec3&, double overlap) {
            const double radius = std::min(ti.balls[block.candidates[c].sphere_a()].r, tj.balls[block.candidates[c].b].r);
            ++sum.sphere_contacts;
            sum.largest_overlap_ratio = std::max(sum.largest_overlap_ratio, overlap / radius);
        });
        if (sum.sphere_contacts > before) ++sum.touching_pairs;
    }
    return sum;
}

ContactSummary wall_summary(const Simulation::State& s, const detail::Wall& wall, std::size_t begin, std::size_t end) {
    ContactSummary sum;
    std::vector<detail::WallOverlap> overlaps;
    for (std::size_t i = begin; i < end; ++i) {
        if (!wall.watches[i].near) continue;
        const detail::BodyTemplate& t = s.templates[s.bodies.template_of(i)];
        overlaps.clear();
        detail::wall_overlaps(wall, s.kinematics[i], t, overlaps);
        sum.wall_contacts += overlaps.size();
        for (const detail::WallOverlap& o : overlaps) sum.largest_overlap_ratio = std::max(sum.largest_overlap_ratio, o.overlap / t.balls[o.sphere].r);
    }
    return sum;
}

}  // namespace

std::vector<ContactPoint> Simulation::contact_points() const {
    const State& s = *state_;
    std::vector<ContactPoint> points;
    detail::for_each_record(s.pairs, s.bodies, [&](const detail::PairRecord& r, const detail::PairBlock& block) {
        const Quat turn = s.bodies.orientation(r.i);
        for_each_overlap(s, r, block, [&](std::size_t c, const Vec3& d, double overlap) {
            const detail::Candidate& candidate = block.candidates[c];
            const detail::Spring& spring = block.springs[c * s.pairs.spring_rows];
            points.push_back({s.bodies.id(r.i), candidate.sphere_a(), -1, s.bodies.id(r.j), candidate.b, d.normalized(), overlap,
                              turn * Vec3(spring.row[0], spring.row[1], spring.row[2])});
        });
    });
    std::vector<detail::WallOverlap> overlaps;
    for (std::size_t w = 0; w < s.walls.size(); ++w)
        for (std::uint32_t id = 0; id < s.bodies.size(); ++id) {
            const std::uint32_t i = s.bodies.place_of(id);
            const detail::WallWatch& watch = s.walls[w].watches[i];
            if (!watch.near) continue;
            overlaps.clear();
            detail::wall_overlaps(s.walls[w], s.kinematics[i], s.templates[s.bodies.template_of(i)], overlaps);
            for (const detail::WallOverlap& o : overlaps) {
                ContactPoint point{id, o.sphere, static_cast<std::int32_t>(w), 0, 0, s.walls[w].pose.orientation * o.normal, o.overlap, Vec3::Zero()};
                for (const detail::WallHistory& h : watch.near->history)
                    if (h.sphere == o.sphere && h.patch == o.patch && h.normal.dot(o.normal) > 0.999) point.spring = s.walls[w].pose.orientation * h.spring;
                points.push_back(point);
            }
        }
    return points;
}

ContactSummary Simulation::contacts() const {
    const State& s = *state_;
    ContactSummary sum = parallel_reduce(
        s.pairs.blocks.size(), 4, ContactSummary{},
        [&](std::size_t begin, std::size_t end) {
            ContactSummary part;
            for (std::size_t block = begin; block < end; ++block) part = joined(part, pair_summary(s, s.pairs.blocks[block]));
            return part;
        },
        joined);
    for (const detail::Wall& wall : s.walls)
        sum = joined(sum, parallel_reduce(
                              s.bodies.size(), detail::wall_grain, ContactSummary{},
                              [&](std::size_t begin, std::size_t end) { return wall_summary(s, wall, begin, end); }, joined));
    return sum;
}

std::uint64_t Simulation::state_hash() const {
    const State& s = *state_;
    detail::Hash hash;
    hash.add(s.steps);
    for (std::size_t id = 0; id < s.bodies.size(); ++id) {
        const std::size_t i = s.bodies.place_of(id);
        hash.add(std::uint64_t{s.bodies.template_of(i)});
        for (const double x : s.bodies.numbers(i)) hash.add(x);
    }
    detail::for_each_record(s.pairs, s.bodies, [&](const detail::PairRecord& r, const detail::PairBlock& block) {
        for (std::size_t c = r.first; c < r.first + std::size_t{r.count}; ++c) {
            if (!block.candidates[c].touching()) continue;
            hash.add((std::uint64_t{s.bodies.id(r.i)} << 32) | s.bodies.id(r.j));
            hash.add(std::uint64_t{block.candidates[c].key()});
            for (std::size_t row = c * s.pairs.spring_rows; row < (c + 1) * s.pairs.spring_rows; ++row)
                for (const double x : block.springs[row].row) hash.add(x);
        }
    });
    for (const detail::Wall& wall : s.walls) {
        hash.add(wall.pose.position);
        hash.add(wall.pose.orientation);
        hash.add(wall.motion.point);
        hash.add(wall.motion.axis);
        hash.add(wall.motion.rotation_speed);
        hash.add(wall.motion.velocity), hash.add(wall.motion.oscillation);
        for (const double x : {wall.motion.swing, wall.motion.frequency, wall.motion.phase}) hash.add(x);
        for (const MotionRow& row : wall.motion.table) hash.add(row.time), hash.add(row.shift), hash.add(row.angle);
        for (std::size_t id = 0; id < wall.watches.size(); ++id) {
            const std::size_t i = s.bodies.place_of(id);
            if (!wall.watches[i].near) continue;
            for (const detail::WallHistory& h : wall.watches[i].near->history) {
                hash.add((std::uint64_t{id} << 32) | h.sphere);
                hash.add(std::uint64_t{h.patch});
                hash.add(h.normal);
                hash.add(h.spring);
                hash.add(h.torque);
                hash.add(h.last_overlap);
            }
        }
    }
    return hash.value();
}

namespace detail {

void Hash::add(double number) {
    add(std::bit_cast<std::uint64_t>(number));
}

}  // namespace detail

}  // namespace pelletlab::solver
