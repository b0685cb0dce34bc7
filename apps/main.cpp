// The command line: verbs in verb_*.cpp, errors to exit codes here. 0 done · 2 usage · 3 bad input · 4 numerical failure · 130 interrupted.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include "apps/verbs.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"
#include "core/progress.hpp"
#include "core/provenance.hpp"

namespace {

constexpr const char* description =
    "PelletLab: from the mesh of a pellet to a measured DEM simulation.\n"
    "Verbs run one after the other; each reads the files of the one before:\n"
    "  pelletlab shape meshes/assets/cylinder_3.12x2.96.stl --unit mm -n 24 -o pellet.clump.toml\n"
    "  pelletlab fill examples/tube.toml\n"
    "  pelletlab drum examples/drum.toml --set drum.speed=\"50 rpm\"\n"
    "  pelletlab demo";

int report(const char* text, int code) {
    fmt::print(stderr, "pelletlab: error: {}\n", text);
    return code;
}

/// The parser complains first about what is missing; a word that it does not know is the likelier mistake.
pelletlab::Error unknown_word(const CLI::App& app) {
    std::vector<std::string> known;
    const auto add_names = [&known](const CLI::App* one) {
        for (const CLI::App* verb : one->get_subcommands({})) known.push_back(verb->get_name());
        for (const CLI::Option* option : one->get_options()) known.push_back(option->get_name());
    };
    add_names(&app);
    for (const CLI::App* verb : app.get_subcommands()) add_names(verb);
    const std::string word = app.remaining(true).front();
    const std::string closest = pelletlab::closest_word(word, known);
    return pelletlab::usage_error("'" + word + "' is no verb or option here", closest.empty() ? "see pelletlab --help" : "did you mean '" + closest + "'?");
}

}  // namespace

int main(int argc, char** argv) {
    pelletlab::install_interrupt_handler();
    CLI::App app(description, "pelletlab");
    app.require_subcommand(1);
    app.fallthrough();
    app.set_version_flag("--version", "pelletlab " + pelletlab::build_version() + " (" + pelletlab::build_git_hash() + ")");
    int threads = 0;
    app.add_option("--threads", threads, "Threads to use; 0 means all of the machine. Results do not depend on it.")->check(CLI::Range(0, 1024));
    app.parse_complete_callback([&threads] { pelletlab::set_thread_count(threads); });

    pelletlab::apps::add_shape_verb(app);
    pelletlab::apps::add_fill_verb(app);
    pelletlab::apps::add_drum_verb(app);
    pelletlab::apps::add_pile_verb(app);
    pelletlab::apps::add_tester_verb(app);
    pelletlab::apps::add_observe_verb(app);
    pelletlab::apps::add_compare_verb(app);
    pelletlab::apps::add_campaign_verb(app);
    pelletlab::apps::add_calibrate_verb(app);
    pelletlab::apps::add_demo_verb(app);
    pelletlab::apps::add_case_verb(app);
    pelletlab::apps::add_mesh_verb(app);
    pelletlab::apps::add_diagnose_verb(app);

    try {
        app.parse(argc, argv);
        return 0;
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() != 0 && !app.remaining(true).empty()) return report(unknown_word(app).what(), static_cast<int>(pelletlab::ErrorKind::usage));
        const int code = app.exit(error);
        return code == 0 ? 0 : static_cast<int>(pelletlab::ErrorKind::usage);
    } catch (const pelletlab::Error& error) {
        return report(error.what(), error.exit_code());
    } catch (const std::bad_alloc&) {
        return report("out of memory\n  what to do: fewer pellets, fewer spheres or fewer stored frames", static_cast<int>(pelletlab::ErrorKind::numerical));
    } catch (const std::exception& error) {
        return report(error.what(), static_cast<int>(pelletlab::ErrorKind::numerical));
    }
}
