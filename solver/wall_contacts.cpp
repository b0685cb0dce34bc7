#include "solver/detail/wall_contacts.hpp"

#include <algorithm>
#include <cmath>

#include "solver/detail/aligned_scratch.hpp"
#include "solver/detail/motion.hpp"
#include "solver/detail/wall_search.hpp"

namespace pelletlab::solver::detail {

namespace {

/// A body that touches the wall, waiting for its contact forces.
struct Active {
    std::uint32_t body;
    std::uint32_t first_contact, contact_end;
    Vec3 place;  ///< of the body in the frame of the wall
};

/// Scratch of one worker.
struct Scratch {
    BatchStorage storage;
    std::vector<PairSlot> slots;
    std::vector<std::uint32_t> awake;  ///< bodies that must be looked at
    std::vector<Active> active;
    std::vector<WallHistory> fresh;  ///< of each contact
    std::vector<Spring> springs;     ///< of each contact
    std::size_t cursor = 0;          ///< in the history of the body at hand
    std::vector<Hit> hits;
    std::vector<std::uint32_t> faces;
    std::vector<std::uint8_t> used;
};

/// a turned by the smallest rotation that takes unit vector `from` to unit vector `to`.
Vec3 turned(const Vec3& a, const Vec3& from, const Vec3& to) {
    if (from == to) return a;
    const Vec3 axis = from.cross(to);
    const double c = from.dot(to);
    if (c < -0.999) return a - to * a.dot(to);
    return a * c + axis.cross(a) + axis * (axis.dot(a) / (1.0 + c));
}

/// The history that contact (sphere, patch, normal) inherits: from the same patch first, then from any contact of the sphere that pointed the same
/// way (the hand-over at an edge); each old contact serves once.
WallHistory inherited(const std::vector<WallHistory>& history, std::vector<std::uint8_t>& used, std::size_t& cursor, std::uint32_t sphere, std::uint32_t patch,
                      const Vec3& normal) {
    WallHistory fresh;
    fresh.sphere = sphere, fresh.patch = patch, fresh.normal = normal;
    constexpr double same_way = 0.70710678;  // within 45°
    while (cursor < history.size() && history[cursor].sphere < sphere) ++cursor;
    if (cursor == history.size() || history[cursor].sphere != sphere) return fresh;
    for (const bool same_patch : {true, false}) {
        double best = same_way;
        std::size_t choice = history.size();
        for (std::size_t h = cursor; h < history.size() && history[h].sphere == sphere; ++h) {
            if (used[h] || (same_patch && history[h].patch != patch)) continue;
            const double alike = history[h].normal.dot(normal);
            if (alike > best) best = alike, choice = h;
        }
        if (choice < history.size()) {
            used[choice] = 1;
            const WallHistory& old = history[choice];
            fresh.spring = turned(old.spring, old.normal, normal);
            fresh.torque = turned(old.torque, old.normal, normal);
            fresh.last_overlap = old.last_overlap;
            return fresh;
        }
    }
    return fresh;
}

/// From the wall to the sphere's centre; where that lies on the wall, the wall's own normal.
Vec3 normal_of(const Wall& wall, const Hit& hit, const Vec3& centre, double distance) {
    if (distance > 0.0) return (centre - hit.point) / distance;
    return wall.is_exact() ? wall.exact.axis : wall.mesh.normals[hit.face];
}

void add_contact(const Wall& wall, const NearWall& near, std::uint32_t sphere, const Ball& ball, const Vec3& c, const Hit& hit, Scratch& s) {
    const double distance = std::sqrt(hit.distance2);
    const Vec3 normal = normal_of(wall, hit, c, distance);
    const std::uint32_t patch = wall.patch_of(hit);
    const WallHistory history = inherited(near.history, s.used, s.cursor, sphere, patch, normal);
    ContactBatch& b = s.storage.batch;
    const std::size_t n = b.size++;
    const Vec3 d = normal * std::max(distance, 1e-200);
    b.dx[n] = d.x(), b.dy[n] = d.y(), b.dz[n] = d.z();
    b.ax[n] = hit.point.x(), b.ay[n] = hit.point.y(), b.az[n] = hit.point.z();
    b.ra[n] = 0.0, b.rb[n] = ball.r;
    b.slot[n] = static_cast<std::uint32_t>(s.slots.size());
    b.spring[n] = static_cast<std::uint32_t>(n);
    s.fresh.push_back(history);
    s.springs.push_back({{history.spring.x(), history.spring.y(), history.spring.z(), history.last_overlap}});
    if (wall.spring_rows > 1) s.springs.push_back({{history.torque.x(), history.torque.y(), history.torque.z(), 0.0}});
}

bool has_touched(const std::vector<WallHistory>& history, std::uint32_t sphere) {
    return std::any_of(history.begin(), history.end(), [sphere](const WallHistory& h) { return h.sphere == sphere; });
}

/// ClumpPolicy::shared: the contacts of one body with one patch carry shares of one load, see share_loads of pair_kernel_impl.hpp.
void share_loads(const Scratch& s, ContactBatch& b, std::size_t first) {
    for (std::size_t c = first; c < b.size; ++c) {
        double sum = 0.0, own = 0.0, contacts = 0.0;
        for (std::size_t d = first; d < b.size; ++d) {
            if (s.fresh[d].patch != s.fresh[c].patch) continue;
            const double overlap = std::max(0.0, b.rb[d] - std::sqrt(b.dx[d] * b.dx[d] + b.dy[d] * b.dy[d] + b.dz[d] * b.dz[d]));
            sum += overlap;
            contacts += 1.0;
            if (d == c) own = overlap;
        }
        b.share[c] = sum > 0.0 ? own / sum : 1.0 / contacts;
    }
}

/// Puts the contacts of one body into the batch. True when there are any.
bool collect(const Wall& wall, const NearWall& near, const RelativePose& pose, const BodyTemplate& t, Scratch& s) {
    const Mat3 r = rotation_of(pose);
    const Vec3 p = vec(pose.p);
    const std::size_t before = s.storage.batch.size;
    s.storage.reserve(before + near.candidates.size() * (wall.is_exact() ? exact_patches : 1), wall.law.booked);
    s.used.assign(near.history.size(), 0);
    s.cursor = 0;
    for (std::size_t k = 0; k < near.candidates.size();) {
        const std::uint32_t sphere = near.candidates[k].sphere;
        const Ball& ball = t.balls[sphere];
        const Vec3 c = r * Vec3(ball.x, ball.y, ball.z) + p;
        s.hits.clear();
        const double reach = ball.r + (wall.law.reach > 0.0 && has_touched(near.history, sphere) ? wall.law.reach : 0.0);
        if (wall.is_exact()) {
            ++k;
            exact_hits(wall.exact, c, reach, s.hits);
            for (const Hit& hit : s.hits) add_contact(wall, near, sphere, ball, c, hit, s);
            continue;
        }
        for (; k < near.candidates.size() && near.candidates[k].sphere == sphere; ++k) {
            Hit hit;
            if (touches(wall.mesh, near.candidates[k].face, c, reach, hit)) s.hits.push_back(hit);
        }
        if (s.hits.size() == 1) {
            if (is_local_minimum(wall.mesh, s.hits[0], c)) add_contact(wall, near, sphere, ball, c, s.hits[0], s);
        } else if (!s.hits.empty()) {
            keep_contacts(wall.mesh, c, ball.r, s.hits);
            for (const Hit& hit : s.hits) add_contact(wall, near, sphere, ball, c, hit, s);
        }
    }
    return s.storage.batch.size > before;
}

PairSlot slot_of(const Mat3& to_wall, const Kinematic& wall, const Kinematic& body, const RelativePose& pose, double inertia_share) {
    const Vec3 v = to_wall * (vec(body.velocity()) - vec(wall.velocity())), spin = to_wall * (vec(body.spin()) - vec(wall.spin())),
               body_spin = to_wall * vec(body.spin());
    const Vec3 at_origin = v - body_spin.cross(vec(pose.p));
    PairSlot slot;
    for (int k = 0; k < 3; ++k) slot.row[k] = at_origin[k], slot.row[3 + k] = spin[k];
    slot.row[6] = 1.0 / body.motion[6];
    slot.row[7] = inertia_share / body.motion[7];
    return slot;
}

/// What the next bodies need lies in many places, each found through the one before: a step of the way for each of the next bodies.
void fetch_ahead(const Wall& wall, const std::vector<std::uint32_t>& awake, std::size_t at, const LargeVector<Kinematic>& kinematics) {
    if (at + 6 < awake.size()) __builtin_prefetch(&wall.watches[awake[at + 6]]);
    if (at + 4 < awake.size()) {
        const std::uint32_t i = awake[at + 4];
        __builtin_prefetch(kinematics[i].place);
        __builtin_prefetch(kinematics[i].motion);
        if (const NearWall* near = wall.watches[i].near.get(); near) {
            const char* bytes = reinterpret_cast<const char*>(near);
            for (std::size_t offset = 0; offset < sizeof(NearWall); offset += 64) __builtin_prefetch(bytes + offset);
        }
    }
    if (at + 2 < awake.size())
        if (const NearWall* near = wall.watches[awake[at + 2]].near.get(); near) {
            if (!near->candidates.empty()) __builtin_prefetch(near->candidates.data());
            for (const WallHistory& history : near->history) {
                __builtin_prefetch(&history);
                __builtin_prefetch(&history.last_overlap);
            }
        }
}

/// The mesh that an exact wall carries along: the one it was given, or one triangle.
WallMesh stand_in_for(const WallDefinition& d) {
    check_surface(d.exact, d.name);
    const Vec3 p = d.exact.point, u = d.exact.axis.unitOrthogonal();
    TriangleMesh triangle;
    triangle.vertices = {p, p + u, p + d.exact.axis.cross(u)};
    triangle.faces = {{0, 1, 2}};
    WallMesh mesh = make_wall_mesh(d.mesh.faces.empty() ? triangle : d.mesh, d.feature_angle, d.name);
    mesh.patch_count = exact_patches;
    return mesh;
}

}  // namespace

Wall::Wall(const WallDefinition& d, const LawRow& row, ContactKernel kernel, std::size_t rows)
    : name(d.name),
      mesh(d.exact.kind == ExactSurface::Kind::none ? make_wall_mesh(d.mesh, d.feature_angle, d.name) : stand_in_for(d)),
      query(mesh),
      law(row),
      contact(kernel),
      spring_rows(rows),
      exact(d.exact),
      motion(d.motion) {
    law.wall = true;
    move_wall(*this, 0, 0.0);
}

void move_wall(Wall& wall, std::uint64_t step, double dt) {
    wall.place = place_at(wall.motion, static_cast<double>(step - wall.motion_start) * dt);
    const Quat turn(Eigen::AngleAxisd(wall.place.angle, wall.motion.axis));
    const Vec3 point = wall.motion.point;
    wall.pose.orientation = (turn * wall.start_pose.orientation).normalized();
    wall.pose.position = point + turn * (wall.start_pose.position - point) + wall.place.shift;
    const Vec3 spin = wall.motion.axis * wall.place.angular_speed;
    const Vec3 v = wall.place.velocity + spin.cross(wall.pose.position - (point + wall.place.shift));
    for (int k = 0; k < 3; ++k) {
        wall.record.position()[k] = wall.pose.position[k];
        wall.record.velocity()[k] = v[k];
        wall.record.spin()[k] = spin[k];
    }
    const Quat& q = wall.pose.orientation;
    double* turn_row = wall.record.turn();
    turn_row[0] = q.w(), turn_row[1] = q.x(), turn_row[2] = q.y(), turn_row[3] = q.z();
    wall.record.place[7] = wall.record.motion[6] = wall.record.motion[7] = 0.0;
}

void wall_contact_forces(Wall& wall, std::size_t block, std::size_t begin, std::size_t end, const LargeVector<Kinematic>& kinematics, const Bodies& bodies,
                         const std::vector<BodyTemplate>& templates, const WallSkins& skins, const StepClock& clock) {
    thread_local Scratch s;  // grows once, holds nothing between calls
    s.storage.batch.size = 0;
    s.slots.clear();
    s.active.clear();
    s.fresh.clear();
    s.springs.clear();
    const double* q = wall.record.turn();
    const Matrix3 frame = matrix_of(q[0], q[1], q[2], q[3]);
    const Mat3 to_world = quat(q).toRotationMatrix(), to_wall = to_world.transpose();
    std::fill(wall.touching.begin() + static_cast<std::ptrdiff_t>(begin), wall.touching.begin() + static_cast<std::ptrdiff_t>(end), std::uint8_t{0});
    s.awake.clear();
    for (std::size_t i = begin; i < end; ++i)
        if (!(bodies.path(i) + wall.path <= wall.wake[i])) s.awake.push_back(static_cast<std::uint32_t>(i));
    for (std::size_t a = 0; a < s.awake.size(); ++a) {
        fetch_ahead(wall, s.awake, a, kinematics);
        const std::size_t i = s.awake[a];
        const double path = bodies.path(i) + wall.path;
        WallWatch& watch = wall.watches[i];
        const BodyTemplate& t = templates[bodies.template_of(i)];
        bool moved = false;
        if (!(path <= watch.settled_until)) {
            const double left = way_left(watch, frame, wall.record, kinematics[i]);
            moved = !(left >= 0.0);
            watch.settled_until = path + 0.999 * left;
            if (!moved && !watch.near) {
                wall.wake[i] = watch.settled_until;
                continue;
            }
        }
        const RelativePose pose = relative_pose(wall.record, kinematics[i]);
        if (moved) {
            watch_anew(wall, watch, pose, t.bounding_radius, skins.faces, s.faces);
            watch.settled_until = path + 0.999 * watch.allowance;
            wall.wake[i] = watch.near ? always_awake : watch.settled_until;
        }
        if (!watch.near) continue;
        NearWall& near = *watch.near;
        const bool too_generous = !near.candidates.empty() && clock.index - near.refreshed > 256 && near.skin > 0.1 * skins.candidates;
        if (too_generous || is_stale(near, pose, t.largest_offset)) find_candidates(wall, near, pose, t, skins.candidates, clock.index);
        const auto first = static_cast<std::uint32_t>(s.storage.batch.size);
        if (near.candidates.empty() || !collect(wall, near, pose, t, s)) {
            near.history.clear();
            continue;
        }
        const auto contact_end = static_cast<std::uint32_t>(s.storage.batch.size);
        const double inertia_share = wall.spring_rows > 1 ? 1.0 : rolling_share / static_cast<double>(contact_end - first);
        s.slots.push_back(slot_of(to_wall, wall.record, kinematics[i], pose, inertia_share));
        if (wall.law.shared) share_loads(s, s.storage.batch, first);
        s.active.push_back({static_cast<std::uint32_t>(i), first, contact_end, vec(pose.p)});
    }

    ContactBatch& batch = s.storage.batch;
    batch.springs = s.springs.data();
    wall.contact(wall.law, batch, s.slots.data(), clock);
    if (wall.law.booked) {
        LoadRow& book = wall.books[block];
        book = LoadRow{};
        for (std::size_t c = 0; c < batch.size; ++c)
            for (int column = 0; column < 8; ++column) book.row[column] += batch.book[c].row[column];
        if (!wall.body_books.empty())
            for (const Active& active : s.active) {
                LoadRow& sum = wall.body_books[active.body] = LoadRow{};
                for (std::uint32_t c = active.first_contact; c < active.contact_end; ++c)
                    for (int column = 0; column < 8; ++column) sum.row[column] += batch.book[c].row[column];
            }
    }

    for (const Active& active : s.active) {
        Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
        for (std::uint32_t c = active.first_contact; c < active.contact_end; ++c) {
            force += vec(batch.result[c].force());
            torque += vec(batch.result[c].torque());
        }
        if (clock.spring_step > 0.0) {
            std::vector<WallHistory>& history = wall.watches[active.body].near->history;
            history.assign(s.fresh.begin() + active.first_contact, s.fresh.begin() + active.contact_end);
            for (std::uint32_t c = active.first_contact; c < active.contact_end; ++c) {
                WallHistory& kept = history[c - active.first_contact];
                const Spring* rows = &s.springs[c * wall.spring_rows];
                kept.spring = vec(rows[0].row);
                kept.last_overlap = rows[0].row[3];
                if (wall.spring_rows > 1) kept.torque = vec(rows[1].row);
            }
        }
        const Vec3 world_force = to_world * force, world_torque = to_world * (torque - active.place.cross(force));
        LoadRow& load = wall.loads[active.body];
        for (int k = 0; k < 3; ++k) load.force()[k] = world_force[k], load.torque()[k] = world_torque[k];
        wall.touching[active.body] = 1;
    }
}

void wall_overlaps(const Wall& wall, const Kinematic& body, const BodyTemplate& t, std::vector<WallOverlap>& overlaps) {
    std::vector<std::uint32_t> faces;
    std::vector<Hit> hits;
    const RelativePose pose = relative_pose(wall.record, body);
    if (wall.is_exact()) {
        if (distance_to(wall.exact, vec(pose.p)) > t.bounding_radius) return;
    } else {
        wall.query.faces_near(wall.mesh, vec(pose.p), t.bounding_radius, faces);
        if (faces.empty()) return;
    }
    const Mat3 r = rotation_of(pose);
    for (std::uint32_t a = 0; a < t.balls.size(); ++a) {
        const auto& ball = t.balls[a];
        const Vec3 c = r * Vec3(ball.x, ball.y, ball.z) + vec(pose.p);
        hits.clear();
        for (const std::uint32_t f : faces) {
            const Hit hit = closest_point(wall.mesh, f, c);
            if (hit.distance2 < ball.r * ball.r) hits.push_back(hit);
        }
        if (wall.is_exact())
            exact_hits(wall.exact, c, ball.r, hits);
        else
            keep_contacts(wall.mesh, c, ball.r, hits);
        for (const Hit& hit : hits) {
            const double distance = std::sqrt(hit.distance2);
            overlaps.push_back({a, wall.patch_of(hit), normal_of(wall, hit, c, distance), ball.r - distance});
        }
    }
}

}  // namespace pelletlab::solver::detail
