#include "io/detail/campaign_quantities.hpp"

#include <tuple>

namespace pelletlab::io::detail {

CampaignParameter read_campaign_parameter(TomlTable& t) {
    CampaignParameter p;
    p.name = p.column = t.text("name");
    p.unit = t.unit("unit", "1");
    std::tie(p.lower, p.upper) = t.range("range", "write range = [0.1, 1.0]");
    p.logarithmic = t.choice("scale", "linear", {"linear", "log"}) == "log";
    if (p.logarithmic && p.lower <= 0.0) throw t.problem("range", "must be positive on a logarithmic scale", "use scale = \"linear\"");
    return p;
}

CampaignEffect read_campaign_effect(TomlTable& t) {
    CampaignEffect e;
    e.name = e.column = t.text("name");
    e.title = t.text("title", e.name);
    e.unit = t.unit("unit", "1");
    e.baseline = t.number("baseline");
    e.full = t.number("full");
    if (e.full == e.baseline) throw t.problem("full", "equals the baseline", "full is the value at the end of the plausible range");
    e.square_root = t.choice("scale", "linear", {"linear", "sqrt"}) == "sqrt";
    e.two_sided = t.flag("two_sided", false);
    e.effect_class = t.choice("class", "contact", {"boundary", "contact", "particle", "environment", "operation", "measurement", "numerical"});
    return e;
}

}  // namespace pelletlab::io::detail
