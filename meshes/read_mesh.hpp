// Triangle meshes from files: STL (ASCII and binary), OBJ, PLY through assimp.
#pragma once

#include <filesystem>
#include <string>

#include "core/triangle_mesh.hpp"

namespace pelletlab::meshes {

/// Reads all triangles of the file, welds vertices with equal coordinates, and multiplies coordinates by the unit («mm», «m», …):
/// an STL holds no unit, so an empty `unit` is an Error(bad_input) that asks for it. Drops no triangle silently. Polygons are cut into triangles; lines and
/// points are ignored. Coordinates carry 32-bit precision (binary STL stores no more, and the reading library keeps no more).
/// Throws Error(bad_input) for a missing or unreadable file, a file that is not a mesh, no triangles, or coordinates that are not finite.
TriangleMesh read_mesh(const std::filesystem::path& file, const std::string& unit);

/// Writes binary STL with coordinates divided by the unit. The file appears under its name only when it is complete.
/// Throws Error(bad_input) when it cannot be written, for an unknown unit, or for a coordinate that does not fit into 32 bits.
void write_stl(const TriangleMesh& mesh, const std::filesystem::path& file, const std::string& unit);

/// The bytes that write_stl writes: 80 of header («PelletLab binary STL, unit mm»), a count, 50 a triangle; little-endian.
std::string stl_bytes(const TriangleMesh& mesh, const std::string& unit);

}  // namespace pelletlab::meshes
