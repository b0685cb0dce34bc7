// pelletlab diagnose blind make | run | score: the diagnosis judged on cases whose cause is sealed.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <fstream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/diagnose_print.hpp"
#include "apps/terminal.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"
#include "diagnosis/blind.hpp"
#include "io/campaign_file.hpp"
#include "io/files.hpp"

namespace pelletlab::diagnosis {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(BlindLabel, id, kind, configuration, effects, amplitude, detectability, separability, regions, silent)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(BlindVerdict, id, verdict, named, discoveries, measured_discoveries, inclusion, probability_of_open, probability_of_none,
                                   pair_gain, pair_confirmed, best_p, credible_set, rules)

}  // namespace pelletlab::diagnosis

namespace pelletlab::apps {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using diagnosis::BlindCase;
using diagnosis::BlindLabel;
using diagnosis::BlindVerdict;

struct BlindOptions {
    std::string experiment, folder = "blind", output;
    std::uint64_t seed = 1, avoid = 0;
    int cases = 100;
};

diagnosis::BlindCounts counts_of(int cases) {
    const diagnosis::BlindCounts c;
    const auto part = [cases](int of_hundred) { return std::max(1, of_hundred * cases / 100); };
    return {part(c.null), part(c.single), part(c.pair), part(c.outside), part(c.reduced)};
}

/// The case as files that `pelletlab diagnose run` can read, too. Nothing in them depends on the label but the numbers themselves.
void write_case(const fs::path& folder, const Experiment& e) {
    io::prepare_output_folder(folder);
    std::string toml =
        fmt::format("name = \"{}\"\ncampaign = \"{}\"\nlibrary = [", e.name, fs::relative(fs::absolute(e.campaign_file), fs::absolute(folder)).string());
    for (std::size_t i = 0; i < e.library.size(); ++i) toml += (i == 0 ? "\"" : ", \"") + e.library[i] + "\"";
    toml += "]\nexclude = [";
    for (std::size_t i = 0; i < e.exclude.size(); ++i) {
        toml += i == 0 ? "{ " : ", { ";
        for (std::size_t j = 0; j < e.exclude[i].size(); ++j)
            toml += fmt::format("{}{} = {:.17g}", j == 0 ? "" : ", ", e.exclude[i][j].first, e.exclude[i][j].second);
        toml += " }";
    }
    const DiagnosisSettings& s = e.settings;
    toml += fmt::format(
        "]\n\n[settings]\nseed = {}\nbootstrap = {}\nrecalibration_cases = {}\nscatter = \"one run\"\ntolerance_correlation = {:.17g}\nfalse_discovery_rate = "
        "{:.17g}\n",
        s.seed, s.bootstrap, s.recalibration_cases, s.tolerance_correlation, s.false_discovery_rate);
    for (const Region& r : e.regions)
        toml += fmt::format("\n[[region]]\nobservable = \"{}\"\nname = \"{}\"\nrange = [{:.17g}, {:.17g}]\n", r.observable, r.name, r.lower, r.upper);
    for (std::size_t m = 0; m < e.measurements.size(); ++m) {
        const Measurement& one = e.measurements[m];
        toml += fmt::format("\n[[measurement]]\nobservable = \"{}\"\n", one.observable);
        if (!one.regime.empty()) toml += fmt::format("regime = \"{}\"\n", one.regime);
        toml += fmt::format("unit = \"{}\"\nuncertainty = {:.17g}\ninstrument = \"run {}\"\n", one.unit, one.uncertainty[0], m + 1);
        if (one.axis.empty()) {
            toml += fmt::format("value = {:.17g}\n", one.value[0]);
            continue;
        }
        std::string csv = "axis,value\n";
        for (std::size_t i = 0; i < one.axis.size(); ++i) csv += fmt::format("{:.17g},{:.17g}\n", one.axis[i], one.value[i]);
        const std::string name = fmt::format("profile_{}.csv", m + 1);
        io::write_text(folder / name, csv);
        toml += fmt::format("data = \"{}\"\naxis_column = \"axis\"\nvalue_column = \"value\"\naxis_unit = \"{}\"\n", name, one.axis_unit);
    }
    io::write_text(folder / "experiment.toml", toml);
}

std::string seal_of(const BlindLabel& label, const std::string& salt) {
    return io::sha256_of_text(Json(label).dump() + salt);
}

/// Salts come from the clock: they only have to be unknown to whoever reads the published hashes.
std::string make_salt(const std::string& id) {
    const auto ticks = std::chrono::high_resolution_clock::now().time_since_epoch().count();
    return io::sha256_of_text(fmt::format("{} {} {}", id, ticks, static_cast<const void*>(&id)));
}

void make(const BlindOptions& o) {
    const Experiment from = io::read_experiment(o.experiment);
    const Campaign campaign = campaign::assemble(io::read_campaign(from.campaign_file));
    const fs::path folder = o.folder;
    if (fs::exists(folder / "sealed")) throw bad_input("there are sealed cases in this folder already", "choose another folder with -o", {folder.string()});
    std::vector<int> taken;
    if (o.avoid != 0)
        for (const BlindCase& one : diagnosis::draw_blind_cases(campaign, counts_of(o.cases), o.avoid, {})) taken.push_back(one.label.configuration);
    auto cases = diagnosis::draw_blind_cases(campaign, counts_of(o.cases), o.seed, taken);
    // λ and regions of the labels: from the full library's emulator of each fold.
    std::map<std::string, std::shared_ptr<const diagnosis::Model>> models;
    std::vector<std::shared_ptr<const diagnosis::Model>> model_of(cases.size());
    for (std::size_t i = 0; i < cases.size(); ++i) {
        auto& model = models[Json(cases[i].exclude).dump()];
        if (!model) model = diagnosis::make_model(campaign, {}, cases[i].exclude, from.file);
        model_of[i] = model;
    }
    parallel_for(cases.size(), 1, [&](std::size_t i) {
        BlindCase whole = cases[i];
        whole.library.clear();
        Experiment e = diagnosis::blind_experiment(campaign, from, whole);
        e.settings.scatter_of_one_run = true;
        const diagnosis::Problem problem = diagnosis::make_problem(model_of[i], e);
        diagnosis::measure_label(cases[i].label, campaign, diagnosis::Attributor(problem));
    });
    io::prepare_output_folder(folder / "public");
    io::prepare_output_folder(folder / "sealed");
    Json hashes, labels = Json::array();
    for (const BlindCase& one : cases) {
        write_case(folder / "public" / one.label.id, diagnosis::blind_experiment(campaign, from, one));
        const std::string salt = make_salt(one.label.id);
        hashes[one.label.id] = seal_of(one.label, salt);
        labels.push_back({{"label", one.label}, {"salt", salt}});
    }
    io::write_text(folder / "sealed" / "labels.json", labels.dump(1) + "\n");
    io::write_text(folder / "public" / "hashes.json", hashes.dump(1) + "\n");
    print_written(folder / "public", fmt::format("{} cases and the hashes of their labels", cases.size()));
    print_written(folder / "sealed", "the labels: not to be opened before the score");
}

void run(const BlindOptions& o) {
    const Stopwatch stopwatch;
    const fs::path folder = o.folder;
    if (!fs::exists(folder / "public" / "hashes.json"))
        throw bad_input("there are no blind cases here", "make them: pelletlab diagnose blind make", {folder.string()});
    std::vector<Experiment> experiments;
    const Json hashes = Json::parse(io::read_text(folder / "public" / "hashes.json"));
    for (const auto& [id, hash] : hashes.items()) experiments.push_back(io::read_experiment(folder / "public" / id / "experiment.toml"));
    std::map<std::string, Campaign> campaigns;
    std::map<std::string, std::shared_ptr<const diagnosis::Model>> models;
    std::map<std::string, std::size_t> widest;  // the case of a fold with the largest library: its design fixes the thresholds
    ProgressPrinter printer;
    const ProgressSink progress = printer.sink();
    std::vector<diagnosis::Problem> problems;
    std::vector<std::string> fold_of;
    for (std::size_t i = 0; i < experiments.size(); ++i) {
        throw_if_interrupted();
        const Experiment& e = experiments[i];
        if (campaigns.count(e.campaign_file) == 0) campaigns[e.campaign_file] = campaign::assemble(io::read_campaign(e.campaign_file));
        const std::string fold = Json(e.exclude).dump();
        auto& model = models[fold + Json(e.library).dump()];
        if (!model) model = diagnosis::make_model(campaigns[e.campaign_file], e.library, e.exclude, e.file);
        problems.push_back(diagnosis::make_problem(model, e));
        fold_of.push_back(fold);
        if (widest.count(fold) == 0 || e.library.size() > experiments[widest[fold]].library.size()) widest[fold] = i;
        progress({"fitting emulators", static_cast<double>(i + 1), static_cast<double>(experiments.size()), "cases", 0.0, "", ""});
    }
    std::map<std::string, diagnosis::Thresholds> thresholds;
    std::string frozen;
    for (const auto& [fold, i] : widest) {
        const diagnosis::Attributor attributor(problems[i]);
        thresholds[fold] =
            diagnosis::recalibrate(attributor, problems[i].experiment.settings.recalibration_cases, problems[i].experiment.settings.seed, progress);
        frozen += fold + " " + diagnosis::thresholds_text(thresholds[fold]);
    }
    io::prepare_output_folder(folder / "verdicts");
    io::write_text(folder / "verdicts" / "thresholds.txt", frozen);  // before any case is judged
    std::vector<BlindVerdict> verdicts(problems.size());
    constexpr std::size_t portion = 8;
    for (std::size_t begin = 0; begin < problems.size(); begin += portion) {
        throw_if_interrupted();
        parallel_for(std::min(portion, problems.size() - begin), 1,
                     [&](std::size_t i) { verdicts[begin + i] = diagnosis::blind_verdict(problems[begin + i], thresholds[fold_of[begin + i]]); });
        progress({"judging", static_cast<double>(std::min(begin + portion, problems.size())), static_cast<double>(problems.size()), "cases", 0.0, "", ""});
    }
    printer.finish();
    io::write_text(folder / "verdicts" / "verdicts.json", Json(verdicts).dump(1) + "\n");
    io::write_text(folder / "verdicts" / "frozen.json",
                   Json{{"thresholds", io::sha256_of_text(frozen)}, {"verdicts", io::sha256_of_file(folder / "verdicts" / "verdicts.json")}}.dump(1) + "\n");
    print_written(folder / "verdicts", fmt::format("{} verdicts, thresholds and their hashes; {}", verdicts.size(), duration_text(stopwatch.seconds())));
}

std::string table_text(const diagnosis::BlindScore& score, int cases) {
    std::string text = fmt::format("| quantity | bar | {} cases | |\n| --- | --- | --- | --- |\n", cases);
    for (const auto& r : score.rows)
        text += fmt::format("| {} | {} | {} | {} |\n", r.quantity, r.bar, r.result,
                            !r.judged             ? "no case"
                            : r.bar == "(no bar)" ? ""
                            : r.reached           ? "reached"
                                                  : "**missed**");
    text += "\n| effect ranked first | bar region | all single effects |\n| --- | --- | --- |\n";
    for (const auto& [rule, share] : score.rules_all) {
        const auto bar = std::find_if(score.rules.begin(), score.rules.end(), [&rule = rule](const auto& one) { return one.first == rule; });
        text += fmt::format("| {} | {} | {:.0f} % ({}/{}) |\n", rule,
                            bar == score.rules.end() ? "" : fmt::format("{:.0f} % ({}/{})", 100 * bar->second.value, bar->second.hits, bar->second.count),
                            100 * share.value, share.hits, share.count);
    }
    text += "\n| kind of case | verdicts |\n| --- | --- |\n";
    for (const auto& [kind, counts] : score.verdicts) {
        text += "| " + kind + " | ";
        for (const auto& [verdict, count] : counts) text += fmt::format("{} {}  ", count, verdict);
        text += "|\n";
    }
    return text;
}

void score(const BlindOptions& o) {
    const fs::path folder = o.folder;
    const fs::path verdict_file = folder / "verdicts" / "verdicts.json";
    if (!fs::exists(verdict_file)) throw bad_input("there are no verdicts here", "run the cases first: pelletlab diagnose blind run", {folder.string()});
    const Json frozen = Json::parse(io::read_text(folder / "verdicts" / "frozen.json"));
    if (frozen.at("verdicts") != io::sha256_of_file(verdict_file) || frozen.at("thresholds") != io::sha256_of_file(folder / "verdicts" / "thresholds.txt"))
        throw bad_input("verdicts or thresholds were changed after they were frozen", "run the cases again", {folder.string()});
    {  // every unsealing leaves a line, whatever comes after
        std::ofstream log(folder / "sealed" / "unsealed.log", std::ios::app);
        log << "unsealed for verdicts " << frozen.at("verdicts").get<std::string>() << "\n";
        if (!log) throw bad_input("the unsealing cannot be logged", "make the folder writable", {(folder / "sealed").string()});
    }
    const Json hashes = Json::parse(io::read_text(folder / "public" / "hashes.json")), sealed = Json::parse(io::read_text(folder / "sealed" / "labels.json"));
    std::vector<BlindLabel> labels;
    for (const Json& one : sealed) {
        labels.push_back(one.at("label").get<BlindLabel>());
        if (hashes.value(labels.back().id, "") != seal_of(labels.back(), one.at("salt")))
            throw bad_input("the label of " + labels.back().id + " is not the one that was sealed", "make new cases", {folder.string()});
    }
    const auto verdicts = Json::parse(io::read_text(verdict_file)).get<std::vector<BlindVerdict>>();
    const std::string text = table_text(diagnosis::score_blind(labels, verdicts), static_cast<int>(labels.size()));
    const fs::path file = o.output.empty() ? folder / "score.md" : fs::path(o.output);
    io::write_text(file, text);
    print_line(text);
    print_written(file, "the score");
}

}  // namespace

