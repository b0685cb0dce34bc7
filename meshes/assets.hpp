// The reference meshes that PelletLab ships, and their making: every file can be made again, byte for byte.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/triangle_mesh.hpp"

namespace pelletlab::meshes {

struct Asset {
    std::string file;           ///< «cylinder_3.12x2.96.stl»
    std::string unit;           ///< of the coordinates in the file
    std::string origin;         ///< the call that makes it
    std::string licence;        ///< SPDX name
    std::string exact_formula;  ///< of the true body's volume
    double exact_volume = 0.0;  ///< [m³]
    TriangleMesh mesh;          ///< [m]
};

/// All shipped meshes, made afresh.
std::vector<Asset> make_assets();

/// MANIFEST.toml of them: per file unit, origin, licence, SHA-256, faces, exact volume and the mesh's own.
std::string asset_manifest(const std::vector<Asset>& assets);

/// Writes all mesh files and MANIFEST.toml into the folder, which must exist. Throws Error(bad_input) when that fails.
void write_assets(const std::filesystem::path& folder);

}  // namespace pelletlab::meshes
