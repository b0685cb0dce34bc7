// Any bytes as a mesh file: the first byte chooses the kind (STL, OBJ, PLY), the rest is the file. The reader throws an Error(bad_input) with a problem, or
// gives finite triangles with indices in range; the check never fails on them; what require_closed_body accepts is closed and has finite mass properties.
// PELLETLAB_FUZZ_READER_ALONE: without the check, many times faster.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "core/error.hpp"
#include "meshes/check.hpp"
#include "meshes/mass_properties.hpp"
#include "meshes/read_mesh.hpp"

using namespace pelletlab;

namespace {

void require(bool condition) {
    if (!condition) std::abort();
}

struct Scratch {
    std::filesystem::path folder;
    Scratch() {
        std::string name = (std::filesystem::temp_directory_path() / "fuzz-mesh-XXXXXX").string();
        require(mkdtemp(name.data()) != nullptr);
        folder = name;
    }
    ~Scratch() {
        std::error_code ignored;
        std::filesystem::remove_all(folder, ignored);
    }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    static const Scratch scratch;
    static const char* const kinds[] = {"mesh.stl", "mesh.obj", "mesh.ply"};
    if (size == 0) return 0;
    const std::filesystem::path file = scratch.folder / kinds[bytes[0] % 3];
    std::ofstream(file, std::ios::binary).write(reinterpret_cast<const char*>(bytes + 1), static_cast<std::streamsize>(size - 1));
    TriangleMesh mesh;
    try {
        mesh = meshes::read_mesh(file, "mm");
    } catch (const Error& error) {
        require(error.kind() == ErrorKind::bad_input && !error.problem().empty() && error.place().line >= 0);
        return 0;
    }
    require(!mesh.faces.empty());
    for (const Vec3& vertex : mesh.vertices) require(vertex.allFinite());
    for (const Triangle& face : mesh.faces)
        for (const std::uint32_t corner : face) require(corner < mesh.vertices.size());
#ifndef PELLETLAB_FUZZ_READER_ALONE
    const meshes::MeshReport report = meshes::check(mesh);
    require(report.faces == mesh.faces.size());
    try {
        const meshes::CheckedMesh checked = meshes::require_closed_body(mesh);
        require(checked.report.is_closed_body());
        const MassProperties mass = meshes::mass_properties(checked.mesh, 1000.0);
        require(std::isfinite(mass.mass) && mass.mass > 0.0 && mass.principal_inertia.allFinite());
    } catch (const Error& error) {
        require(error.kind() == ErrorKind::bad_input && !error.problem().empty());
    }
#endif
    return 0;
}
