// pelletlab diagnose effects | signatures: the library of effects, and what a campaign says they do.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>

#include "apps/diagnose_print.hpp"
#include "apps/terminal.hpp"
#include "campaign/assemble.hpp"
#include "diagnosis/signatures.hpp"
#include "experiments/effects/effects.hpp"
#include "io/campaign_file.hpp"

namespace pelletlab::apps {

namespace {

/// «−0.5 to 0.5», «0 to 2 deg», «0.1, 0.2 mm», «on or off».
std::string range_text(const experiments::Effect& e) {
    const std::string unit = e.unit == "1" ? "" : " " + e.unit;
    if (e.levels == std::vector<double>{1.0}) return "on or off";
    if (e.levels.empty()) return fmt::format("{:g} to {:g}{}", e.two_sided ? -e.full : 0.0, e.full, unit);
    std::string levels;
    for (const double l : e.levels) levels += fmt::format("{}{:g}", levels.empty() ? "" : ", ", l);
    return levels + unit;
}

std::string rigs_text(const experiments::Effect& e) {
    if (e.is_measurement()) return "readings of the drum";
    std::string text;
    for (const Rig rig : e.rigs) text += (text.empty() ? "" : ", ") + rig_name(rig);
    return text.empty() ? "all rigs" : text;
}

void list_effects(bool as_markdown) {
    const auto& library = experiments::effect_library();
    if (as_markdown) {
        // The page is this output, so that it cannot fall behind; a test compares them.
        print_line("| id | effect | what changes (a: the amplitude) | range of a | where | class | source | what would show it |");
        print_line("| --- | --- | --- | --- | --- | --- | --- | --- |");
        for (const auto& e : library)
            print_line(fmt::format("| {} | `{}`: {} | {} | {} | {} | {} | {} | {} |", e.id, e.name, e.title, e.equation, range_text(e), rigs_text(e),
                                   e.effect_class, e.source, e.test));
        return;
    }
    for (const auto& e : library) {
        print_line(fmt::format("{:<3} {}  ({}; {}; {})", e.id, e.name, range_text(e), rigs_text(e), e.effect_class));
        print_line("      " + e.title + ": " + e.equation);
        print_line("      source: " + e.source + ". Shown by: " + e.test);
    }
    print_line(fmt::format("{} effects. In plan.toml: [[effect]] name = \"...\"; for one run: pelletlab drum CASE --effect name=amplitude", library.size()));
}

/// Rows are observables, columns effects, an entry «−3.2 ± 0.4» in the scatter of single runs.
void print_signatures(const std::string& file, bool as_markdown) {
    const Campaign campaign = campaign::assemble(io::read_campaign(file));
    const diagnosis::SignatureTable table = diagnosis::signature_table(campaign);
    std::vector<std::vector<std::string>> rows{{"effect (θ = 1)", "runs"}};
    for (const auto& row : table.rows) rows[0].push_back(row.observable + ", " + row.regime);
    for (std::size_t k = 0; k < table.effects.size(); ++k) {
        std::vector<std::string> line{table.effects[k], std::to_string(table.runs[k])};
        for (const auto& row : table.rows) {
            const auto& e = row.effects[k];
            line.push_back(fmt::format("{}{:+.1f} ± {:.1f}{}", as_markdown && e.is_significant ? "**" : "", e.in_scatter, e.error,
                                       !e.is_significant ? ""
                                       : as_markdown     ? "**"
                                                         : " *"));
        }
        rows.push_back(line);
    }
    std::vector<std::string> scatter{"scatter of one run", ""};
    for (const auto& row : table.rows) scatter.push_back(fmt::format("{:.2g}{}", row.scatter, row.unit == "1" ? "" : " " + row.unit));
    rows.push_back(scatter);
    // Effects as rows would be wide with many observables: turned, an observable a row.
    std::vector<std::vector<std::string>> turned(rows[0].size());
    for (const auto& row : rows)
        for (std::size_t j = 0; j < row.size(); ++j) turned[j].push_back(row[j]);
    const auto& shown = turned;
    if (as_markdown) {
        for (std::size_t i = 0; i < shown.size(); ++i) {
            std::string text = "|", rule = "|";
            for (const std::string& cell : shown[i]) text += " " + cell + " |", rule += " --- |";
            print_line(text);
            if (i == 0) print_line(rule);
        }
    } else {
        print_table(shown);
    }
    print_line("");
    print_line(
        fmt::format("Campaign {}: {} configurations with at most one effect; scatter of single runs from {}. An entry is the move at θ = 1 over that scatter, "
                    "mean over the ranges of the calibrated parameters, ± "
                    "the standard error of the regression; {} marks those beyond the 99 % point.",
                    campaign.description.name, table.configurations,
                    table.scatter_from_repeats ? fmt::format("repeated runs ({} degrees of freedom)", table.repeats)
                                               : std::string("the regression's residuals, as nothing was repeated"),
                    as_markdown ? "bold" : "*"));
}

}  // namespace

void add_effect_verbs(CLI::App& group) {
    auto as_markdown = std::make_shared<bool>(false);
    auto file = std::make_shared<std::string>();
    CLI::App* effects =
        group.add_subcommand("effects", "The library of effects: what each changes, its range and source\n  example: pelletlab diagnose effects");
    effects->add_flag("--markdown", *as_markdown, "As the table of docs/effects.md");
    effects->callback([as_markdown] { list_effects(*as_markdown); });
    CLI::App* signatures = group.add_subcommand("signatures",
                                                "What each effect of a campaign does to each observable, in the scatter of single runs\n"
                                                "  example: pelletlab diagnose signatures examples/diagnosis/campaign.toml");
    signatures->add_option("campaign", *file, "campaign.toml: runs with and without effects")->required();
    signatures->add_flag("--markdown", *as_markdown, "As a table of a Markdown page");
    signatures->callback([as_markdown, file] { print_signatures(*file, *as_markdown); });
}

}  // namespace pelletlab::apps
