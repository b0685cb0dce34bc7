#include "packing/compare_beds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/error.hpp"

namespace pelletlab::packing {

namespace {

using inference::Agreement;

struct Pool {
    std::vector<double> heights;
    std::set<std::uint64_t> seeds;
};

/// Number of pellets of a fill in terms of the simulated ones.
double pellets_of(const MeasuredFill& fill, double pellet_mass) {
    return fill.pellets > 0.0 ? fill.pellets : std::round(fill.mass / pellet_mass);
}

std::string percent(double share) {
    return fmt::format("{:.1f} %", 100.0 * share);
}

/// The verdict with size and interval in percent of the second bed.
std::string words_of(const BedComparison& c, int repeats_needed, const std::string& subject) {
    const inference::MeanDifference& d = c.difference;
    const double reference = c.second_height.mean;
    const std::string size = fmt::format("{} {} ({:.1f} to {:.1f} %)", percent(std::abs(d.value) / reference), d.value < 0.0 ? "lower" : "higher",
                                         100.0 * d.lower / reference, 100.0 * d.upper / reference);
    const std::string margin = percent(c.equivalence.margin / reference);
    switch (c.agreement) {
        case Agreement::equivalent:
            return fmt::format("{} agrees within {}: {}", subject, margin, size);
        case Agreement::differs:
            return fmt::format("{} differs: {}", subject, size);
        case Agreement::undecided:
            break;
    }
    return fmt::format("{} cannot be told apart from a match within {}, nor from a miss: {}; {}", subject, margin, size,
                       repeats_needed > 0 ? fmt::format("about {} repeats on each side would tell", repeats_needed)
                                          : "it lies at the margin's edge, where no number of repeats would tell");
}

/// Judges c.first_height against c.second_height.
BedComparison judged(BedComparison c, const ComparisonSettings& settings, const std::string& subject) {
    c.difference = inference::mean_difference(c.first_height, c.second_height, 1.0 - settings.level);
    c.equivalence = inference::test_equivalence(c.difference, settings.relative_margin * c.second_height.mean, settings.level);
    c.agreement = inference::agreement_of(c.difference, c.equivalence, settings.level);
    c.words = words_of(c, inference::repeats_needed(c.difference, c.first_height, c.second_height, c.equivalence.margin, settings.level), subject);
    return c;
}

}  // namespace

BedReport compare_beds(const std::vector<SimulatedBed>& beds, const std::vector<MeasuredFill>& fills, const ComparisonSettings& settings) {
    if (beds.empty()) throw bad_input("there is no run to compare", "name the result folders of pelletlab fill");
    BedReport report;
    std::map<double, std::map<std::string, Pool>> pools;
    for (const SimulatedBed& bed : beds) {
        if (std::abs(bed.tube_diameter - beds[0].tube_diameter) > 1e-6 * beds[0].tube_diameter)
            throw bad_input(fmt::format("{} has a tube of {:.4g} mm, {} one of {:.4g} mm", bed.folder, 1e3 * bed.tube_diameter, beds[0].folder,
                                        1e3 * beds[0].tube_diameter),
                            "compare runs of one tube at a time", {bed.folder});
        if (!bed.at_rest) {
            report.left_out.push_back(bed.folder + ": the bed did not come to rest");
            continue;
        }
        Pool& pool = pools[bed.pellets][bed.shape];
        if (!pool.seeds.insert(bed.seed).second)
            throw bad_input(fmt::format("{} repeats seed {} of the same shape and number: that is the same bed, not a repeat", bed.folder, bed.seed),
                            "run it with --seed, or leave it out", {bed.folder});
        pool.heights.push_back(bed.height);
    }
    const double pellet_mass = beds[0].pellet_mass;
    for (const MeasuredFill& fill : fills) {
        if (fill.pellets > 0.0 && fill.mass > 0.0) report.mass_checks.push_back({fill.mass / fill.pellets, pellet_mass});
        const double pellets = pellets_of(fill, pellet_mass);
        const auto found = pools.find(pellets);
        if (found == pools.end()) {
            report.left_out.push_back(fmt::format("measured fill of {:.0f} pellets: nobody simulated it", pellets));
            continue;
        }
        for (const auto& [shape, pool] : found->second) {
            const BedComparison c{shape, "measured", pellets, inference::repeats_of(pool.heights), {fill.height, fill.deviation, fill.repeats}, {}, {}, {}, {}};
            if (c.first_height.count < 2 && c.second_height.count < 2)
                report.left_out.push_back(fmt::format("{}, {:.0f} pellets: neither side has repeats, so no interval can be given", shape, pellets));
            else
                report.against_measurement.push_back(judged(c, settings, "the simulated height"));
        }
    }
    for (const auto& [pellets, shapes] : pools)
        for (auto a = shapes.begin(); a != shapes.end(); ++a)
            for (auto b = std::next(a); b != shapes.end(); ++b) {
                const BedComparison c{a->first, b->first, pellets, inference::repeats_of(a->second.heights), inference::repeats_of(b->second.heights), {},
                                      {},       {},       {}};
                if (c.first_height.count < 2 && c.second_height.count < 2) continue;
                report.between_shapes.push_back(judged(c, settings, c.first));
            }
    if (report.against_measurement.empty() && report.between_shapes.empty())
        throw bad_input(
            "nothing can be compared: " + (report.left_out.empty() ? std::string("one shape, no measurement and no second shape") : report.left_out[0]),
            "give at least two runs (--seed) of a fill that was measured, or of two shapes");
    return report;
}

}  // namespace pelletlab::packing
