// pelletlab shape MESH: stage 1 on the command line.
#include <CLI/CLI.hpp>
#include <map>
#include <memory>

#include "apps/shape_stage.hpp"
#include "apps/verbs.hpp"
#include "core/units.hpp"

namespace pelletlab::apps {

void add_shape_verb(CLI::App& app) {
    struct Options {
        ShapeRequest request;
        std::string mesh, output = "pellet.clump.toml", density = "1800 kg/m^3", min_radius;
        bool no_picture = false;
    };
    auto options = std::make_shared<Options>();
    CLI::App* shape = app.add_subcommand("shape",
                                         "Fit a clump of spheres to the mesh of a pellet\n"
                                         "  example: pelletlab shape meshes/assets/cylinder_3.12x2.96.stl --unit mm -n 24 -o pellet.clump.toml");
    shape->add_option("mesh", options->mesh, "STL, OBJ or PLY file of one closed body")->required();
    shape->add_option("--unit", options->request.unit, "Unit of the mesh's coordinates: mm, m, um, in, … (the file does not say)");
    shape->add_option("-n,--spheres", options->request.sphere_count, "Number of spheres")->check(CLI::Range(1, 2000))->capture_default_str();
    shape->add_option("-o,--output", options->output, "Clump template to write")->capture_default_str();
    shape->add_option("--density", options->density, "Particle density, with unit")->capture_default_str();
    shape->add_option("--min-radius", options->min_radius, "Smallest radius allowed, with unit");
    const std::map<std::string, MassSource> sources{
        {"mesh", MassSource::target_mesh}, {"union", MassSource::union_of_spheres}, {"density-matched", MassSource::density_matched_union}};
    shape->add_option("--mass-source", options->request.mass_source, "Whose mass and inertia the clump gets: mesh, union, density-matched")
        ->transform(CLI::CheckedTransformer(sources, CLI::ignore_case));
    shape->add_option("--seed", options->request.seed, "Seed of the search")->capture_default_str();
    shape->add_option("--study-shape", options->request.study_shape, "Print the study's hand-made Shape 1 … 4 beside (3.12 x 2.96 mm cylinder)")
        ->check(CLI::Range(1, 4));
    shape->add_flag("--no-picture", options->no_picture, "Do not draw the picture");
    shape->add_flag("--force", options->request.force, "Fit again although nothing has changed");
    shape->callback([options] {
        ShapeRequest request = options->request;
        request.mesh_file = options->mesh;
        request.output = options->output;
        request.density = parse_quantity(options->density, dimension::density);
        if (!options->min_radius.empty()) request.min_radius = parse_quantity(options->min_radius, dimension::length);
        request.picture = !options->no_picture;
        run_shape(request);
    });
}

}  // namespace pelletlab::apps
