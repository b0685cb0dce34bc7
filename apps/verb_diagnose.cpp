// pelletlab diagnose audit | plan | run | report
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>

#include "apps/diagnose_print.hpp"
#include "apps/terminal.hpp"
#include "apps/verbs.hpp"
#include "core/error.hpp"
#include "diagnosis/diagnose.hpp"
#include "io/campaign_file.hpp"
#include "io/diagnosis_file.hpp"
#include "io/files.hpp"
#include "report/diagnosis_html.hpp"

namespace pelletlab::apps {

namespace {

namespace fs = std::filesystem;

struct DiagnoseOptions {
    std::string experiment, output, diagnosis = "diagnosis.json", html = "report.html";
};

diagnosis::Problem read_problem(const std::string& file) {
    const Experiment experiment = io::read_experiment(file);
    const Campaign campaign = campaign::assemble(io::read_campaign(experiment.campaign_file));
    return diagnosis::make_problem(diagnosis::make_model(campaign, experiment.library, experiment.exclude, experiment.file), experiment);
}

void run_audit(const DiagnoseOptions& options) {
    const diagnosis::Problem problem = read_problem(options.experiment);
    for (const AuditItem& item : diagnosis::audit(problem)) print_line((item.is_warning ? "  look at: " : "  ") + item.text);
}

void run_plan(const DiagnoseOptions& options) {
    diagnosis::DiagnoseOptions how;
    how.plan_only = true;
    print_plan(diagnosis::diagnose(read_problem(options.experiment), how));
}

void run_all(const DiagnoseOptions& options) {
    const Stopwatch stopwatch;
    const Experiment experiment = io::read_experiment(options.experiment);
    const fs::path folder = options.output.empty() ? fs::path("out") / ("diagnosis-" + experiment.name) : fs::path(options.output);
    const Campaign campaign = campaign::assemble(io::read_campaign(experiment.campaign_file));
    const diagnosis::Problem problem =
        diagnosis::make_problem(diagnosis::make_model(campaign, experiment.library, experiment.exclude, experiment.file), experiment);
    io::prepare_output_folder(folder);  // after all that can be wrong with the input, before the long work
    ProgressPrinter printer;
    diagnosis::DiagnoseOptions how;
    how.progress = printer.sink();
    Diagnosis d = diagnosis::diagnose(problem, how);
    printer.finish();
    d.provenance.version = build_version();
    d.provenance.git_hash = build_git_hash();
    d.provenance.verb = "diagnose run";
    d.provenance.seed = experiment.settings.seed;
    d.provenance.input_hashes = {{fs::path(experiment.file).filename().string(), experiment.text_sha256}, {"campaign", campaign.description.sha256}};
    io::write_diagnosis(d, folder / "diagnosis.json");
    io::write_text(folder / "report.html", report::diagnosis_html(d));
    print_plan(d);
    print_answers(d);
    print_written(folder / "diagnosis.json", "all numbers");
    print_written(folder / "report.html", "one offline page");
    print_line(fmt::format("  {} on the clock", duration_text(stopwatch.seconds())));
}

}  // namespace

void add_diagnose_verb(CLI::App& app) {
    auto options = std::make_shared<DiagnoseOptions>();
    CLI::App* group = app.add_subcommand("diagnose", "Say where a simulation and an experiment disagree, and which effect causes it");
    group->require_subcommand(1);
    group->fallthrough();
    const auto add = [&](const char* name, const char* help, void (*work)(const DiagnoseOptions&)) {
        CLI::App* verb = group->add_subcommand(name, help);
        verb->add_option("experiment", options->experiment, "experiment.toml: what was measured, and the campaign it is compared with")->required();
        verb->callback([options, work] { work(*options); });
        return verb;
    };
    add("audit", "Look for mistakes in the data before any statistics\n  example: pelletlab diagnose audit examples/diagnosis/experiment.toml", run_audit);
    add("plan",
        "Which effects can these data see and tell apart? Before they are judged\n  example: pelletlab diagnose plan examples/diagnosis/experiment.toml",
        run_plan);
    CLI::App* run =
        add("run", "The whole diagnosis: diagnosis.json and report.html\n  example: pelletlab diagnose run examples/diagnosis/experiment.toml -o out/diagnosis",
            run_all);
    run->add_option("-o,--output", options->output, "Folder of the results; out/diagnosis-<name> when not given");
    CLI::App* page = group->add_subcommand(
        "report", "Make the page again from diagnosis.json\n  example: pelletlab diagnose report out/diagnosis/diagnosis.json -o report.html");
    page->add_option("diagnosis", options->diagnosis, "diagnosis.json")->required();
    page->add_option("-o,--output", options->html, "HTML file")->capture_default_str();
    page->callback([options] {
        io::write_text(options->html, report::diagnosis_html(io::read_diagnosis(options->diagnosis)));
        print_written(options->html, "one offline page");
    });
    add_effect_verbs(*group);
    add_blind_verbs(*group);
}

}  // namespace pelletlab::apps
