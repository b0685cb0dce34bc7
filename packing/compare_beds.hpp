// Beds that were simulated against beds that were measured: one judgement a fill and a shape, with intervals and in words.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/measured_fill.hpp"
#include "inference/mean_comparison.hpp"

namespace pelletlab::packing {

/// One run: a bed at rest (or not).
struct SimulatedBed {
    std::string folder;
    std::string shape;  ///< name of the clump, «pellet82»
    double spheres = 0.0;
    double pellets = 0.0;
    double pellet_mass = 0.0;    ///< [kg]
    double pellet_volume = 0.0;  ///< [m³], of the true body
    double tube_diameter = 0.0;  ///< [m]
    double height = 0.0;         ///< [m], by the definition asked for
    std::uint64_t seed = 0;
    bool at_rest = true;
};

struct ComparisonSettings {
    double relative_margin = 0.02;  ///< a difference below this share of the measured height does not matter to the user
    double level = 0.05;
};

/// The check that goes before any comparison: what a pellet weighs by the laboratory's own figures against the simulated one.
struct MassCheck {
    double measured = 0.0, simulated = 0.0;  ///< [kg] a pellet
    double deviation() const { return measured / simulated - 1.0; }
};

/// Two beds of one number of pellets; the second is the reference that percentages are of.
struct BedComparison {
    std::string first, second;  ///< names of shapes; `second` is «measured» for a measured fill
    double pellets = 0.0;
    inference::Repeats first_height, second_height;  ///< [m]
    inference::MeanDifference difference;            ///< first − second [m]
    inference::Equivalence equivalence;
    inference::Agreement agreement = inference::Agreement::undecided;
    std::string words;  ///< «the simulated height differs: 4.1 % lower (−5.3 to −2.9 %)»
};

struct BedReport {
    std::vector<MassCheck> mass_checks;  ///< one a fill that states both mass and number
    std::vector<BedComparison> against_measurement;
    std::vector<BedComparison> between_shapes;
    std::vector<std::string> left_out;  ///< runs that did not come to rest, fills nobody simulated, …
};

/// Matches fills by number of pellets (by mass over the simulated pellet mass, rounded, where no number is stated), pools seeds of one shape, and judges.
/// Throws Error(bad_input) when nothing can be compared, when runs of one fill have different tubes or the same seed twice.
BedReport compare_beds(const std::vector<SimulatedBed>& beds, const std::vector<MeasuredFill>& fills, const ComparisonSettings& settings = {});

}  // namespace pelletlab::packing
