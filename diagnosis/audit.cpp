#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "diagnosis/audit_ranges.hpp"
#include "diagnosis/diagnose.hpp"

namespace pelletlab::diagnosis {

namespace {

/// Two measurements of one observable that differ nowhere by more than a third of their uncertainties: the same picture filed under two names?
bool suspiciously_alike(const Measurement& a, const Measurement& b) {
    if (a.observable != b.observable || a.regime == b.regime || a.axis != b.axis || a.axis.size() < 5) return false;
    for (std::size_t i = 0; i < a.value.size(); ++i)
        if (std::abs(a.value[i] - b.value[i]) > std::hypot(a.uncertainty[i], b.uncertainty[i]) / 3.0) return false;
    return true;
}

}  // namespace

std::vector<AuditItem> audit(const Problem& problem) {
    std::vector<AuditItem> items;
    const Campaign& c = problem.model->campaign;
    int runs = 0, failed = 0;
    std::string blocks;
    for (const CampaignBlock& b : c.blocks) {
        runs += b.runs;
        failed += b.failed;
        if (b.failed > 0) blocks += fmt::format("{}{} of {} in «{}»", blocks.empty() ? "" : ", ", b.failed, b.runs, b.name);
    }
    items.push_back({failed > 0, fmt::format("campaign: {} runs within the effects' ranges, {} failed or incomplete{}", runs, failed,
                                             blocks.empty() ? "" : " (" + blocks + ")")});
    items.push_back({false, fmt::format("used here: {} configurations of the library's effects, {} beyond the range of an effect", c.parameter.rows(),
                                        c.unused_out_of_range)});
    const auto& m = problem.experiment.measurements;
    for (std::size_t i = 0; i < m.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j)
            if (suspiciously_alike(m[i], m[j]))
                items.push_back({true, fmt::format("'{}' and '{}' agree within a third of their uncertainty everywhere: is one filed under the wrong regime?",
                                                   m[i].name, m[j].name)});
        if (m[i].repeats == 1) items.push_back({false, fmt::format("'{}': one repeat, so its uncertainty is a statement and not a measurement", m[i].name)});
        if (m[i].instrument.empty()) items.push_back({false, fmt::format("'{}' names no instrument: its offset is taken as its own", m[i].name)});
    }
    for (AuditItem& item : audit_ranges(problem)) items.push_back(std::move(item));
    int loose = 0;
    for (const DataPoint& p : problem.fitted.points) loose += p.uncertainty > p.tolerance ? 1 : 0;
    if (loose > 0)
        items.push_back({true, fmt::format("{} of {} data have an uncertainty larger than the tolerance: the measurement limits the answer", loose,
                                           problem.fitted.points.size())});
    for (const std::string& note : problem.notes) items.push_back({true, note});
    items.push_back({false,
                     "speed from the rigid layer, fill from the bed's area and the mass of a pellet were not checked: no velocity map, area or mass is among "
                     "the measurements"});
    return items;
}

}  // namespace pelletlab::diagnosis
