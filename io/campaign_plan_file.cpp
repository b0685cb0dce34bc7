#include "io/campaign_plan_file.hpp"

#include <algorithm>
#include <tuple>

#include "core/observables.hpp"
#include "io/detail/campaign_quantities.hpp"
#include "io/files.hpp"

namespace pelletlab::io {

namespace {

using detail::TomlTable;

std::vector<std::string> read_keys(TomlTable& t) {
    const auto keys = t.texts("keys");
    if (keys.empty()) throw t.problem("keys", "is missing", "name the case keys that take the value: keys = [\"contacts.pellet-pellet.sliding_friction\"]");
    return keys;
}

void refuse_known(TomlTable& t, const std::string& name, std::vector<std::string>& known) {
    if (std::find(known.begin(), known.end(), name) != known.end()) throw t.problem("name", "'" + name + "' stands twice", "rename one");
    known.push_back(name);
}

CampaignEffect read_library_effect(TomlTable& t) {
    CampaignEffect e;
    e.name = e.column = t.text("name");
    e.title = t.text("title", "");
    e.full = t.number("full", not_known);
    if (e.full == 0.0) throw t.problem("full", "equals the baseline", "full is the value at the end of the plausible range");
    e.square_root = t.choice("scale", "linear", {"linear", "sqrt"}) == "sqrt";
    return e;
}

}  // namespace

CampaignPlan read_campaign_plan(const std::filesystem::path& file) {
    const std::string text = read_text(file);
    const toml::table toml = detail::parse_toml(text, file.string());
    TomlTable t(toml, file.string(), "");
    CampaignPlan plan;
    plan.file = file.string();
    plan.text_sha256 = sha256_of_text(text);
    plan.name = t.text("name", file.stem().string());
    plan.seed = static_cast<std::uint64_t>(t.whole("seed", 1, 1, 1000000));
    plan.largest_failed_share = t.number("largest_failed_share", 0.05);
    if (t.has("good")) plan.good = t.texts("good");
    std::vector<std::string> names, rigs;
    t.each("rig", [&](TomlTable& one) {
        PlannedRig rig{one.text("name"), one.text("case"), one.texts("set"), one.place("case")};
        refuse_known(one, rig.name, rigs);
        plan.rigs.push_back(rig);
    });
    t.each("parameter", [&](TomlTable& one) {
        plan.parameters.push_back(detail::read_campaign_parameter(one));
        refuse_known(one, plan.parameters.back().name, names);
        plan.parameter_keys.push_back(read_keys(one));
    });
    t.each("effect", [&](TomlTable& one) {
        // Without keys it is one of the library, which knows what is not given here.
        const bool from_library = !one.has("keys");
        plan.effects.push_back(from_library ? read_library_effect(one) : detail::read_campaign_effect(one));
        refuse_known(one, plan.effects.back().name, names);
        plan.effect_keys.push_back(from_library ? std::vector<std::string>{} : read_keys(one));
        plan.effect_kinds.push_back(from_library ? PlannedEffectKind::library_case : PlannedEffectKind::case_keys);
        plan.effect_levels.emplace_back();
        plan.effect_places.push_back(one.place("name"));
    });
    t.each("observable", [&](TomlTable& one) {
        PlannedObservable o;
        o.name = one.text("name");
        o.tolerance = one.number("tolerance");
        if (o.tolerance <= 0.0)
            throw one.problem("tolerance", "must be positive", "write the difference that does not matter to you, in the observable's unit");
        if (const auto range = one.range_if_any("axis_range", "write axis_range = [-30, 30]")) std::tie(o.axis_lower, o.axis_upper) = *range;
        plan.observables.push_back(o);
    });
    if (auto design = t.table("design")) {
        plan.points = design->whole("points", 0, 0, 100000);
        plan.runs_an_effect = design->whole("runs_an_effect", plan.runs_an_effect, 2, 100000);
        plan.anchors = design->whole("anchors", plan.anchors, 0, 100000);
        plan.repeats = design->whole("repeats", plan.repeats, 1, 1000);
        design->finish();
    }
    t.finish();
    if (plan.rigs.empty()) throw bad_input("the plan has no [[rig]]", "name at least one case", {plan.file});
    if (plan.parameters.empty()) throw bad_input("the plan has no [[parameter]]", "name what is to be calibrated", {plan.file});
    if (plan.observables.empty()) throw bad_input("the plan has no [[observable]]", "name what the runs measure (docs/observables.md)", {plan.file});
    return plan;
}

}  // namespace pelletlab::io
