// A campaign: many runs of one simulation model, made here or elsewhere, as plain numbers. One row is one run: its calibration parameters, the amplitudes
// of the effects that were switched on in it, the regime (a speed, a rig) and what was measured in it.
#pragma once

#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/vec.hpp"

namespace pelletlab {

/// A quantity that a laboratory would calibrate. φ = 0 at `lower`, 1 at `upper`, in between linear in the value or in its logarithm.
struct CampaignParameter {
    std::string name, column, unit;
    double lower = 0.0, upper = 1.0;
    bool logarithmic = false;
};

/// Something that the baseline leaves out. θ = 0 is the baseline, |θ| = 1 the end of the plausible range: θ = s((value − baseline)/(full − baseline)),
/// s(u) = u or sign(u)·√|u|.
struct CampaignEffect {
    std::string name, title, column, unit;
    double baseline = 0.0, full = 1.0;
    bool square_root = false;
    bool two_sided = false;  ///< θ in [−1, 1] instead of [0, 1]
    std::string effect_class;
};

/// A number, or a profile along one axis; every element is a column of the table.
struct CampaignObservable {
    std::string name, unit, axis_name, axis_unit;
    std::vector<double> axis;  ///< in axis_unit, ascending; empty for a single number
    std::vector<std::string> columns;
    double tolerance = 0.0;  ///< difference that does not matter to anybody [unit]; the experiment may override it
};

struct CampaignRegime {
    std::string name;
    double level = 0.0;  ///< in regime_unit; NaN when regimes are words
};

/// Runs as read: one row a run and regime, in the units of the description; NaN where the field was empty.
struct CampaignTable {
    std::string name, source, file, sha256;  ///< file: the description; sha256 of description and table together
    std::string table_file;
    std::string regime_name, regime_unit;  ///< empty name: the campaign has one regime only
    std::vector<CampaignParameter> parameters;
    std::vector<CampaignEffect> effects;
    std::vector<CampaignObservable> observables;
    double largest_failed_share = 0.05;

    struct Row {
        int line = 0;
        std::string regime;
        double regime_level = 0.0;
        bool failed = false;                               ///< the status column says so
        std::vector<double> parameters, effects, outputs;  ///< outputs: the observables' columns one after the other
    };
    std::vector<Row> rows;
};

/// One output of a configuration: an element of an observable in a regime.
struct CampaignOutput {
    int regime = 0, observable = 0, element = 0;
};

/// Runs of one block (the effects that are switched on) and how many of them cannot be used.
struct CampaignBlock {
    std::string name;
    int runs = 0, failed = 0;
};

/// The campaign as the statistics see it: a row is one configuration with all its regimes.
struct Campaign {
    CampaignTable description;  ///< without rows
    std::vector<CampaignRegime> regimes;
    std::vector<CampaignOutput> outputs;
    Eigen::MatrixXd parameter;   ///< configurations × parameters, in units of the description
    Eigen::MatrixXd amplitude;   ///< configurations × effects: θ
    Eigen::MatrixXd output;      ///< configurations × outputs
    std::vector<int> point;      ///< configurations with equal parameters have equal numbers
    std::vector<int> replicate;  ///< configurations that differ in nothing have equal numbers
    std::vector<CampaignBlock> blocks;
    int unused_out_of_range = 0;  ///< configurations whose amplitude lies beyond |θ| = 1
};

}  // namespace pelletlab