void add_blind_verbs(CLI::App& diagnose) {
    auto options = std::make_shared<BlindOptions>();
    CLI::App* blind = diagnose.add_subcommand("blind", "Judge the diagnosis on runs of the campaign whose cause is sealed");
    blind->require_subcommand(1);
    blind->fallthrough();
    CLI::App* first = blind->add_subcommand(
        "make", "Draw cases, seal their labels\n  example: pelletlab diagnose blind make examples/diagnosis/experiment.toml -o out/blind --seed 7 --cases 20");
    first->add_option("experiment", options->experiment, "Names campaign, regions and settings; its measurements are not used")->required();
    first->add_option("-o,--output", options->folder, "Folder of the cases")->capture_default_str();
    first->add_option("--seed", options->seed, "Which cases")->capture_default_str();
    first->add_option("--avoid-seed", options->avoid, "Use no run that the set of this seed uses");
    first->add_option("--cases", options->cases, "How many, about")->capture_default_str()->check(CLI::Range(5, 100000));
    first->callback([options] { make(*options); });
    CLI::App* second = blind->add_subcommand("run", "Freeze thresholds, judge every case without its label\n  example: pelletlab diagnose blind run out/blind");
    second->add_option("folder", options->folder, "Folder of the cases")->required();
    second->callback([options] { run(*options); });
    CLI::App* third = blind->add_subcommand("score", "Open the labels and compare\n  example: pelletlab diagnose blind score out/blind");
    third->add_option("folder", options->folder, "Folder of the cases")->required();
    third->add_option("-o,--output", options->output, "Markdown file; score.md in the folder when not given");
    third->callback([options] { score(*options); });
}

}  // namespace pelletlab::apps
