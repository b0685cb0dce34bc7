// pelletlab shape import: a clump of another program as a template; judged against the body's mesh where there is one.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <limits>
#include <memory>

#include "apps/shape_report.hpp"
#include "apps/shape_verbs.hpp"
#include "apps/stage.hpp"
#include "apps/terminal.hpp"
#include "core/error.hpp"
#include "core/units.hpp"
#include "io/clump_file.hpp"
#include "io/files.hpp"
#include "meshes/check.hpp"
#include "meshes/mass_properties.hpp"
#include "meshes/read_mesh.hpp"
#include "shapegen/formats/formats.hpp"
#include "shapegen/make_clump.hpp"
#include "shapegen/union_properties.hpp"

namespace pelletlab::apps {

namespace fs = std::filesystem;
namespace formats = shapegen::formats;

namespace {

struct ImportOptions {
    std::vector<std::string> files;
    std::string from, output = "pellet.clump.toml", density, mesh, mesh_unit, mass = "auto";
    formats::ReadOptions read;
};

/// By the longest ending that fits.
const formats::Format& format_of(const ImportOptions& options) {
    if (!options.from.empty()) return formats::find(options.from);
    const formats::Format* best = nullptr;
    for (const formats::Format& format : formats::all())
        if (options.files.front().ends_with(format.extension) && (best == nullptr || format.extension.size() > best->extension.size())) best = &format;
    if (best == nullptr) {
        std::string known;
        for (const formats::Format& format : formats::all())
            if (format.read != nullptr) known += (known.empty() ? "" : ", ") + format.id;
        throw usage_error("the name '" + options.files.front() + "' does not tell the format", "say it: --from FORMAT, one of " + known);
    }
    return *best;
}

FitQuality unknown_quality() {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    FitQuality quality;
    quality.volume_error = quality.centre_offset = quality.symmetric_difference = quality.missing = quality.outside = quality.distance_error_bound = nan;
    quality.inertia_error = Vec3::Constant(nan);
    quality.target_to_union = quality.union_to_target = quality.both = {nan, nan, nan, nan};
    return quality;
}

/// The mass properties of the import: the file's own, or those of the union or the mesh at the density given.
RigidTemplate weighed(const formats::ImportedClump& imported, const ImportOptions& options, std::optional<double> density,
                      const std::optional<TriangleMesh>& body, ClumpTemplate& clump, std::string& source) {
    const bool complete = imported.mass && (imported.inertia || imported.unit_density_inertia);
    std::string from = options.mass;
    if (from == "auto") from = complete || imported.unit_density_inertia ? "file" : body ? "mesh" : "union";
    if (from == "file") {
        source = "the file";
        clump.mass_source = MassSource::target_mesh;  // what the other program took for the body
        return formats::rigid_template(imported, density);
    }
    if (!density) density = imported.density;
    if (!density)
        throw bad_input("the density is needed to weigh the clump: the file does not say it", "give it like --density \"1800 kg/m^3\"",
                        {options.files.front()});
    if (!(*density > 0.0)) throw bad_input("the particle density is not positive", "give it like 1800 kg/m^3");
    if (from == "mesh" && !body) throw usage_error("mass properties of the mesh need the mesh", "name it: --mesh FILE --unit mm");
    source = from == "mesh" ? "the mesh" : "the union of the spheres";
    clump.mass_source = from == "mesh" ? MassSource::target_mesh : MassSource::union_of_spheres;
    return shapegen::rigid_template(imported.name, imported.spheres,
                                    from == "mesh" ? meshes::mass_properties(*body, *density) : shapegen::union_mass_properties(imported.spheres, *density));
}

void run_import(const ImportOptions& options) {
    const formats::Format& format = format_of(options);
    if (format.read == nullptr)
        throw usage_error(format.program + " cannot be read", "a mesh of the union holds no spheres: fit it again with pelletlab shape");
    std::vector<formats::FormatFile> files;
    StageKey key;
    key.verb = "shape import";
    for (const std::string& file : options.files) {
        files.push_back({file, io::read_text(file)});
        key.inputs[fs::path(file).filename().string()] = io::sha256_of_text(files.back().content);
    }
    const formats::ImportedClump imported = format.read(files, options.read);
    std::optional<double> density;
    if (!options.density.empty()) density = parse_quantity(options.density, dimension::density);
    std::optional<TriangleMesh> body;
    if (!options.mesh.empty()) body = meshes::require_closed_body(meshes::read_mesh(options.mesh, options.mesh_unit)).mesh;

    ClumpTemplate clump;
    std::string source;
    clump.rigid = weighed(imported, options, density, body, clump, source);
    if (clump.rigid.name.empty()) clump.rigid.name = fs::path(options.files.front()).stem().string();
    clump.quality = unknown_quality();
    const fs::path output = options.output, folder = output.has_parent_path() ? output.parent_path() : fs::path(".");
    if (body) {
        shapegen::ClumpSettings settings;
        settings.density = clump.rigid.mass_properties.density;
        const shapegen::MadeClump judged = shapegen::judged_clump(imported.spheres, *body, *meshes::exact_signed_distance(*body), settings);
        clump.quality = judged.clump.quality;
        clump.masses = judged.clump.masses;
        clump.mesh_file = fs::proximate(fs::absolute(options.mesh), fs::absolute(folder)).generic_string();
        clump.mesh_unit = options.mesh_unit;
        clump.mesh_hash = io::sha256_of_file(options.mesh);
        key.inputs["mesh"] = clump.mesh_hash;
    }
    clump.provenance = provenance_of(key, 0);

    print_line(fmt::format("{}: {} spheres, read as {}", options.files.front(), clump.rigid.spheres.size(), format.program));
    for (const std::string& note : imported.notes) print_line("  note: " + note);
    if (options.mass == "auto" && source != "the file")
        print_line("  note: the files named hold no mass properties; a companion file of the export may (see docs/clump-formats.md)");
    print_mass_of(clump, source);
    if (body)
        print_quality_table({{clump.rigid.name, clump.rigid.spheres.size(), clump.quality}});
    else
        print_line("  no mesh given (--mesh), so how well the spheres fit the body is not known");
    io::prepare_output_folder(folder);
    io::write_clump(clump, output);
    print_written(output, fmt::format("clump of {} spheres", clump.rigid.spheres.size()));
}

}  // namespace

void add_shape_import(CLI::App& shape) {
    auto options = std::make_shared<ImportOptions>();
    CLI::App* verb = shape.add_subcommand("import",
                                          "Read a clump of another program (LIGGGHTS, LAMMPS, Yade, MercuryDPM, Chrono, PFC, EDEM, CSV, VTK)\n"
                                          "  example: pelletlab shape import pellet.yade.txt --density \"1800 kg/m^3\" --length-unit m -o pellet.clump.toml");
    verb->add_option("files", options->files, "The file, then its companions (mass table, LIGGGHTS input lines, …)")->required();
    verb->add_option("--from", options->from, "Format: liggghts, lammps, yade, mercury, chrono, pfc, edem, csv, vtk (default: by the ending)");
    verb->add_option("-o,--output", options->output, "Clump template to write")->capture_default_str();
    verb->add_option("--length-unit", options->read.length_unit, "Unit of the file's lengths, where it does not say it");
    verb->add_option("--mass-unit", options->read.mass_unit, "Unit of the file's masses, where it does not say it");
    verb->add_option("--density", options->density, "Particle density, with unit, where the file does not say it");
    verb->add_option("--mesh", options->mesh, "Mesh of the body in the frame of the file, to judge the spheres against");
    verb->add_option("--unit", options->mesh_unit, "Unit of that mesh");
    verb->add_option("--mass-source", options->mass, "Whose mass and inertia: file, mesh, union (default: the file's, else the mesh's, else the union's)")
        ->check(CLI::IsMember({"auto", "file", "mesh", "union"}));
    verb->callback([options, &shape, verb] {
        refuse_options_of_shape(shape, *verb);
        run_import(*options);
    });
}

}  // namespace pelletlab::apps
