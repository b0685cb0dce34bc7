// pelletlab mesh check | make | assets
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "apps/body_options.hpp"
#include "apps/terminal.hpp"
#include "apps/verbs.hpp"
#include "io/files.hpp"
#include "meshes/assets.hpp"
#include "meshes/check.hpp"
#include "meshes/named_body.hpp"
#include "meshes/read_mesh.hpp"

namespace pelletlab::apps {

namespace {

struct MeshOptions {
    std::string file, unit, folder = "meshes/assets";
    std::string body, output, output_unit = "mm";
};

void make_body(const MeshOptions& options) {
    const meshes::CheckedMesh checked = meshes::require_closed_body(meshes::make_named_body(options.body));
    const std::filesystem::path file = options.output;
    io::prepare_output_folder(file.has_parent_path() ? file.parent_path() : std::filesystem::path("."));
    meshes::write_stl(checked.mesh, file, options.output_unit);
    print_line(checked.report.summary());
    print_written(file, "binary STL in " + options.output_unit);
}

void check_file(const MeshOptions& options) {
    const TriangleMesh mesh = meshes::read_mesh(options.file, options.unit);
    print_line(meshes::check(mesh).summary());
    const meshes::CheckedMesh checked = meshes::require_closed_body(mesh);
    for (const std::string& repair : checked.report.repairs) print_line("  repaired: " + repair);
    print_line("closed body: usable by `pelletlab shape`");
}

}  // namespace

void add_mesh_verb(CLI::App& app) {
    auto options = std::make_shared<MeshOptions>();
    CLI::App* mesh = app.add_subcommand("mesh", "Look at a mesh, or write the reference meshes");
    mesh->require_subcommand(1);
    mesh->fallthrough();

    CLI::App* check = mesh->add_subcommand("check", "Report size, volume and defects\n  example: pelletlab mesh check pellet.stl --unit mm");
    check->add_option("mesh", options->file, "STL, OBJ or PLY file")->required();
    check->add_option("--unit", options->unit, "Unit of its coordinates: mm, m, um, in, … (an STL holds none)");
    check->callback([options] { check_file(*options); });

    CLI::App* make = mesh->add_subcommand(
        "make", "Write the mesh of a parametric body\n  example: pelletlab mesh make trilobe:lobe_diameter=1mm,lobe_offset=0.5mm,height=3mm -o trilobe.stl");
    make->add_option("body", options->body, "Name and sizes: cylinder:diameter=3.12mm,height=2.96mm,rim_radius=0.2mm")->required();
    make->add_option("-o,--output", options->output, "STL file to write")->required();
    make->add_option("--unit", options->output_unit, "Unit of its coordinates")->capture_default_str();
    make->footer(list_of_bodies());
    make->callback([options] { make_body(*options); });

    CLI::App* assets = mesh->add_subcommand("assets", "Write the reference meshes and their MANIFEST\n  example: pelletlab mesh assets -o meshes/assets");
    assets->add_option("-o,--output", options->folder, "Folder")->capture_default_str();
    assets->callback([options] {
        io::prepare_output_folder(options->folder);
        meshes::write_assets(options->folder);
        print_written(options->folder, "reference meshes and MANIFEST.toml");
    });
}

}  // namespace pelletlab::apps
