// Which faces of a wall lie near a body, and which of its spheres may touch them soon: what wall_contacts.cpp keeps between steps, and until when.
#pragma once

#include <vector>

#include "solver/detail/motion.hpp"
#include "solver/detail/wall_contacts.hpp"

namespace pelletlab::solver::detail {

inline Vec3 vec(const double a[3]) {
    return {a[0], a[1], a[2]};
}

inline Quat quat(const double a[4]) {
    return {a[0], a[1], a[2], a[3]};
}

inline Mat3 rotation_of(const RelativePose& pose) {
    const Matrix3 m = matrix_of(pose.q[0], pose.q[1], pose.q[2], pose.q[3]);
    Mat3 r;
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) r(i, k) = m.m[i][k];
    return r;
}

/// Looks up the faces near the bounding sphere. Looks further than is needed now: a body far from the wall is then left alone for longer.
void watch_anew(const Wall& wall, WallWatch& watch, const RelativePose& pose, double bounding_radius, double skin, std::vector<std::uint32_t>& faces);

/// How much further [m] the body may move in the frame of the wall before the faces near it must be looked up again; negative when they must be now.
double way_left(const WallWatch& watch, const Matrix3& frame, const Kinematic& wall, const Kinematic& body);

/// Finds the sphere–face candidates anew.
void find_candidates(const Wall& wall, NearWall& near, const RelativePose& pose, const BodyTemplate& t, double usual_skin, std::uint32_t step);

/// True when the body has moved or turned so far that its candidates must be found anew; `rho` [m]: largest offset of its spheres.
bool is_stale(const NearWall& near, const RelativePose& pose, double rho);

}  // namespace pelletlab::solver::detail
