// Tracked particles as a table: time, id, x, y, z and what else was seen, from a camera, positron or radioactive particle tracking, or another DEM code.
// What comes out is a FrameSource like a run of our own, so that one operator measures both.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/trajectory.hpp"

namespace pelletlab::io {

/// What the file itself does not say.
struct TrackedSettings {
    std::string length_unit, time_unit, velocity_unit;  ///< for columns whose header states no unit; empty: such a column is an error
    double frame_rate = 0.0;                            ///< [1/s], turns a column «frame» into time
    std::optional<PelletShape> pellet;                  ///< the tracked pellet; not needed where the file has a column of radii or diameters (spheres)
    Quat body_in_file = Quat::Identity();               ///< body frame → the frame whose orientation the file gives (the mesh as read)
    Mat3 axes = Mat3::Identity();                       ///< rotation: x_world = axes · (x_file − origin)
    Vec3 origin = Vec3::Zero();                         ///< [m], in the file's frame
    double largest_gap = 0.0;                           ///< [s], velocities are not taken across longer gaps; 0: 2.5 times the usual step of a track
};

/// What was read, for a person to look at.
struct TrackedSummary {
    std::size_t rows = 0, tracks = 0, times = 0;
    std::size_t rows_without_place = 0;
    std::size_t lost = 0;              ///< observations that tracks lack between their first and last time: a gap of n usual steps lacks n − 1
    std::size_t without_velocity = 0;  ///< observations with no neighbour within largest_gap: such a pellet has a place but no velocity
    bool velocities_from_file = false, spins_from_file = false, orientations_from_file = false;
    char flat = ' ';                           ///< the coordinate of the file ('x', 'y' or 'z') that has no column and counts as 0; ' ' when all are there
    std::vector<std::string> ignored_columns;  ///< names that mean nothing here
};

struct TrackedParticles {
    std::unique_ptr<FrameSource> frames;
    TrackedSummary summary;
};

/// Columns in any order (comma, semicolon, tab or blanks between them), names in any case: time or frame; id (may lack when every time has one row: a single
/// tracer); x, y, z (one may lack: a camera sees a plane); optional vx, vy, vz; wx, wy, wz (spin); qw, qx, qy, qz (orientation) or axis_x, axis_y, axis_z (the
/// pellet's axis of symmetry); radius or diameter. Units stand in the header, «x [mm]», «x (mm)», «x_mm», or in the settings. Other spellings
/// (pos_x, velocity_x, omega_x, …) are in docs/file-formats.md.
///
/// A pellet that was not seen at a time has a NaN position there, one without a known velocity a NaN velocity. Velocities that the file does not give
/// are those of the parabola through a track's neighbours in time, at its ends (and beside gaps) of the line; spins likewise from quaternions, else zero.
/// Throws Error(bad_input) with file, line and column: unknown or missing units, a column twice, no number, two rows of one pellet at one time.
TrackedParticles read_tracked_particles(const std::filesystem::path& file, const TrackedSettings& settings);
TrackedParticles parse_tracked_particles(std::string text, const std::string& file_name, const TrackedSettings& settings);

/// A sphere as a pellet; no mass is known.
PelletShape sphere_shape(double diameter);

}  // namespace pelletlab::io
