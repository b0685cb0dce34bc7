#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "diagnosis/blind.hpp"

namespace pelletlab::diagnosis {

namespace {

bool contains(const std::vector<std::string>& list, const std::string& word) {
    return std::find(list.begin(), list.end(), word) != list.end();
}

std::vector<std::string> ranked(const std::map<std::string, double>& inclusion) {
    std::vector<std::pair<double, std::string>> order;
    for (const auto& [name, p] : inclusion) order.emplace_back(-p, name);
    std::sort(order.begin(), order.end());
    std::vector<std::string> names;
    for (const auto& [p, name] : order) names.push_back(name);
    return names;
}

/// The hypothesis name of a set of effects in the library's order, whatever the order of the label.
bool in_set(const std::vector<std::string>& set, const std::vector<std::string>& effects) {
    if (effects.empty()) return contains(set, "parameters only");
    if (effects.size() == 1) return contains(set, effects[0]);
    return contains(set, effects[0] + " + " + effects[1]) || contains(set, effects[1] + " + " + effects[0]);
}

std::string text_of(const inference::Share& s) {
    return s.count == 0 ? "no case" : fmt::format("{:.0f} % ({}/{}; {:.0f}–{:.0f} %)", 100 * s.value, s.hits, s.count, 100 * s.lower, 100 * s.upper);
}

bool claims(const BlindVerdict& v) {
    return v.verdict == "EFFECT" || v.verdict == "EFFECTS";
}

struct Counter {
    int hits = 0, count = 0;
    void add(bool hit) {
        ++count;
        hits += hit ? 1 : 0;
    }
    inference::Share share() const { return inference::share_of(hits, count); }
};

}  // namespace

BlindScore score_blind(const std::vector<BlindLabel>& labels, const std::vector<BlindVerdict>& verdicts) {
    std::map<std::string, const BlindVerdict*> by_id;
    for (const BlindVerdict& v : verdicts) by_id[v.id] = &v;
    Counter false_alarm, first, second, first_all, covered, spurious, outside_said, outside_wrong, false_outside, both, one_of_two, right_region,
        right_measured, claimed_right, null_structural;
    int discoveries = 0, false_discoveries = 0, measured = 0, false_measured = 0;
    std::vector<double> probability;
    std::vector<bool> truth;
    double set_size = 0.0;
    int set_count = 0;
    std::map<std::string, Counter> rules, rules_all;
    std::map<std::string, std::map<std::string, int>> table;
    for (const BlindLabel& label : labels) {
        const auto found = by_id.find(label.id);
        if (found == by_id.end()) throw bad_input("there is no verdict for " + label.id, "run all cases: pelletlab diagnose blind run");
        const BlindVerdict& v = *found->second;
        ++table[label.kind][v.verdict];
        const auto order = ranked(v.inclusion);
        const bool bar = label.detectability >= 25.0 && label.separability >= 16.0;
        if (label.kind == "null") {
            false_alarm.add(claims(v));
            null_structural.add(v.verdict != "NO-GAP" && v.verdict != "UNDERPOWERED" && v.verdict != "AMBIGUOUS-CALIBRATION");
        }
        if (label.kind == "single" || label.kind == "reduced") {
            const std::string& right = label.effects[0];
            first_all.add(order[0] == right);
            covered.add(in_set(v.credible_set, label.effects));
            spurious.add(v.verdict == "EFFECTS");
            false_outside.add(v.verdict == "OUTSIDE-LIBRARY");
            if (claims(v)) claimed_right.add(contains(v.named, right));
            rules_all["random"].count += 1;
            for (const auto& [rule, list] : v.rules) rules_all[rule].add(!list.empty() && list[0] == right);
            if (bar) {
                first.add(order[0] == right);
                second.add(order[0] == right || (order.size() > 1 && order[1] == right));
                set_size += static_cast<double>(v.credible_set.size());
                ++set_count;
                for (const auto& [rule, list] : v.rules) rules[rule].add(!list.empty() && list[0] == right);
            }
        }
        if (label.kind != "outside") {
            for (const auto& [name, p] : v.inclusion) {
                probability.push_back(p);
                truth.push_back(contains(label.effects, name));
            }
            if (!label.effects.empty() && !label.regions.empty()) {
                right_region.add(contains(v.discoveries, label.regions[0]));
                right_measured.add(contains(v.measured_discoveries, label.regions[0]));
            }
        }
        const auto is_false = [&label](const std::string& group) { return label.effects.empty() || contains(label.silent, group); };
        discoveries += static_cast<int>(v.discoveries.size());
        false_discoveries += static_cast<int>(std::count_if(v.discoveries.begin(), v.discoveries.end(), is_false));
        measured += static_cast<int>(v.measured_discoveries.size());
        false_measured += static_cast<int>(std::count_if(v.measured_discoveries.begin(), v.measured_discoveries.end(), is_false));
        if (label.kind == "pair" && label.detectability >= 36.0 && label.separability >= 36.0) {
            both.add(v.verdict == "EFFECTS" && contains(v.named, label.effects[0]) && contains(v.named, label.effects[1]));
            one_of_two.add(order[0] == label.effects[0] || order[0] == label.effects[1]);
        }
        if (label.kind == "outside" && label.separability >= 36.0) {
            outside_said.add(v.verdict == "OUTSIDE-LIBRARY");
            outside_wrong.add(claims(v));
        }
    }
    BlindScore score;
    const auto row = [&](const std::string& quantity, const std::string& bar, const Counter& c, double low, double high) {
        const inference::Share s = c.share();
        score.rows.push_back({quantity, bar, text_of(s), s.value >= low - 1e-12 && s.value <= high + 1e-12, s.count > 0});
    };
    row("false alarm on nulls (an effect claimed)", "≤ 5 %", false_alarm, 0.0, 0.05);
    row("nulls called structural (SET or OUTSIDE too)", "≤ 10 %", null_structural, 0.0, 0.10);
    row("single effect ranked first, bar region", "≥ 90 %", first, 0.90, 1.0);
    row("single effect in the first two, bar region", "≥ 97 %", second, 0.97, 1.0);
    row("single effect ranked first, all amplitudes", "(no bar)", first_all, 0.0, 1.0);
    row("named effect is right, when a single effect is claimed", "(no bar)", claimed_right, 0.0, 1.0);
    row("truth inside the 90 % set, all singles", "85–97 %", covered, 0.85, 0.97);
    score.rows.push_back({"mean size of the 90 % set, bar region", "≤ 2", set_count == 0 ? "no case" : fmt::format("{:.2f}", set_size / set_count),
                          set_size <= 2.0 * set_count, set_count > 0});
    row("spurious second effect claimed", "≤ 5 %", spurious, 0.0, 0.05);
    row("outside the library (λ ≥ 36): said so", "≥ 90 %", outside_said, 0.90, 1.0);
    row("outside the library (λ ≥ 36): a wrong effect claimed", "≤ 5 %", outside_wrong, 0.0, 0.05);
    row("false OUTSIDE on library cases", "≤ 5 %", false_outside, 0.0, 0.05);
    row("two effects (λ ≥ 36): both claimed", "≥ 70 %", both, 0.70, 1.0);
    row("two effects (λ ≥ 36): one of them ranked first", "≥ 95 %", one_of_two, 0.95, 1.0);
    row("group with the largest true shift among the discoveries", "≥ 90 %", right_region, 0.90, 1.0);
    const auto rate_row = [&](const std::string& quantity, const std::string& bar, int wrong, int all) {
        const inference::Share s = inference::share_of(wrong, all);
        score.rows.push_back({quantity, bar, text_of(s), s.value <= 0.10, all > 0});
    };
    rate_row("false discoveries among the groups found", "≤ 10 %", false_discoveries, discoveries);
    row("… the same, groups found by their own data alone: largest shift found", "(no bar)", right_measured, 0.0, 1.0);
    rate_row("… false discoveries among them", "≤ 10 %", false_measured, measured);
    const auto calibration = inference::calibration_score(probability, truth);
    score.rows.push_back(
        {"calibration of P(effect): ECE, 10 bins", "≤ 0.05", fmt::format("{:.3f}", calibration.expected_error), calibration.expected_error <= 0.05, true});
    score.rows.push_back({"Brier score against half of climatology", fmt::format("≤ {:.3f}", 0.5 * calibration.climatology_brier),
                          fmt::format("{:.3f}", calibration.brier), calibration.brier <= 0.5 * calibration.climatology_brier, true});
    score.rules.emplace_back("PelletLab", first.share());
    score.rules_all.emplace_back("PelletLab", first_all.share());
    for (const auto& [rule, c] : rules) score.rules.emplace_back(rule, c.share());
    for (const auto& [rule, c] : rules_all)
        if (rule != "random") score.rules_all.emplace_back(rule, c.share());
    for (const auto& [kind, counts] : table) score.verdicts.emplace_back(kind, counts);
    return score;
}

}  // namespace pelletlab::diagnosis
