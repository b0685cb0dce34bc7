#include "meshes/assets.hpp"

#include <openssl/evp.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <numbers>
#include <sstream>

#include "core/error.hpp"
#include "core/units.hpp"
#include "meshes/makers.hpp"
#include "meshes/mass_properties.hpp"
#include "meshes/read_mesh.hpp"

namespace pelletlab::meshes {
namespace {

std::string sha256(const std::string& bytes) {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned length = 0;
    if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &length, EVP_sha256(), nullptr) != 1)
        throw numerical_failure("the SHA-256 of a mesh could not be computed", "check the installation of OpenSSL");
    std::string text;
    for (unsigned k = 0; k < length; ++k) {
        std::array<char, 3> hex{};
        std::snprintf(hex.data(), hex.size(), "%02x", static_cast<unsigned>(digest[k]));
        text += hex.data();
    }
    return text;
}

/// Ten digits: what the last bits are depends on the mathematics library, and the manifest should not.
std::string cubic_millimetres(double cubic_metres) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.10g mm^3", cubic_metres * 1e9);
    return text.data();
}

}  // namespace

std::vector<Asset> make_assets() {
    const double diameter = 3.12e-3, height = 2.96e-3;
    Asset pellet;
    pellet.file = "cylinder_3.12x2.96.stl";
    pellet.unit = "mm";
    pellet.origin = "make_cylinder(3.12 mm, 2.96 mm, 256 facets, volume_exact = true)";
    pellet.licence = "CC0-1.0";
    pellet.exact_formula = "pi/4 D^2 H";
    pellet.exact_volume = 0.25 * std::numbers::pi * diameter * diameter * height;
    pellet.mesh = make_cylinder(diameter, height, 256, true);
    return {pellet};
}

std::string asset_manifest(const std::vector<Asset>& assets) {
    std::ostringstream text;
    text << "# Meshes made by pelletlab::meshes::write_assets(); do not edit by hand, a test makes them again and compares bytes.\n";
    for (const Asset& asset : assets) {
        const double factor = unit_factor(asset.unit, dimension::length);
        TriangleMesh stored = asset.mesh;  // with the coordinates that the file can hold
        for (Vec3& vertex : stored.vertices) vertex = (vertex / factor).cast<float>().cast<double>() * factor;
        text << "\n[[mesh]]\n"
             << "file = \"" << asset.file << "\"\n"
             << "unit = \"" << asset.unit << "\"\n"
             << "origin = \"" << asset.origin << "\"\n"
             << "licence = \"" << asset.licence << "\"\n"
             << "sha256 = \"" << sha256(stl_bytes(asset.mesh, asset.unit)) << "\"\n"
             << "faces = " << asset.mesh.faces.size() << '\n'
             << "vertices = " << asset.mesh.vertices.size() << '\n'
             << "exact_volume = \"" << cubic_millimetres(asset.exact_volume) << "\"  # " << asset.exact_formula << '\n'
             << "mesh_volume = \"" << cubic_millimetres(volume_moments(stored).volume) << "\"\n";
    }
    return text.str();
}

void write_assets(const std::filesystem::path& folder) {
    const std::vector<Asset> assets = make_assets();
    for (const Asset& asset : assets) write_stl(asset.mesh, folder / asset.file, asset.unit);
    const std::filesystem::path manifest = folder / "MANIFEST.toml";
    std::ofstream stream(manifest, std::ios::binary | std::ios::trunc);
    stream << asset_manifest(assets);
    stream.close();
    if (!stream) throw bad_input("the manifest of the meshes cannot be written", "check that the folder exists and may be written to", {manifest.string()});
}

}  // namespace pelletlab::meshes
