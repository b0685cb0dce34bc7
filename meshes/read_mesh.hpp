// Triangle meshes from files: STL (ASCII and binary), OBJ, PLY through assimp.
#pragma once

#include <filesystem>
#include <string>

#include "core/triangle_mesh.hpp"

namespace pelletlab::meshes {

/// Reads all triangles of the file, welds vertices with equal coordinates, and multiplies coordinates by the unit («mm», «m», …):
/// an STL holds no unit, so an empty `unit` is an Error(bad_input) that asks for it. Drops no triangle silently.
/// Throws Error(bad_input) for a missing or unreadable file, a file that is not a mesh, no triangles, or coordinates that are not finite.
TriangleMesh read_mesh(const std::filesystem::path& file, const std::string& unit);

/// Writes binary STL with coordinates divided by the unit.
void write_stl(const TriangleMesh& mesh, const std::filesystem::path& file, const std::string& unit);

}  // namespace pelletlab::meshes
