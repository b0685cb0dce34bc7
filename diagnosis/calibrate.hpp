// Calibration with what it cannot know: the posterior of the parameters given the measurements, and a plain statement of what the data leave open.
#pragma once

#include <string>
#include <vector>

#include "diagnosis/attribute.hpp"

namespace pelletlab::diagnosis {

struct CalibratedParameter {
    std::string name, unit;
    double prior_lower = 0.0, prior_upper = 0.0;              ///< range it was allowed [unit]
    double best = 0.0, mean = 0.0, lower = 0.0, upper = 0.0;  ///< mode; posterior mean and 90 % interval [unit]
    double narrowed = 1.0;                                    ///< posterior over prior standard deviation of φ: 1 means that the data say nothing
    std::vector<double> profile_value, profile_chi2;          ///< smallest χ² over the other parameters, above the best; value in unit
};

/// A combination of parameters that the data leave open: posterior standard deviation along it at least half of the prior's.
struct OpenDirection {
    std::string text;        ///< «0.9 sliding − 0.4 rolling»
    double deviation = 0.0;  ///< posterior over prior
};

/// What another measurement of the campaign's observables would add: ½ log det(1 + S / σ²) nats, S the spread of its prediction over the posterior, σ the
/// observable's tolerance halved with one run's scatter.
struct NextMeasurement {
    std::string observable, regime;
    double information = 0.0;
};

struct Calibration {
    std::vector<CalibratedParameter> parameters;
    Eigen::MatrixXd correlation;         ///< of the posterior, in φ
    std::vector<OpenDirection> open;     ///< most open first
    std::vector<Eigen::VectorXd> draws;  ///< equally weighted, values in the parameters' units
    double chi2 = 0.0;
    int data = 0;
    double adequacy_p = 1.0;  ///< small: no set of parameters describes the data
    std::string misfit;       ///< which family of misfits, when small
    double effective_samples = 0.0;
    std::vector<NextMeasurement> next;  ///< most informative first
};

/// Effects stay at their baseline. Throws Error(bad_input) as make_problem does.
Calibration calibrate(const Attributor& attributor);

}  // namespace pelletlab::diagnosis
