// Binary STL of the union's surface: closed, outward normals, single precision as the format has it. An STL holds no unit; it is written into the 80 bytes of
// the header for people. To read an STL use meshes/read_mesh.hpp: a surface is not a list of spheres.
#include <algorithm>
#include <cstdint>
#include <cstring>

#include "shapegen/formats/detail/entries.hpp"
#include "shapegen/formats/detail/print.hpp"
#include "shapegen/formats/union_surface.hpp"

namespace pelletlab::shapegen::formats::detail {

namespace {

void append(std::string& bytes, std::uint32_t value) {
    for (int k = 0; k < 4; ++k) bytes += static_cast<char>((value >> (8 * k)) & 0xFFU);
}

void append(std::string& bytes, const Vec3& v) {
    for (int k = 0; k < 3; ++k) {
        const float single = static_cast<float>(v[k]);
        std::uint32_t bits = 0;
        std::memcpy(&bits, &single, sizeof bits);
        append(bytes, bits);
    }
}

std::vector<FormatFile> write(const ClumpTemplate& clump, const WriteOptions& options) {
    require_complete(clump);
    const Units units = units_for({options.length_unit, "kg"}, "mm", "kg");
    const UnionSurface surface = union_surface(clump.rigid.spheres, options.surface_voxel);
    std::string bytes = "PelletLab union of spheres, unit " + units.length + ", " + safe_name(clump);
    bytes.resize(80, ' ');
    const TriangleMesh& mesh = surface.mesh;
    append(bytes, static_cast<std::uint32_t>(mesh.faces.size()));
    bytes.reserve(84 + 50 * mesh.faces.size());
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const Vec3 normal = (mesh.corner(f, 1) - mesh.corner(f, 0)).cross(mesh.corner(f, 2) - mesh.corner(f, 0));
        const double length = normal.norm();
        append(bytes, length > 0.0 ? Vec3(normal / length) : Vec3(Vec3::Zero()));
        for (int k = 0; k < 3; ++k) append(bytes, Vec3(mesh.corner(f, k) / units.metre));
        bytes.append(2, '\0');
    }
    return {{safe_name(clump) + ".union.stl", bytes}};
}

}  // namespace

Format stl() {
    return {.id = "stl",
            .program = "STL surface of the union",
            .extension = ".union.stl",
            .description = "binary STL, closed surface of the union of spheres; accuracy in docs/clump-formats.md",
            .documented_in = "3D Systems, Stereolithography Interface Specification (1989): 80-byte header, count, 50 bytes a triangle",
            .length_unit = "mm",
            .mass_unit = "",
            .holds_mass_properties = false,
            .precision = 0.0,
            .write = write,
            .read = nullptr};
}

}  // namespace pelletlab::shapegen::formats::detail
