// pelletlab shape MESH: stage 1 on the command line.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <map>
#include <memory>
#include <optional>

#include "apps/shape_stage.hpp"
#include "apps/shape_verbs.hpp"
#include "apps/verbs.hpp"
#include "core/error.hpp"
#include "core/units.hpp"
#include "meshes/named_body.hpp"

namespace pelletlab::apps {

namespace {

struct ShapeOptions {
    ShapeRequest request;
    std::string mesh, output = "pellet.clump.toml", density = "1800 kg/m^3", min_radius, repair;
    bool no_picture = false;
};

std::string footer() {
    std::string text = "Bodies for --body, with their defaults (and facets=128):\n";
    for (const meshes::NamedBody& body : meshes::named_bodies()) text += fmt::format("  {}\n      {}\n", body.example, body.what);
    text += "Methods:\n";
    for (const NamedMethod& method : all_methods()) text += fmt::format("  {:<10} {}\n", method.id, method.name);
    return text;
}

void add_options(CLI::App& shape, ShapeOptions& options) {
    shapegen::ClumpSettings& settings = options.request.settings;
    shape.add_option("mesh", options.mesh, "STL, OBJ or PLY file of one closed body");
    shape.add_option("--unit", options.request.body.unit, "Unit of the mesh's coordinates: mm, m, um, in, … (the file does not say)");
    shape.add_option("--body", options.request.body.parametric, "A parametric body instead of a mesh file: cylinder:diameter=3.12mm,height=2.96mm (see below)");
    shape.add_option("--repair", options.repair, "Mend an open, crossing or multi-shell mesh: automatic, fill-holes, unite-shells, alpha-wrap")
        ->check(CLI::IsMember({"automatic", "fill-holes", "unite-shells", "alpha-wrap"}));
    shape.add_option("-n,--spheres", settings.fit.sphere_count, "Number of spheres")->check(CLI::Range(1, 2000))->capture_default_str();
    shape.add_option("--method", options.request.method, "Who places the spheres: fit, shape1 … shape4, openvdb, favier, ferellec, euclidean")
        ->capture_default_str();
    shape.add_flag("--volume-matched", options.request.volume_matched,
                   "Other methods than fit: change all radii by one length so that the volume is the body's");
    shape.add_option("--min-radius", options.min_radius, "Smallest radius allowed, with unit");
    shape.add_option("--effort", settings.fit.effort, "Search effort; time grows with it, the error falls slowly")
        ->check(CLI::Range(0.0, 100.0))
        ->capture_default_str();
    shape.add_option("-o,--output", options.output, "Clump template to write")->capture_default_str();
    shape.add_option("--density", options.density, "Particle density, with unit")->capture_default_str();
    const std::map<std::string, MassSource> sources{
        {"mesh", MassSource::target_mesh}, {"union", MassSource::union_of_spheres}, {"density-matched", MassSource::density_matched_union}};
    shape.add_option("--mass-source", settings.mass_source, "Whose mass and inertia the clump gets: mesh, union, density-matched")
        ->transform(CLI::CheckedTransformer(sources, CLI::ignore_case));
    shape.add_option("--seed", settings.fit.seed, "Seed of the search")->capture_default_str();
    shape.add_option("--against", options.request.against, "Print the figures of other methods beside, as drawn and volume-matched: shape4,openvdb,…")
        ->delimiter(',');
    shape.add_flag("--no-picture", options.no_picture, "Do not draw the picture");
    shape.add_flag("--force", options.request.force, "Fit again although nothing has changed");
    shape.footer(footer());
}

ShapeRequest request_of(const ShapeOptions& options) {
    ShapeRequest request = options.request;
    request.body.mesh_file = options.mesh;
    if (options.mesh.empty() == request.body.parametric.empty()) {
        if (options.mesh.empty()) throw usage_error("a mesh file or --body is required", "for instance: pelletlab shape pellet.stl --unit mm");
        throw usage_error("a mesh file and --body were given", "choose one of them");
    }
    static const std::map<std::string, meshes::RepairMethod> repairs{{"automatic", meshes::RepairMethod::automatic},
                                                                     {"fill-holes", meshes::RepairMethod::fill_holes},
                                                                     {"unite-shells", meshes::RepairMethod::unite_shells},
                                                                     {"alpha-wrap", meshes::RepairMethod::alpha_wrap}};
    if (!options.repair.empty()) request.body.repair = repairs.at(options.repair);
    request.output = options.output;
    request.settings.density = parse_quantity(options.density, dimension::density);
    if (!options.min_radius.empty()) request.settings.fit.min_radius = parse_quantity(options.min_radius, dimension::length);
    request.picture = !options.no_picture;
    return request;
}

}  // namespace

void refuse_options_of_shape(const CLI::App& shape, const CLI::App& verb) {
    for (const CLI::Option* option : shape.get_options())
        if (option->count() > 0)
            throw usage_error("'" + option->get_name() + "' belongs to `pelletlab shape`, not to `pelletlab shape " + verb.get_name() + "`",
                              "see pelletlab shape " + verb.get_name() + " --help");
}

void add_shape_verb(CLI::App& app) {
    auto options = std::make_shared<ShapeOptions>();
    CLI::App* shape = app.add_subcommand("shape",
                                         "Fit a clump of spheres to the mesh of a pellet\n"
                                         "  example: pelletlab shape meshes/assets/cylinder_3.12x2.96.stl --unit mm -n 24 -o pellet.clump.toml");
    shape->fallthrough();
    shape->require_subcommand(0, 1);
    add_options(*shape, *options);
    add_shape_export(*shape);
    add_shape_import(*shape);
    shape->callback([options, shape] {
        if (shape->get_subcommands().empty()) run_shape(request_of(*options));
    });
}

}  // namespace pelletlab::apps
