#include "solver/detail/wall_search.hpp"

#include <algorithm>
#include <cmath>

namespace pelletlab::solver::detail {

void watch_anew(const Wall& wall, WallWatch& watch, const RelativePose& pose, double bounding_radius, double skin, std::vector<std::uint32_t>& faces) {
    const Vec3 centre = vec(pose.p);
    for (int k = 0; k < 3; ++k) watch.place[k] = pose.p[k];
    if (wall.is_exact()) {
        const double gap = distance_to(wall.exact, centre) - bounding_radius;
        watch.allowance = 0.999999 * (gap > skin ? gap : skin);
        if (gap > skin) {
            watch.near.reset();
        } else {
            if (!watch.near) watch.near = std::make_unique<NearWall>();
            watch.near->allowance = -1.0;
        }
        return;
    }
    wall.query.faces_near(wall.mesh, centre, bounding_radius + 4.0 * skin, faces);
    double nearest = bounding_radius + 4.0 * skin;
    const auto too_far = [&](std::uint32_t f) {
        const double distance = std::sqrt(closest_point(wall.mesh, f, centre).distance2);
        nearest = std::min(nearest, distance);
        return distance > bounding_radius + skin;
    };
    faces.erase(std::remove_if(faces.begin(), faces.end(), too_far), faces.end());
    watch.allowance = 0.999999 * (faces.empty() ? nearest - bounding_radius : skin);
    if (faces.empty()) {
        watch.near.reset();
        return;
    }
    if (!watch.near) watch.near = std::make_unique<NearWall>();
    watch.near->faces = faces;
    watch.near->allowance = -1.0;
}

double way_left(const WallWatch& watch, const Matrix3& frame, const Kinematic& wall, const Kinematic& body) {
    const double d[3] = {body.place[0] - wall.place[0], body.place[1] - wall.place[1], body.place[2] - wall.place[2]};
    double moved = 0.0;
    for (int k = 0; k < 3; ++k) {
        const double shift = frame.m[0][k] * d[0] + frame.m[1][k] * d[1] + frame.m[2][k] * d[2] - watch.place[k];
        moved += shift * shift;
    }
    return watch.allowance - std::sqrt(moved);
}

void find_candidates(const Wall& wall, NearWall& near, const RelativePose& pose, const BodyTemplate& t, double usual_skin, std::uint32_t step) {
    const std::uint32_t lasted = step - near.refreshed;
    if (near.skin > 0.0) {
        if (lasted < 12) near.skin = std::min(2.0 * near.skin, 4.0 * usual_skin);
        if (lasted > 100) near.skin = std::max(0.5 * near.skin, 0.05 * usual_skin);
    } else {
        near.skin = usual_skin;
    }
    near.refreshed = step;
    const Mat3 r = rotation_of(pose);
    const Vec3 p = vec(pose.p);
    near.candidates.clear();
    double nearest_other = std::max({8.0 * near.skin, usual_skin, 1.6 * wall.law.reach});
    for (std::size_t a = 0; a < t.balls.size(); ++a) {
        const auto& ball = t.balls[a];
        const Vec3 c = r * Vec3(ball.x, ball.y, ball.z) + p;
        if (wall.is_exact()) {
            const double gap = distance_to(wall.exact, c) - ball.r;
            if (gap < std::max(near.skin, 1.01 * wall.law.reach)) {
                near.candidates.push_back({static_cast<std::uint32_t>(a), 0});
            } else {
                nearest_other = std::min(nearest_other, gap);
            }
            continue;
        }
        for (const std::uint32_t f : near.faces) {
            // The plane of the face bounds the distance from below, cheaply.
            const double height = std::abs(wall.mesh.normals[f].dot(c - wall.mesh.corner(f, 0)));
            if (height - ball.r >= nearest_other) continue;
            const double gap = std::sqrt(closest_point(wall.mesh, f, c).distance2) - ball.r;
            if (gap < std::max(near.skin, 1.01 * wall.law.reach)) {
                near.candidates.push_back({static_cast<std::uint32_t>(a), f});
            } else {
                nearest_other = std::min(nearest_other, gap);
            }
        }
    }
    near.reference = pose;
    near.allowance = nearest_other * 0.999999;
}

bool is_stale(const NearWall& near, const RelativePose& pose, double rho) {
    double shift = 0.0, turn = 0.0;
    for (int k = 0; k < 3; ++k) shift += (pose.p[k] - near.reference.p[k]) * (pose.p[k] - near.reference.p[k]);
    for (int k = 0; k < 4; ++k) turn += (pose.q[k] - near.reference.q[k]) * (pose.q[k] - near.reference.q[k]);
    return !(std::sqrt(shift) + 2.0 * rho * std::sqrt(turn) <= near.allowance);
}

}  // namespace pelletlab::solver::detail
