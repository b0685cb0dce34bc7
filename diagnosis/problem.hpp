// A measurement against a campaign: the emulator, the operator from the campaign's outputs to the measured points, and the covariance of everything that may
// differ without meaning anything.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "campaign/assemble.hpp"
#include "core/experiment.hpp"
#include "inference/emulator.hpp"

namespace pelletlab::diagnosis {

/// One measured number in campaign units, and how the campaign's outputs make it.
struct DataPoint {
    int measurement = 0;  ///< index in Experiment::measurements
    int observable = 0;   ///< of the campaign
    double axis = 0.0;    ///< in the observable's axis unit; 0 for a single number
    double level = 0.0;   ///< regime level (or its index when regimes are words)
    std::string regime;
    int group = 0;  ///< observable × region × regime
    double value = 0.0, uncertainty = 0.0, offset_uncertainty = 0.0, tolerance = 0.0;
};

struct Group {
    std::string name, observable, region, regime;
    std::vector<int> points;
};

/// Data of one kind (fitted, or held out) with their linear operator.
struct DataSet {
    std::vector<DataPoint> points;
    std::vector<Group> groups;
    Eigen::MatrixXd from_outputs;   ///< points × campaign outputs
    Eigen::MatrixXd interpolation;  ///< points × outputs: quadratic minus linear interpolation between regimes; zero where the campaign has the regime
    Eigen::VectorXd value;
    Eigen::MatrixXd measurement_covariance, tolerance_covariance;
    bool empty() const { return points.empty(); }
};

/// Everything that does not depend on the measured values; shared by all cases of one campaign.
struct Model {
    Campaign campaign;         ///< without excluded points, with the library's effects only
    std::vector<int> library;  ///< campaign effect index of each library effect
    inference::Emulator emulator;
    Eigen::Index parameters() const { return campaign.parameter.cols(); }
    Eigen::Index effects() const { return static_cast<Eigen::Index>(library.size()); }
    const CampaignEffect& effect(int e) const {  ///< of the library, by its index there
        return campaign.description.effects[static_cast<std::size_t>(library[static_cast<std::size_t>(e)])];
    }
};

/// Selects the runs and fits the emulator. Throws Error(bad_input) for unknown effects.
std::shared_ptr<const Model> make_model(const Campaign& campaign, const std::vector<std::string>& library,
                                        const std::vector<std::vector<std::pair<std::string, double>>>& exclude, const std::string& file);

struct Problem {
    std::shared_ptr<const Model> model;
    Experiment experiment;
    DataSet fitted, held_out;
    std::vector<bool> is_calibration;  ///< of each fitted point: the laboratory calibrated on it
    Eigen::VectorXd phi_lower, phi_upper;
    std::vector<std::string> notes;  ///< of what was assumed or left out
};

/// Joins experiment and model: units converted, regimes found or interpolated, ranges of the calibration parameters taken over. Throws Error(bad_input) for a
/// unit that does not fit, an unknown observable, regime or parameter, a point outside the campaign's axis or regimes, data that are fitted and held out at
/// once, the same picture or the same data twice, fewer data than free parameters.
enum class FewData {
    refuse,  ///< a diagnosis asks what no set of parameters can explain: there must be more data than free parameters
    allow    ///< a calibration says what few data leave open
};
Problem make_problem(std::shared_ptr<const Model> model, const Experiment& experiment, FewData few = FewData::refuse);

/// Mean prediction at the data points of a set; θ has one element a library effect.
Eigen::VectorXd predict(const Model& model, const DataSet& data, const Eigen::VectorXd& phi, const Eigen::VectorXd& theta);

/// Σ of a set at (φ, θ): emulator (and one run's scatter if the settings say so), interpolation between regimes, measurement, tolerance floor.
Eigen::MatrixXd covariance(const Problem& problem, const DataSet& data, const Eigen::VectorXd& phi, const Eigen::VectorXd& theta);

/// Low-rank shapes that a gap may have when nobody knows its cause: for every observable offset, tilt and curvature along its axis, each also growing with the
/// regime. Columns scaled to root mean square 1 in units of the points' standard deviations `sigma`.
struct Distortions {
    Eigen::MatrixXd shapes;           ///< points × directions
    std::vector<std::string> family;  ///< of each direction: «surface: tilt»
};
Distortions generic_distortions(const Problem& problem, const Eigen::VectorXd& sigma);

}  // namespace pelletlab::diagnosis
