#include "apps/shape_body.hpp"

#include <fmt/format.h>

#include "apps/terminal.hpp"
#include "core/error.hpp"
#include "io/files.hpp"
#include "meshes/check.hpp"
#include "meshes/named_body.hpp"
#include "meshes/pellet_makers.hpp"
#include "meshes/read_mesh.hpp"

namespace pelletlab::apps {

namespace fs = std::filesystem;

namespace {

constexpr const char* made_unit = "mm";  // of mesh files made here

void say(const meshes::MeshReport& report, const std::string& name) {
    const Vec3 extent = 1e3 * report.extent;
    print_line(fmt::format("Body {}: {} triangles, {:.4g} x {:.4g} x {:.4g} mm, {:.5g} mm³, closed", name, report.faces, extent.x(), extent.y(), extent.z(),
                           1e9 * report.volume));
    for (const std::string& repair : report.repairs) print_line("  repaired: " + repair);
}

meshes::CheckedMesh checked(const BodyRequest& request, const TriangleMesh& as_read) {
    if (!request.repair) {
        try {
            return meshes::require_closed_body(as_read);
        } catch (const Error& error) {  // another way out than the one of the library
            throw Error(error.kind(), error.problem(), error.remedy() + (error.remedy().empty() ? "" : "; ") + "or let it be mended: --repair automatic",
                        error.place());
        }
    }
    meshes::RepairSettings settings;
    settings.method = *request.repair;
    return meshes::repair_to_closed_body(as_read, settings);
}

}  // namespace

std::string describe(const BodyRequest& request) {
    return fmt::format("body {} unit {} repair {} stretch {:.17g} {:.17g} {:.17g}", request.parametric, request.unit,
                       request.repair ? static_cast<int>(*request.repair) : -1, request.stretch.x(), request.stretch.y(), request.stretch.z());
}

std::string hash_of(const BodyRequest& request) {
    return request.parametric.empty() ? io::sha256_of_file(request.mesh_file) : io::sha256_of_text(request.parametric);
}

BodyOnDisk::BodyOnDisk(const BodyRequest& request, const fs::path& stem, bool quiet) {
    TriangleMesh made;
    if (request.parametric.empty()) {
        const TriangleMesh as_read = meshes::read_mesh(request.mesh_file, request.unit);
        meshes::CheckedMesh found = checked(request, as_read);
        if (!quiet) say(found.report, request.mesh_file.filename().string());
        file_ = request.mesh_file;
        unit_ = request.unit;
        mesh_ = std::move(found.mesh);
        const bool as_it_is = request.stretch == Vec3::Ones();
        if (as_it_is && (!request.repair || found.report.repairs.empty())) return;
        made = std::move(mesh_);
        file_ = stem.string() + (as_it_is ? ".repaired.stl" : ".stl");
    } else {
        made = meshes::require_closed_body(meshes::make_named_body(request.parametric)).mesh;
        file_ = stem.string() + ".stl";
    }
    if (request.stretch != Vec3::Ones()) made = meshes::stretched(std::move(made), request.stretch);
    // Whoever reads the clump later finds the body in this file, rounded to 32 bits: so the clump is made of what the file says.
    for (fs::path folder = fs::absolute(file_).parent_path(); !fs::exists(folder); folder = folder.parent_path()) made_folders_.push_back(folder);
    io::prepare_output_folder(file_.has_parent_path() ? file_.parent_path() : fs::path("."));
    unit_ = made_unit;
    const std::string bytes = meshes::stl_bytes(made, unit_);
    made_here_ = true;
    if (!fs::exists(file_) || io::sha256_of_file(file_) != io::sha256_of_text(bytes)) {
        if (fs::exists(file_) && !fs::exists(stem.string() + ".clump.toml"))
            throw bad_input("the mesh of the body would replace '" + file_.string() + "', which this program did not make here", "choose another name with -o");
        remove_ = !fs::exists(file_);
        io::write_text(file_, bytes);
    }
    try {
        const meshes::CheckedMesh again = meshes::require_closed_body(meshes::read_mesh(file_, unit_));
        if (!request.parametric.empty() && !quiet) say(again.report, request.parametric);
        mesh_ = again.mesh;
    } catch (...) {
        remove_traces();
        throw;
    }
}

BodyOnDisk::~BodyOnDisk() {
    remove_traces();
}

void BodyOnDisk::remove_traces() const {
    if (!remove_) return;
    std::error_code ignored;
    fs::remove(file_, ignored);
    for (const fs::path& folder : made_folders_) fs::remove(folder, ignored);  // succeeds for an empty folder only
}

}  // namespace pelletlab::apps
