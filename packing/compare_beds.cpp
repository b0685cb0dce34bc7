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

}  // namespace

std::string words_of(const inference::MeanDifference& d, const inference::Equivalence& e, Agreement agreement, double reference, int needed,
                     const std::string& subject) {
    const std::string size = fmt::format("{} {} ({:.1f} to {:.1f} %)", percent(std::abs(d.value) / reference), d.value < 0.0 ? "lower" : "higher",
                                         100.0 * d.lower / reference, 100.0 * d.upper / reference);
    const std::string margin = percent(e.margin / reference);
    switch (agreement) {
        case Agreement::equivalent:
            return fmt::format("{} agrees within {}: {}", subject, margin, size);
        case Agreement::differs:
            return fmt::format("{} differs: {}", subject, size);
        case Agreement::undecided:
            break;
    }
    return fmt::format(
        "{} cannot be told apart from a match within {}, nor from a miss: {}; {}", subject, margin, size,
        needed > 0 ? fmt::format("about {} repeats on each side would tell", needed) : "it lies at the margin's edge, where no number of repeats would tell");
}

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
            BedComparison c;
            c.shape = shape;
            c.pellets = pellets;
            c.simulated = inference::repeats_of(pool.heights);
            c.measured = {fill.height, fill.deviation, fill.repeats};
            if (c.simulated.count < 2 && c.measured.count < 2) {
                report.left_out.push_back(fmt::format("{}, {:.0f} pellets: neither side has repeats, so no interval can be given", shape, pellets));
                continue;
            }
            c.difference = inference::mean_difference(c.simulated, c.measured, 1.0 - settings.level);
            c.equivalence = inference::test_equivalence(c.difference, settings.relative_margin * c.measured.mean, settings.level);
            c.agreement = inference::agreement_of(c.difference, c.equivalence, settings.level);
            c.repeats_needed = inference::repeats_needed(c.difference, c.simulated, c.measured, c.equivalence.margin, settings.level);
            c.words = words_of(c.difference, c.equivalence, c.agreement, c.measured.mean, c.repeats_needed, "the simulated height");
            report.against_measurement.push_back(c);
        }
    }
    for (const auto& [pellets, shapes] : pools)
        for (auto a = shapes.begin(); a != shapes.end(); ++a)
            for (auto b = std::next(a); b != shapes.end(); ++b) {
                ShapeComparison c;
                c.one = a->first;
                c.other = b->first;
                c.pellets = pellets;
                const auto ra = c.first = inference::repeats_of(a->second.heights), rb = c.second = inference::repeats_of(b->second.heights);
                if (ra.count < 2 && rb.count < 2) continue;
                c.difference = inference::mean_difference(ra, rb, 1.0 - settings.level);
                c.equivalence = inference::test_equivalence(c.difference, settings.relative_margin * rb.mean, settings.level);
                c.agreement = inference::agreement_of(c.difference, c.equivalence, settings.level);
                const int needed = inference::repeats_needed(c.difference, ra, rb, c.equivalence.margin, settings.level);
                c.words = words_of(c.difference, c.equivalence, c.agreement, rb.mean, needed, c.one);
                report.between_shapes.push_back(c);
            }
    if (report.against_measurement.empty() && report.between_shapes.empty())
        throw bad_input(
            "nothing can be compared: " + (report.left_out.empty() ? std::string("one shape, no measurement and no second shape") : report.left_out[0]),
            "give at least two runs (--seed) of a fill that was measured, or of two shapes");
    return report;
}

}  // namespace pelletlab::packing
