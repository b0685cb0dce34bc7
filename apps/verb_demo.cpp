// pelletlab demo: the whole chain on the study's pellet, with the cases of examples/.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <memory>

#include "apps/run_stage.hpp"
#include "apps/shape_stage.hpp"
#include "apps/terminal.hpp"
#include "apps/verbs.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"
#include "io/files.hpp"

namespace pelletlab::apps {

namespace fs = std::filesystem;

namespace {

struct DemoOptions {
    std::string source = ".", output = "demo-out";
    std::uint32_t spheres = 24;
    bool force = false;
};

struct Step {
    std::string name;
    std::string speed;  ///< pellet-steps/s, or empty
    double seconds;
};

void copy_case(const fs::path& from, const fs::path& to) {
    io::write_text(to, io::read_text(from));
}

void run_demo(const DemoOptions& options) {
    const fs::path source = options.source;
    const fs::path mesh = source / "meshes/assets/cylinder_3.12x2.96.stl";
    if (!fs::exists(mesh))
        throw usage_error("the demo needs '" + mesh.string() + "'", "run it in PelletLab's source folder, or name that folder: pelletlab demo --source FOLDER");
    const fs::path out = options.output;
    io::prepare_output_folder(out);
    std::vector<Step> steps;
    const auto run = [&](const std::string& title, const std::function<std::string()>& work) {
        print_line("\n== " + title);
        const Stopwatch stopwatch;
        const std::string speed = work();
        steps.push_back({title, speed, stopwatch.seconds()});
    };
    const auto speed_of = [](const RunSummary& s) { return s.was_up_to_date ? std::string("up to date") : fmt::format("{:.3g}", s.pellet_steps_per_second); };

    run(fmt::format("shape: {} spheres for the study's 3.12 x 2.96 mm cylinder", options.spheres), [&]() -> std::string {
        ShapeRequest shape;
        shape.body.mesh_file = mesh;
        shape.body.unit = "mm";
        shape.settings.fit.sphere_count = options.spheres;
        shape.output = out / "pellet.clump.toml";
        shape.against = {"shape4"};
        shape.force = options.force;
        run_shape(shape);
        return {};
    });
    copy_case(source / "examples/tube.toml", out / "tube.toml");
    copy_case(source / "examples/drum.toml", out / "drum.toml");
    run("fill: 1000 pellets into a tube of 52 mm", [&] {
        return speed_of(run_case({out / "tube.toml", {}, out / "tube", options.force, Resume::if_possible}, Rig::tube));
    });
    for (const char* rpm : {"20", "50"})
        run(fmt::format("drum: D 80 x L 20 mm at {} rpm", rpm), [&] {
            return speed_of(run_case({out / "drum.toml",
                                      {fmt::format("name=drum-{}rpm", rpm), fmt::format("drum.speed={} rpm", rpm)},
                                      out / fmt::format("drum-{}rpm", rpm),
                                      options.force,
                                      Resume::if_possible},
                                     Rig::drum));
        });

    print_line(fmt::format("\n== Done on {} thread(s)", thread_count()));
    std::vector<std::vector<std::string>> table{{"step", "wall time", "pellet-steps/s"}};
    for (const Step& step : steps) table.push_back({step.name, duration_text(step.seconds), step.speed});
    print_table(table);
    print_line(fmt::format("  peak memory {:.0f} MB\nPictures:", peak_memory_megabytes()));
    for (const char* picture :
         {"pellet.png", "tube/tube.png", "drum-20rpm/drum.png", "drum-20rpm/velocity-map.png", "drum-50rpm/drum.png", "drum-50rpm/velocity-map.png"})
        print_line("  " + (out / picture).string());
    print_line("Numbers:");
    for (const char* folder : {"tube", "drum-20rpm", "drum-50rpm"}) print_line("  " + (out / folder / "observables.json").string());
}

}  // namespace

void add_demo_verb(CLI::App& app) {
    auto options = std::make_shared<DemoOptions>();
    CLI::App* demo =
        app.add_subcommand("demo", "The whole chain in minutes: mesh, clump, tube fill, drum at two speeds, pictures\n  example: pelletlab demo -o demo-out");
    demo->add_option("-o,--output", options->output, "Folder of the results")->capture_default_str();
    demo->add_option("--source", options->source, "PelletLab's source folder, with meshes/assets and examples")->capture_default_str();
    demo->add_option("-n,--spheres", options->spheres, "Spheres of the clump")->check(CLI::Range(1, 2000))->capture_default_str();
    demo->add_flag("--force", options->force, "Do every step again");
    demo->callback([options] { run_demo(*options); });
}

}  // namespace pelletlab::apps
