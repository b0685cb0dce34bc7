// The steps that require_closed_body and repair_to_closed_body share.
#pragma once

#include <string>
#include <vector>

#include "meshes/check.hpp"

namespace pelletlab::meshes::detail {

/// Repairs that have one right answer whatever the surface: welds, drops duplicates, makes neighbours agree, removes triangles without area. Adds a line a
/// repair to `repairs`. Throws Error(bad_input) when nothing is left.
TriangleMesh tidied(const TriangleMesh& mesh, std::vector<std::string>& repairs);

/// Throws Error(bad_input) for a body larger than 1 m or smaller than 1 µm.
void require_size(const MeshReport& report);

/// Throws Error(bad_input) for a body without thickness, or a closed one without volume.
void require_thickness(const MeshReport& report, const TriangleMesh& mesh);

/// Turns outer shells outward and cavities inward, and says so; the shells must be closed, consistent and free of crossings.
void orient_shells(TriangleMesh& mesh, std::vector<std::string>& repairs);

/// Error(bad_input) in words for a defect, its count and place.
[[noreturn]] void refuse(const MeshDefect& defect);

/// «(1.5, 0, -0.2) mm», «2 m», «1 vertex».
std::string in_mm(const Vec3& p);
std::string length_text(double metres);
std::string count_text(std::size_t count, const char* singular, const char* plural);

}  // namespace pelletlab::meshes::detail
