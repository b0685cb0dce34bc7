#include "solver/detail/wall_contacts.hpp"

#include <algorithm>
#include <cmath>

#include "solver/detail/aligned_scratch.hpp"
#include "solver/detail/motion.hpp"

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
    std::vector<Active> active;
    std::vector<WallHistory> fresh;  ///< of each contact
    std::vector<Hit> hits;
    std::vector<std::uint32_t> faces;
    std::vector<std::uint8_t> used;
};

Mat3 rotation_of(const RelativePose& pose) {
    const Matrix3 m = matrix_of(pose.q[0], pose.q[1], pose.q[2], pose.q[3]);
    Mat3 r;
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) r(i, k) = m.m[i][k];
    return r;
}

Vec3 vec(const double a[3]) {
    return {a[0], a[1], a[2]};
}

/// Looks up the faces near the bounding sphere.
void watch_anew(const Wall& wall, WallWatch& watch, const RelativePose& pose, double bounding_radius, double skin, std::vector<std::uint32_t>& faces) {
    wall.query.faces_near(wall.mesh, vec(pose.p), bounding_radius + skin, faces);
    for (int k = 0; k < 3; ++k) watch.place[k] = pose.p[k];
    watch.allowance = skin * 0.999999;
    if (faces.empty()) {
        watch.near.reset();
        return;
    }
    if (!watch.near) watch.near = std::make_unique<NearWall>();
    watch.near->faces = faces;
    watch.near->allowance = -1.0;
}

/// Finds the sphere–face candidates anew.
void refresh(const Wall& wall, NearWall& near, const RelativePose& pose, const BodyTemplate& t, const WallSkins& skins) {
    const Mat3 r = rotation_of(pose);
    const Vec3 p = vec(pose.p);
    near.candidates.clear();
    double nearest_other = 8.0 * skins.candidates;
    for (std::size_t a = 0; a < t.balls.size(); ++a) {
        const auto& ball = t.balls[a];
        const Vec3 c = r * Vec3(ball.x, ball.y, ball.z) + p;
        for (const std::uint32_t f : near.faces) {
            // The plane of the face bounds the distance from below, cheaply.
            const double height = std::abs(wall.mesh.normals[f].dot(c - wall.mesh.corner(f, 0)));
            if (height - ball.r >= nearest_other) continue;
            const double gap = std::sqrt(closest_point(wall.mesh, f, c).distance2) - ball.r;
            if (gap < skins.candidates) {
                near.candidates.push_back({static_cast<std::uint32_t>(a), f});
            } else {
                nearest_other = std::min(nearest_other, gap);
            }
        }
    }
    near.reference = pose;
    near.allowance = nearest_other * 0.999999;
}

bool stale(const NearWall& near, const RelativePose& pose, double rho) {
    double shift = 0.0, turn = 0.0;
    for (int k = 0; k < 3; ++k) shift += (pose.p[k] - near.reference.p[k]) * (pose.p[k] - near.reference.p[k]);
    for (int k = 0; k < 4; ++k) turn += (pose.q[k] - near.reference.q[k]) * (pose.q[k] - near.reference.q[k]);
    return !(std::sqrt(shift) + 2.0 * rho * std::sqrt(turn) <= near.allowance);
}

/// a turned by the smallest rotation that takes unit vector `from` to unit vector `to`.
Vec3 turned(const Vec3& a, const Vec3& from, const Vec3& to) {
    const Vec3 axis = from.cross(to);
    const double c = from.dot(to);
    if (c < -0.999) return a - to * a.dot(to);
    return a * c + axis.cross(a) + axis * (axis.dot(a) / (1.0 + c));
}

/// The spring that contact (sphere, patch, normal) inherits: from the same patch first, then from any contact of the sphere that pointed the same
/// way (the hand-over at an edge); each old contact serves once.
Vec3 inherited_spring(const std::vector<WallHistory>& history, std::vector<std::uint8_t>& used, std::uint32_t sphere, std::uint32_t patch, const Vec3& normal) {
    constexpr double same_way = 0.70710678;  // within 45°
    for (const bool same_patch : {true, false}) {
        double best = same_way;
        std::size_t choice = history.size();
        for (std::size_t h = 0; h < history.size(); ++h) {
            if (history[h].sphere != sphere || used[h] || (same_patch && history[h].patch != patch)) continue;
            const double alike = history[h].normal.dot(normal);
            if (alike > best) best = alike, choice = h;
        }
        if (choice < history.size()) {
            used[choice] = 1;
            return turned(history[choice].spring, history[choice].normal, normal);
        }
    }
    return Vec3::Zero();
}

