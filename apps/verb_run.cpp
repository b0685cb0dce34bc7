// pelletlab fill, drum, pile and tester CASE: the rigs on the command line.
#include <CLI/CLI.hpp>
#include <memory>

#include "apps/run_stage.hpp"
#include "apps/verbs.hpp"
#include "core/error.hpp"
#include "core/units.hpp"

namespace pelletlab::apps {

namespace {

void add_run_verb(CLI::App& app, Rig rig, const char* name, const char* text) {
    struct Options {
        std::string case_file, output;
        std::vector<std::string> overrides, effects;
        std::string checkpoint_every = "1 min";
        bool force = false, resume = false;
    };
    auto options = std::make_shared<Options>();
    CLI::App* verb = app.add_subcommand(name, text);
    verb->add_option("case", options->case_file, "Case file (TOML); make one with: pelletlab case new")->required();
    verb->add_option("-o,--output", options->output, "Folder of the results; out/<case name> when not given");
    verb->add_option("--set", options->overrides, "key=value over the case file, for instance pellet.count=500; may be repeated");
    verb->add_option("--effect", options->effects, "name=amplitude of the library of effects, after --set (pelletlab diagnose effects); may be repeated");
    verb->add_flag("--force", options->force, "Run again although nothing has changed");
    verb->add_flag("--resume", options->resume, "Go on from the last checkpoint of an interrupted run; the result is that of the unbroken run, bit for bit");
    verb->add_option("--checkpoint-every", options->checkpoint_every, "Wall time between checkpoints, \"30 s\"; \"0 s\": only when interrupted")
        ->capture_default_str();
    verb->callback([options, rig] {
        RunRequest request{options->case_file, options->overrides, options->output, options->force};
        request.effects = options->effects;
        request.resume = options->resume ? Resume::yes : Resume::refuse;
        request.checkpoint_interval = parse_quantity(options->checkpoint_every, dimension::time);
        if (request.checkpoint_interval < 0.0) throw usage_error("--checkpoint-every is negative", "give a time such as \"30 s\"");
        run_case(request, rig);
    });
}

}  // namespace

void add_fill_verb(CLI::App& app) {
    add_run_verb(app, Rig::tube, "fill", "Fill a tube with pellets and measure the bed\n  example: pelletlab fill examples/tube.toml -o out/tube");
}

void add_drum_verb(CLI::App& app) {
    add_run_verb(app, Rig::drum, "drum",
                 "Turn a drum and measure angles of repose and velocities\n  example: pelletlab drum examples/drum.toml --set drum.speed=\"50 rpm\"");
}

void add_pile_verb(CLI::App& app) {
    add_run_verb(app, Rig::pile, "pile",
                 "Pour a pile on a plate, from a funnel or a lifted cylinder, and measure it\n"
                 "  example: pelletlab pile examples/sandpile.toml --set pellet.count=1000");
}

void add_tester_verb(CLI::App& app) {
    add_run_verb(app, Rig::tester, "tester",
                 "Turn an attrition tester (ASTM D4058): the pellet cloud at eight baffle angles, collision energies\n"
                 "  example: pelletlab tester examples/attrition_40rpm.toml --set pellet.count=300");
}

}  // namespace pelletlab::apps
