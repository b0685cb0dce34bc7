// What a run leaves behind: poses and velocities of the pellets and of the walls at stored times. Measurement operators see nothing else.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/provenance.hpp"
#include "core/rigid_template.hpp"
#include "core/triangle_mesh.hpp"

namespace pelletlab {

/// A pellet kind: what the solver moved, and the true surface that a camera would see.
struct PelletShape {
    RigidTemplate rigid;
    TriangleMesh surface_body;  ///< true surface in the body frame; empty when only spheres are known
};

struct WallShape {
    std::string name;
    TriangleMesh mesh;  ///< in the wall's own frame
};

struct TrajectoryHeader {
    std::string case_name;
    std::vector<PelletShape> shapes;
    std::vector<std::uint32_t> shape_of_body;  ///< (bodies) index into shapes
    std::vector<WallShape> walls;
    Vec3 gravity = {0.0, 0.0, -9.81};  ///< [m/s²]
    std::string resolved_case;         ///< TOML text of the case
    Provenance provenance;
};

/// One stored instant; all vectors have one entry a body, wall_poses one a wall. A body that was not seen at this instant (a lost track of a camera, or a
/// pellet that a run has not released yet) has a NaN position, one whose velocity is not known a NaN velocity.
struct Frame {
    double time = 0.0;               ///< [s]
    std::vector<Vec3> positions;     ///< [m], centres of mass, world
    std::vector<Quat> orientations;  ///< body → world
    std::vector<Vec3> velocities;    ///< [m/s], world
    std::vector<Vec3> spins;         ///< [rad/s], world
    std::vector<Pose> wall_poses;    ///< wall frame → world

    bool is_seen(std::size_t body) const { return positions[body].allFinite(); }
    bool is_tracked(std::size_t body) const { return is_seen(body) && velocities[body].allFinite(); }
};

/// Frames one after the other, from memory or from a file: operators stream through it and hold one frame at a time.
class FrameSource {
public:
    virtual ~FrameSource() = default;
    virtual const TrajectoryHeader& header() const = 0;
    virtual std::size_t frame_count() const = 0;
    virtual Frame frame(std::size_t index) const = 0;
    virtual double time(std::size_t index) const { return frame(index).time; }
};

/// A trajectory that fits into memory.
class Trajectory final : public FrameSource {
public:
    TrajectoryHeader head;
    std::vector<Frame> frames;

    const TrajectoryHeader& header() const override { return head; }
    std::size_t frame_count() const override { return frames.size(); }
    Frame frame(std::size_t index) const override { return frames.at(index); }
    double time(std::size_t index) const override { return frames.at(index).time; }
};

}  // namespace pelletlab