/// Puts the contacts of one body into the batch. True when there are any.
bool collect(const Wall& wall, const NearWall& near, const RelativePose& pose, const BodyTemplate& t, Scratch& s) {
    const Mat3 r = rotation_of(pose);
    const Vec3 p = vec(pose.p);
    const std::size_t before = s.storage.batch.size;
    s.used.assign(near.history.size(), 0);
    for (std::size_t k = 0; k < near.candidates.size();) {
        const std::uint32_t sphere = near.candidates[k].sphere;
        const auto& ball = t.balls[sphere];
        const Vec3 c = r * Vec3(ball.x, ball.y, ball.z) + p;
        s.hits.clear();
        for (; k < near.candidates.size() && near.candidates[k].sphere == sphere; ++k) {
            const Hit hit = closest_point(wall.mesh, near.candidates[k].face, c);
            if (hit.distance2 < ball.r * ball.r) s.hits.push_back(hit);
        }
        if (s.hits.empty()) continue;
        keep_contacts(wall.mesh, c, s.hits);
        for (const Hit& hit : s.hits) {
            const double distance = std::sqrt(hit.distance2);
            const Vec3 normal = distance > 0.0 ? Vec3((c - hit.point) / distance) : wall.mesh.normals[hit.face];
            const std::uint32_t patch = wall.mesh.patch[hit.face];
            const Vec3 spring = inherited_spring(near.history, s.used, sphere, patch, normal);
            const std::size_t n = s.storage.add();
            ContactBatch& b = s.storage.batch;
            b.nx[n] = normal.x(), b.ny[n] = normal.y(), b.nz[n] = normal.z();
            b.overlap[n] = ball.r - distance;
            b.radius[n] = ball.r;
            b.x[n] = hit.point.x(), b.y[n] = hit.point.y(), b.z[n] = hit.point.z();
            b.sx[n] = spring.x(), b.sy[n] = spring.y(), b.sz[n] = spring.z();
            b.slot[n] = static_cast<std::uint32_t>(s.slots.size());
            s.fresh.push_back({sphere, patch, normal, spring});
        }
    }
    return s.storage.batch.size > before;
}

PairSlot slot_of(const Kinematic& wall, const Kinematic& body, const RelativePose& pose, std::size_t contacts) {
    const Mat3 to_wall = Quat(wall.q[0], wall.q[1], wall.q[2], wall.q[3]).toRotationMatrix().transpose();
    const Vec3 v = to_wall * (vec(body.v) - vec(wall.v)), spin = to_wall * (vec(body.w) - vec(wall.w)), body_spin = to_wall * vec(body.w);
    const Vec3 at_origin = v - body_spin.cross(vec(pose.p));
    PairSlot slot;
    for (int k = 0; k < 3; ++k) slot.velocity[k] = at_origin[k], slot.spin[k] = spin[k];
    slot.mass = 1.0 / body.inverse_mass;
    slot.inertia = rolling_share / (body.inverse_inertia * static_cast<double>(contacts));
    return slot;
}

}  // namespace

Wall::Wall(const WallDefinition& d, const LawRow& row)
    : name(d.name), mesh(make_wall_mesh(d.mesh, d.feature_angle, d.name)), query(mesh), law(row), motion(d.motion) {
    move_wall(*this, 0, 0.0);
}

void move_wall(Wall& wall, std::uint64_t step, double dt) {
    const double t = static_cast<double>(step - wall.motion_start) * dt;
    const Vec3 axis = wall.motion.axis;
    const Quat turn(Eigen::AngleAxisd(wall.motion.rotation_speed * t, axis));
    const Vec3 shift = wall.motion.velocity * t;
    wall.pose.orientation = (turn * wall.start_pose.orientation).normalized();
    wall.pose.position = wall.motion.point + turn * (wall.start_pose.position - wall.motion.point) + shift;
    const Vec3 spin = axis * wall.motion.rotation_speed;
    const Vec3 v = wall.motion.velocity + spin.cross(wall.pose.position - (wall.motion.point + shift));
    for (int k = 0; k < 3; ++k) {
        wall.record.p[k] = wall.pose.position[k];
        wall.record.v[k] = v[k];
        wall.record.w[k] = spin[k];
    }
    wall.record.q[0] = wall.pose.orientation.w(), wall.record.q[1] = wall.pose.orientation.x();
    wall.record.q[2] = wall.pose.orientation.y(), wall.record.q[3] = wall.pose.orientation.z();
    wall.record.inverse_mass = wall.record.inverse_inertia = wall.record.unused = 0.0;
}

RelativePose pose_in_wall(const Kinematic& wall, const Kinematic& body) {
    const Matrix3 frame = matrix_of(wall.q[0], wall.q[1], wall.q[2], wall.q[3]);
    const double d[3] = {body.p[0] - wall.p[0], body.p[1] - wall.p[1], body.p[2] - wall.p[2]};
    RelativePose pose;
    for (int k = 0; k < 3; ++k) pose.p[k] = frame.m[0][k] * d[0] + frame.m[1][k] * d[1] + frame.m[2][k] * d[2];
    const Quaternion turn = product({wall.q[0], -wall.q[1], -wall.q[2], -wall.q[3]}, {body.q[0], body.q[1], body.q[2], body.q[3]});
    pose.q[0] = turn.w, pose.q[1] = turn.x, pose.q[2] = turn.y, pose.q[3] = turn.z;
    return pose;
}

