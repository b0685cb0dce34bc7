// What a laboratory measured, what may be calibrated, and what is asked: the input of a diagnosis.
#pragma once

#include <string>
#include <vector>

#include "core/campaign.hpp"
#include "core/error.hpp"
#include "core/observables.hpp"

namespace pelletlab {

enum class MeasurementRole {
    fit,          ///< the baseline and every hypothesis are fitted to it
    calibration,  ///< as fit; and it is the data that the laboratory calibrated on, so the miss of the rest is the transfer gap
    held_out      ///< only predicted
};

/// A number or a profile in one regime.
struct Measurement {
    std::string name, observable, regime;
    std::vector<double> axis;         ///< in axis_unit; empty for a single number
    std::vector<double> value;        ///< in unit; NaN where nothing was seen
    std::vector<double> uncertainty;  ///< standard error of the mean, point by point [unit]
    double offset_uncertainty = 0.0;  ///< common to all points of the instrument [unit]
    int repeats = 1;
    std::string unit, axis_unit, instrument, picture;
    double tolerance = not_known;  ///< [unit]; NaN: the observable's
    MeasurementRole role = MeasurementRole::fit;
    std::string data_sha256;
    Place place;
};

struct CalibrationParameter {
    std::string name;
    double lower = 0.0, upper = 0.0;  ///< in the campaign's unit
    bool fixed = false;               ///< lower = upper = the known value
    Place place;
};

/// Part of a profile, for «where».
struct Region {
    std::string observable, name;
    double lower = 0.0, upper = 0.0;  ///< on the axis, half open at the upper end
};

/// Something that could be measured next.
struct Candidate {
    std::string name;
    double cost = 1.0;         ///< relative
    std::string observable;    ///< of a new regime or profile; empty for a direct measurement
    std::string regime;        ///< a regime of the campaign
    std::string direct;        ///< effect or parameter that is measured directly
    double uncertainty = 0.0;  ///< [unit of the observable, effect or parameter]
    Place place;
};

struct DiagnosisSettings {
    std::uint64_t seed = 1;
    int bootstrap = 1000;
    int recalibration_cases = 120;
    bool scatter_of_one_run = false;  ///< the reality scatters like a single run of the campaign, on top of the stated uncertainties
    double tolerance_correlation = 0.5;
    double false_discovery_rate = 0.05;
};

struct Experiment {
    std::string name, file, text_sha256;
    std::string campaign_file;
    std::vector<std::string> library;                                  ///< effects that may explain a gap; empty: all of the campaign
    std::vector<std::vector<std::pair<std::string, double>>> exclude;  ///< parameter values: runs at these points are not used
    std::vector<std::string> suspects;                                 ///< effects whose prior is raised threefold
    std::vector<CalibrationParameter> parameters;
    std::vector<Measurement> measurements;
    std::vector<Region> regions;
    std::vector<Candidate> candidates;
    DiagnosisSettings settings;
};

}  // namespace pelletlab
