// Stage 1 of the chain: mesh file → clump template file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/clump_template.hpp"
#include "core/triangle_mesh.hpp"

namespace pelletlab::apps {

struct ShapeRequest {
    std::filesystem::path mesh_file;
    std::string unit;  ///< of the mesh: «mm»
    std::uint32_t sphere_count = 24;
    double density = 1800.0;  ///< [kg/m³]
    double min_radius = 0.0;  ///< [m]
    MassSource mass_source = MassSource::target_mesh;
    std::uint64_t seed = 1;
    std::filesystem::path output = "pellet.clump.toml";
    bool picture = true;  ///< <output without .clump.toml>.png beside it
    int study_shape = 0;  ///< 1 … 4: print the figures of the study's hand-made shape beside
    bool force = false;   ///< make it again although nothing has changed
};

/// Reads and checks the mesh, fits, measures, writes the template and its picture, and prints what a person wants to know.
void run_shape(const ShapeRequest& request);

/// The pellet's true surface in the body frame of its clump, from the mesh file that the clump names (relative to the clump file).
/// Throws Error(bad_input) when that file is gone or no longer the one that the clump was made from.
TriangleMesh true_surface(const ClumpTemplate& clump, const std::filesystem::path& clump_file);

}  // namespace pelletlab::apps