void wall_contact_forces(Wall& wall, std::size_t begin, std::size_t end, const std::vector<Kinematic>& kinematics, const Bodies& bodies,
                         const std::vector<BodyTemplate>& templates, const WallSkins& skins, const Kernels& kernels, const StepClock& clock) {
    thread_local Scratch s;  // grows once, holds nothing between calls
    s.storage.batch.size = 0;
    s.slots.clear();
    s.active.clear();
    s.fresh.clear();
    for (std::size_t i = begin; i < end; ++i) {
        wall.touching[i] = 0;
        WallWatch& watch = wall.watches[i];
        const BodyTemplate& t = templates[bodies.template_index[i]];
        const RelativePose pose = pose_in_wall(wall.record, kinematics[i]);
        double moved = 0.0;
        for (int k = 0; k < 3; ++k) moved += (pose.p[k] - watch.place[k]) * (pose.p[k] - watch.place[k]);
        if (!(watch.allowance >= 0.0 && moved <= watch.allowance * watch.allowance)) watch_anew(wall, watch, pose, t.bounding_radius, skins.faces, s.faces);
        if (!watch.near) continue;
        NearWall& near = *watch.near;
        if (stale(near, pose, t.largest_offset)) refresh(wall, near, pose, t, skins);
        const auto first = static_cast<std::uint32_t>(s.storage.batch.size);
        if (near.candidates.empty() || !collect(wall, near, pose, t, s)) {
            near.history.clear();
            continue;
        }
        const auto contact_end = static_cast<std::uint32_t>(s.storage.batch.size);
        s.slots.push_back(slot_of(wall.record, kinematics[i], pose, contact_end - first));
        s.active.push_back({static_cast<std::uint32_t>(i), first, contact_end, vec(pose.p)});
    }

    s.storage.pad();
    ContactBatch& batch = s.storage.batch;
    kernels.contact_forces(wall.law, batch, s.slots.data(), clock.spring_step, clock.step);

    const Mat3 to_world = Quat(wall.record.q[0], wall.record.q[1], wall.record.q[2], wall.record.q[3]).toRotationMatrix();
    for (const Active& active : s.active) {
        Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
        for (std::uint32_t c = active.first_contact; c < active.contact_end; ++c) {
            force += Vec3(batch.fx[c], batch.fy[c], batch.fz[c]);
            torque += Vec3(batch.mx[c], batch.my[c], batch.mz[c]);
        }
        if (clock.spring_step > 0.0) {
            std::vector<WallHistory>& history = wall.watches[active.body].near->history;
            history.assign(s.fresh.begin() + active.first_contact, s.fresh.begin() + active.contact_end);
            for (std::uint32_t c = active.first_contact; c < active.contact_end; ++c)
                history[c - active.first_contact].spring = {batch.sx[c], batch.sy[c], batch.sz[c]};
        }
        const Vec3 world_force = to_world * force, world_torque = to_world * (torque - active.place.cross(force)), on_wall = to_world * -torque;
        WallBodyLoad& load = wall.loads[active.body];
        for (int k = 0; k < 3; ++k) load.force[k] = world_force[k], load.torque[k] = world_torque[k], load.on_wall[k] = on_wall[k];
        wall.touching[active.body] = 1;
    }
}

void wall_overlaps(const Wall& wall, const Kinematic& body, const BodyTemplate& t, std::vector<WallOverlap>& overlaps) {
    std::vector<std::uint32_t> faces;
    std::vector<Hit> hits;
    const RelativePose pose = pose_in_wall(wall.record, body);
    wall.query.faces_near(wall.mesh, vec(pose.p), t.bounding_radius, faces);
    if (faces.empty()) return;
    const Mat3 r = rotation_of(pose);
    for (std::uint32_t a = 0; a < t.balls.size(); ++a) {
        const auto& ball = t.balls[a];
        const Vec3 c = r * Vec3(ball.x, ball.y, ball.z) + vec(pose.p);
        hits.clear();
        for (const std::uint32_t f : faces) {
            const Hit hit = closest_point(wall.mesh, f, c);
            if (hit.distance2 < ball.r * ball.r) hits.push_back(hit);
        }
        keep_contacts(wall.mesh, c, hits);
        for (const Hit& hit : hits) {
            const double distance = std::sqrt(hit.distance2);
            const Vec3 normal = distance > 0.0 ? Vec3((c - hit.point) / distance) : wall.mesh.normals[hit.face];
            overlaps.push_back({a, wall.mesh.patch[hit.face], normal, ball.r - distance});
        }
    }
}

}  // namespace pelletlab::solver::detail
