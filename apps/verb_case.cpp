// pelletlab case new | check | schema | reference
#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <vector>

#include "apps/terminal.hpp"
#include "apps/verbs.hpp"
#include "core/error.hpp"
#include "io/case_file.hpp"
#include "io/files.hpp"

namespace pelletlab::apps {

namespace {

struct CaseOptions {
    std::string rig, output, file;
    std::vector<std::string> overrides;
    bool overwrite = false;
};

/// Text to the file, or to standard output when no file is named.
void deliver(const CaseOptions& options, const std::string& text) {
    if (options.output.empty()) {
        print_line(text);
        return;
    }
    if (std::filesystem::exists(options.output) && !options.overwrite)
        throw bad_input("'" + options.output + "' is there already", "choose another name, or add --overwrite");
    io::write_text(options.output, text);
    print_written(options.output, "text");
}

}  // namespace

void add_case_verb(CLI::App& app) {
    auto options = std::make_shared<CaseOptions>();
    CLI::App* verb = app.add_subcommand("case", "Make, check and explain case files");
    verb->require_subcommand(1);
    verb->fallthrough();

    CLI::App* make = verb->add_subcommand("new", "A commented case file to start from\n  example: pelletlab case new drum -o my_drum.toml");
    make->add_option("rig", options->rig, "tube, drum, pile or tester")->required()->check(CLI::IsMember({"tube", "drum", "pile", "tester"}));
    make->callback([options] {
        for (const Rig rig : all_rigs)
            if (rig_name(rig) == options->rig) deliver(*options, io::new_case_text(rig));
    });

    CLI::App* check = verb->add_subcommand("check", "Read a case and print it with every default resolved\n  example: pelletlab case check examples/drum.toml");
    check->add_option("case", options->file, "Case file (TOML)")->required();
    check->add_option("--set", options->overrides, "key=value, for instance drum.speed=\"50 rpm\"; may be repeated");
    check->callback([options] { deliver(*options, io::resolved_case_text(io::read_case(options->file, options->overrides))); });

    CLI::App* schema = verb->add_subcommand("schema", "JSON Schema of case files, for editors\n  example: pelletlab case schema -o case.schema.json");
    schema->callback([options] { deliver(*options, io::case_json_schema()); });

    CLI::App* reference =
        verb->add_subcommand("reference", "Reference page of all keys\n  example: pelletlab case reference -o docs/case-reference.md --overwrite");
    reference->callback([options] { deliver(*options, io::case_reference_markdown()); });

    for (CLI::App* one : {make, check, schema, reference}) {
        one->add_option("-o,--output", options->output, "File; standard output when not given");
        one->add_flag("--overwrite", options->overwrite, "Replace an existing file");
    }
}

}  // namespace pelletlab::apps
