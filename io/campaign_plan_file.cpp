#include "io/campaign_plan_file.hpp"

#include <algorithm>

#include "core/units.hpp"
#include "io/detail/toml_table.hpp"
#include "io/files.hpp"

namespace pelletlab::io {

namespace {

using detail::TomlTable;

std::string read_unit(TomlTable& t) {
    const std::string unit = t.text("unit", "1");
    try {
        if (unit != "1") unit_dimension(unit);
    } catch (const Error& error) {
        throw bad_input(error.problem(), error.remedy(), t.place("unit"));
    }
    return unit;
}

std::vector<std::string> read_keys(TomlTable& t) {
    const auto keys = t.texts("keys");
    if (keys.empty()) throw t.problem("keys", "is missing", "name the case keys that take the value: keys = [\"contacts.pellet-pellet.sliding_friction\"]");
    return keys;
}

void refuse_known(TomlTable& t, const std::string& name, std::vector<std::string>& known) {
    if (std::find(known.begin(), known.end(), name) != known.end()) throw t.problem("name", "'" + name + "' stands twice", "rename one");
    known.push_back(name);
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
        CampaignParameter p;
        p.name = p.column = one.text("name");
        refuse_known(one, p.name, names);
        p.unit = read_unit(one);
        const auto range = one.numbers("range");
        if (!range || range->size() != 2 || !((*range)[0] < (*range)[1]))
            throw one.problem("range", "must be two ascending numbers", "write range = [0.1, 1.0]");
        p.lower = (*range)[0];
        p.upper = (*range)[1];
        p.logarithmic = one.choice("scale", "linear", {"linear", "log"}) == "log";
        if (p.logarithmic && p.lower <= 0.0) throw one.problem("range", "must be positive on a logarithmic scale", "use scale = \"linear\"");
        plan.parameters.push_back(p);
        plan.parameter_keys.push_back(read_keys(one));
    });
    t.each("effect", [&](TomlTable& one) {
        CampaignEffect e;
        e.name = e.column = one.text("name");
        refuse_known(one, e.name, names);
        e.title = one.text("title", e.name);
        e.unit = read_unit(one);
        e.baseline = one.number("baseline");
        e.full = one.number("full");
        if (e.full == e.baseline) throw one.problem("full", "equals the baseline", "full is the value at the end of the plausible range");
        e.square_root = one.choice("scale", "linear", {"linear", "sqrt"}) == "sqrt";
        e.two_sided = one.flag("two_sided", false);
        e.effect_class = one.choice("class", "contact", {"boundary", "contact", "particle", "environment", "operation", "measurement", "numerical"});
        plan.effects.push_back(e);
        plan.effect_keys.push_back(read_keys(one));
    });
    t.each("observable", [&](TomlTable& one) {
        PlannedObservable o;
        o.name = one.text("name");
        o.tolerance = one.number("tolerance");
        if (o.tolerance <= 0.0)
            throw one.problem("tolerance", "must be positive", "write the difference that does not matter to you, in the observable's unit");
        if (const auto range = one.numbers("axis_range")) {
            if (range->size() != 2 || !((*range)[0] < (*range)[1]))
                throw one.problem("axis_range", "must be two ascending numbers", "write axis_range = [-30, 30]");
            o.axis_lower = (*range)[0];
            o.axis_upper = (*range)[1];
        }
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
