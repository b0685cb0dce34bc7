#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <system_error>

#include "core/error.hpp"
#include "core/units.hpp"
#include "meshes/read_mesh.hpp"

namespace pelletlab::meshes {
namespace {

void append(std::string& bytes, std::uint32_t word) {
    for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<char>((word >> shift) & 0xffU));
}

void append(std::string& bytes, const Eigen::Vector3f& v) {
    for (int k = 0; k < 3; ++k) append(bytes, std::bit_cast<std::uint32_t>(v[k] + 0.0F));
}

}  // namespace

std::string stl_bytes(const TriangleMesh& mesh, const std::string& unit) {
    const double factor = unit_factor(unit, dimension::length);
    if (mesh.faces.size() > 0xffffffffULL) throw bad_input("an STL file holds at most 4294967295 triangles", "reduce the mesh");
    std::string bytes = "PelletLab binary STL, unit " + unit;
    bytes.resize(80, '\0');
    bytes.reserve(84 + 50 * mesh.faces.size());
    append(bytes, static_cast<std::uint32_t>(mesh.faces.size()));
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        std::array<Eigen::Vector3f, 3> corners;
        for (int k = 0; k < 3; ++k) {
            corners[static_cast<std::size_t>(k)] = (mesh.corner(f, k) / factor).cast<float>();
            if (!corners[static_cast<std::size_t>(k)].allFinite())
                throw bad_input("triangle " + std::to_string(f) + " has a coordinate that a 32-bit STL cannot hold", "choose a larger unit than " + unit);
        }
        // The normal in the file is redundant: the corners as they were before rounding give the best one.
        const Vec3 normal = (mesh.corner(f, 1) - mesh.corner(f, 0)).cross(mesh.corner(f, 2) - mesh.corner(f, 0));
        const double length = normal.norm();
        append(bytes, length > 0.0 ? Eigen::Vector3f((normal / length).cast<float>()) : Eigen::Vector3f::Zero());
        for (const Eigen::Vector3f& corner : corners) append(bytes, corner);
        bytes.append(2, '\0');
    }
    return bytes;
}

void write_stl(const TriangleMesh& mesh, const std::filesystem::path& file, const std::string& unit) {
    const std::string bytes = stl_bytes(mesh, unit);
    std::filesystem::path partial = file;
    partial += ".part";
    {
        std::ofstream stream(partial, std::ios::binary | std::ios::trunc);
        stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        stream.close();
        if (!stream) {
            std::error_code ignored;
            std::filesystem::remove(partial, ignored);
            throw bad_input("the mesh file cannot be written", "check that the folder exists, may be written to and has space", {file.string()});
        }
    }
    std::error_code failure;
    std::filesystem::rename(partial, file, failure);
    if (failure) {
        std::error_code ignored;
        std::filesystem::remove(partial, ignored);
        throw bad_input("the mesh file cannot be written: " + failure.message(), "check that the name is not a folder", {file.string()});
    }
}

}  // namespace pelletlab::meshes
