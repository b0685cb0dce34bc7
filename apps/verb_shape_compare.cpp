// pelletlab shape compare: clumps beside their body, in numbers and in pictures.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <optional>

#include "apps/shape_report.hpp"
#include "apps/shape_stage.hpp"
#include "apps/shape_verbs.hpp"
#include "apps/terminal.hpp"
#include "core/error.hpp"
#include "io/clump_file.hpp"
#include "io/files.hpp"
#include "meshes/check.hpp"
#include "meshes/read_mesh.hpp"
#include "meshes/signed_distance.hpp"
#include "report/pictures.hpp"
#include "shapegen/make_clump.hpp"

namespace pelletlab::apps {

namespace fs = std::filesystem;

namespace {

struct CompareOptions {
    std::vector<std::string> clumps;
    std::string mesh, unit, folder;
    bool no_picture = false;
};

/// The body in the frame of its mesh: the one named, or the one that the clump was made from.
TriangleMesh body_of(const ClumpTemplate& clump, const fs::path& file, const CompareOptions& options) {
    if (!options.mesh.empty()) return meshes::require_closed_body(meshes::read_mesh(options.mesh, options.unit)).mesh;
    if (clump.mesh_file.empty()) throw bad_input("the clump names no mesh of its body", "name it: --mesh FILE --unit mm", {file.string()});
    const TriangleMesh in_body_frame = true_surface(clump, file);
    return transformed(in_body_frame, clump.rigid.mass_properties.body_in_mesh());
}

void run_compare(const CompareOptions& options) {
    std::vector<QualityRow> rows;
    std::vector<std::vector<std::string>> surfaces{
        {"shape", "normals off", "Sq flat", "Sq curved", "edge radius", "plane off by", "touching a plane", "DEM cost"}};
    std::vector<std::pair<fs::path, report::Image>> pictures;
    const auto length = [](double metres) { return std::isfinite(metres) && metres != 0.0 ? millimetres(metres) : std::string("-"); };
    for (const std::string& name : options.clumps) {
        const fs::path file = name;
        const ClumpTemplate clump = io::read_clump(file);
        const TriangleMesh body = body_of(clump, file, options);
        const auto exact = meshes::exact_signed_distance(body);
        const Pose pose = clump.rigid.mass_properties.body_in_mesh();
        std::vector<Sphere> spheres;
        for (const Sphere& s : clump.rigid.spheres) spheres.push_back({pose.to_world(s.centre), s.radius});
        shapegen::ClumpSettings settings;
        settings.density = clump.rigid.mass_properties.density;
        settings.mass_source = clump.mass_source;
        const shapegen::MadeClump judged = shapegen::judged_clump(spheres, body, *exact, settings);

        const std::string title = stem_of(file).filename().string();
        print_line(title + ":");
        print_masses(judged);
        rows.push_back({title, spheres.size(), judged.clump.quality});
        const shapegen::SurfaceReport& s = judged.surface;
        surfaces.push_back({title, fmt::format("{:.1f}°", s.normal_mean * 57.29577951308232), length(s.flat_sq), length(s.curved_sq),
                            length(s.edge_radius_mean), millimetres(s.support_rms),
                            fmt::format("{:.3g} (most {})", s.contacts_any_way, std::max(s.most_any_way, s.most_on_flat)),
                            fmt::format("{:.2f}", judged.relative_cost)});
        if (options.no_picture) continue;
        const auto distance = [&exact](std::span<const Vec3> points) { return exact->values(points); };
        report::PictureSettings picture;
        const fs::path folder = options.folder.empty() ? file.parent_path() : fs::path(options.folder);
        pictures.emplace_back(folder / (title + ".compare.png"), report::picture_of_clump(body, spheres, distance, picture));
        throw_if_interrupted();
    }
    print_quality_table(rows);
    print_line("What neighbours and walls feel (DEM cost: 1 is that of the study's Shape 2):");
    print_table(surfaces);
    for (const auto& [file, image] : pictures) {
        if (file.has_parent_path()) io::prepare_output_folder(file.parent_path());
        report::write_png(image, file);
        print_written(file, "the body, and the clump coloured by its distance from it");
    }
}

}  // namespace

void add_shape_compare(CLI::App& shape) {
    auto options = std::make_shared<CompareOptions>();
    CLI::App* verb = shape.add_subcommand("compare",
                                          "Put clumps beside their body: distances, mass properties, roughness, contacts, cost, pictures\n"
                                          "  example: pelletlab shape compare pellet.clump.toml other.clump.toml");
    verb->add_option("clumps", options->clumps, "Clump templates")->required();
    verb->add_option("--mesh", options->mesh, "Mesh of the body (default: the one that each clump names)");
    verb->add_option("--unit", options->unit, "Unit of that mesh");
    verb->add_option("-o,--output", options->folder, "Folder of the pictures (default: beside each clump)");
    verb->add_flag("--no-picture", options->no_picture, "Do not draw pictures");
    verb->callback([options, &shape, verb] {
        refuse_options_of_shape(shape, *verb);
        run_compare(*options);
    });
}

}  // namespace pelletlab::apps
