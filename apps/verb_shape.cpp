// pelletlab shape MESH: stage 1 on the command line.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <map>
#include <memory>

#include "apps/body_options.hpp"
#include "apps/shape_settings.hpp"
#include "apps/shape_stage.hpp"
#include "apps/shape_verbs.hpp"
#include "apps/verbs.hpp"
#include "core/error.hpp"
#include "core/units.hpp"

namespace pelletlab::apps {

namespace {

struct ShapeOptions {
    ShapeRequest request;
    BodyOptions body;
    std::string output = "pellet.clump.toml", density = "1800 kg/m^3", min_radius, poke_out, press, symmetry = "none";
    std::vector<std::string> until;
    bool no_picture = false;
};

std::string footer() {
    std::string text = list_of_bodies();
    text += "Methods:\n";
    for (const NamedMethod& method : all_methods()) text += fmt::format("  {:<10} {}\n", method.id, method.name);
    return text;
}

void add_options(CLI::App& shape, ShapeOptions& options) {
    shapegen::ClumpSettings& settings = options.request.settings;
    add_body_options(shape, options.body);
    shape.add_option("-n,--spheres", settings.fit.sphere_count, "Number of spheres")->check(CLI::Range(1, 2000))->capture_default_str();
    shape.add_option("--method", options.request.method, "Who places the spheres: fit, shape1 … shape4, openvdb, favier, ferellec, euclidean")
        ->capture_default_str();
    shape.add_flag("--volume-matched", options.request.volume_matched,
                   "Other methods than fit: change all radii by one length so that the volume is the body's");
    shape
        .add_option("--mode", settings.fit.mode,
                    "What a good fit is: mean, minimax, inside (nothing pokes out), outside (all covered), flat (level poles on flat faces)")
        ->transform(CLI::CheckedTransformer(fit_modes(), CLI::ignore_case))
        ->option_text("MODE=mean");
    shape
        .add_option("--until", options.until,
                    "As few spheres as reach this, instead of -n: rms=0.02mm, mean=, max=, edge= (rounding of edges), inertia=1%, difference=, volume=; "
                    "several: separated by commas")
        ->delimiter(',');
    shape.add_option("--most-spheres", settings.stop.most_spheres, "… and not more than so many")->check(CLI::Range(1, 2000))->capture_default_str();
    shape.add_option("--cost", settings.most_cost, "As many spheres as this DEM cost buys, instead of -n: 2 is twice the cost of the study's Shape 2")
        ->check(CLI::Range(1e-3, 1e6));
    shape.add_option("--symmetry", options.symmetry, "Impose it exactly: none, own (the body's), or so many times round its axis: 8")->capture_default_str();
    shape.add_option("--min-radius", options.min_radius, "Smallest radius allowed, with unit");
    shape.add_option("--poke-out", options.poke_out, "Mode inside: how far spheres may reach out after all, with unit");
    shape.add_option("--max-contacts", settings.fit.most_contacts, "Most spheres that a plane may touch at once; 0: no limit")->capture_default_str();
    shape.add_option("--press", options.press, "How deep that plane is pressed in, with unit (default: 1/300 of the smallest extent)");
    shape.add_option("--effort", settings.fit.effort, "Search effort; time grows with it, the error falls slowly")
        ->check(CLI::Range(0.0, 100.0))
        ->capture_default_str();
    shape.add_option("-o,--output", options.output, "Clump template to write")->capture_default_str();
    shape.add_option("--density", options.density, "Particle density, with unit")->capture_default_str();
    const std::map<std::string, MassSource> sources{
        {"mesh", MassSource::target_mesh}, {"union", MassSource::union_of_spheres}, {"density-matched", MassSource::density_matched_union}};
    shape.add_option("--mass-source", settings.mass_source, "Whose mass and inertia the clump gets: mesh, union, density-matched")
        ->transform(CLI::CheckedTransformer(sources, CLI::ignore_case))
        ->option_text("SOURCE=mesh");
    shape.add_option("--seed", settings.fit.seed, "Seed of the search")->capture_default_str();
    shape.add_option("--against", options.request.against, "Print the figures of other methods beside, as drawn and volume-matched: shape4,openvdb,…")
        ->delimiter(',');
    shape.add_flag("--no-picture", options.no_picture, "Do not draw the picture");
    shape.add_flag("--force", options.request.force, "Fit again although nothing has changed");
    shape.footer(footer());
}

ShapeRequest request_of(const ShapeOptions& options) {
    ShapeRequest request = options.request;
    request.body = body_request(options.body);
    request.output = options.output;
    request.settings.density = parse_quantity(options.density, dimension::density);
    for (const std::string& text : options.until) add_criterion(text, request.settings.stop);
    set_symmetry(options.symmetry, request.settings.fit);
    if (!options.poke_out.empty()) request.settings.fit.poke_out = parse_quantity(options.poke_out, dimension::length);
    if (!options.press.empty()) request.settings.fit.press = parse_quantity(options.press, dimension::length);
    if (!options.min_radius.empty()) request.settings.fit.min_radius = parse_quantity(options.min_radius, dimension::length);
    request.picture = !options.no_picture;
    return request;
}

// Options that would be passed over in silence.
void refuse_idle_options(const CLI::App& shape, const ShapeRequest& request) {
    if (shape.count("--spheres") > 0 && (shape.count("--until") > 0 || shape.count("--cost") > 0))
        throw usage_error("the number of spheres is given and asked for at once", "leave -n away, or --until and --cost");
    if (request.method == fit_method) return;
    for (const char* option :
         {"--mode", "--until", "--most-spheres", "--cost", "--symmetry", "--min-radius", "--poke-out", "--max-contacts", "--press", "--effort"})
        if (shape.count(option) > 0)
            throw usage_error(std::string(option) + " belongs to our fit, not to the method '" + request.method + "'", "leave it away, or --method");
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
    add_shape_compare(*shape);
    add_shape_pareto(*shape);
    add_shape_family(*shape);
    shape->callback([options, shape] {
        if (!shape->get_subcommands().empty()) return;
        const ShapeRequest request = request_of(*options);
        refuse_idle_options(*shape, request);
        run_shape(request);
    });
}

}  // namespace pelletlab::apps
