#include <algorithm>
#include <cmath>

#include "diagnosis/problem.hpp"

namespace pelletlab::diagnosis {

namespace {

std::vector<int> library_indices(const Campaign& campaign, const std::vector<std::string>& library, const std::string& file) {
    const auto& effects = campaign.description.effects;
    std::vector<int> indices;
    if (library.empty())
        for (std::size_t k = 0; k < effects.size(); ++k) indices.push_back(static_cast<int>(k));
    for (const std::string& name : library) {
        const auto found = std::find_if(effects.begin(), effects.end(), [&](const CampaignEffect& e) { return e.name == name; });
        if (found == effects.end()) {
            std::vector<std::string> names;
            for (const auto& e : effects) names.push_back(e.name);
            const std::string guess = closest_word(name, names);
            std::string list;
            for (const auto& n : names) list += (list.empty() ? "" : ", ") + n;
            throw bad_input("the library names '" + name + "', which is no effect of the campaign",
                            guess.empty() ? "effects of the campaign: " + list : "did you mean '" + guess + "'?", {file});
        }
        const int index = static_cast<int>(found - effects.begin());
        if (std::find(indices.begin(), indices.end(), index) != indices.end()) throw bad_input("the library names '" + name + "' twice", "remove one", {file});
        indices.push_back(index);
    }
    return indices;
}

}  // namespace

std::shared_ptr<const Model> make_model(const Campaign& campaign, const std::vector<std::string>& library,
                                        const std::vector<std::vector<std::pair<std::string, double>>>& exclude, const std::string& file) {
    auto model = std::make_shared<Model>();
    model->library = library_indices(campaign, library, file);
    const Campaign allowed = campaign::without_points(campaign, exclude, file);
    model->campaign = campaign::subset(allowed, campaign::configurations_with(allowed, model->library, 2));
    const Campaign& c = model->campaign;
    inference::TrainingRuns runs;
    runs.inputs.phi.resize(c.parameter.rows(), c.parameter.cols());
    for (Eigen::Index i = 0; i < c.parameter.rows(); ++i)
        for (Eigen::Index j = 0; j < c.parameter.cols(); ++j)
            runs.inputs.phi(i, j) = campaign::unit_coordinate(c.description.parameters[static_cast<std::size_t>(j)], c.parameter(i, j));
    runs.inputs.theta = c.amplitude(Eigen::all, model->library);
    runs.output = c.output;
    runs.point = c.point;
    Eigen::VectorXd weight(c.output.cols());
    for (Eigen::Index j = 0; j < weight.size(); ++j)
        weight[j] = 1.0 / c.description.observables[static_cast<std::size_t>(c.outputs[static_cast<std::size_t>(j)].observable)].tolerance;
    model->emulator = inference::Emulator(runs, weight);
    return model;
}

Eigen::VectorXd predict(const Model& model, const DataSet& data, const Eigen::VectorXd& phi, const Eigen::VectorXd& theta) {
    return data.from_outputs * model.emulator.field(phi, theta);
}

Eigen::MatrixXd covariance(const Problem& problem, const DataSet& data, const Eigen::VectorXd& phi, const Eigen::VectorXd& theta) {
    const auto& emulator = problem.model->emulator;
    const Eigen::MatrixXd modes = data.from_outputs * emulator.basis().modes;
    Eigen::MatrixXd sigma = data.measurement_covariance + data.tolerance_covariance;
    sigma += modes * emulator.score_covariance(phi, theta, problem.experiment.settings.scatter_of_one_run) * modes.transpose();
    sigma += data.from_outputs * emulator.rest_covariance(phi, theta) * data.from_outputs.transpose();
    // Between regimes: half of what the quadratic term contributes is taken as one standard deviation, common to a measurement.
    const Eigen::VectorXd curve = data.interpolation * emulator.field(phi, theta);
    for (std::size_t i = 0; i < data.points.size(); ++i)
        for (std::size_t j = 0; j < data.points.size(); ++j)
            if (data.points[i].measurement == data.points[j].measurement) {
                const auto a = static_cast<Eigen::Index>(i), b = static_cast<Eigen::Index>(j);
                sigma(a, b) += 0.25 * curve[a] * curve[b];
            }
    return sigma;
}

Distortions generic_distortions(const Problem& problem, const Eigen::VectorXd& sigma) {
    const DataSet& data = problem.fitted;
    const auto& observables = problem.model->campaign.description.observables;
    Distortions d;
    std::vector<Eigen::VectorXd> columns;
    const auto add = [&](Eigen::VectorXd column, const std::string& family) {
        column = column.cwiseProduct(sigma);
        const double rms = std::sqrt((column.array() / sigma.array()).square().sum() / static_cast<double>((column.array() != 0.0).count()));
        columns.push_back(column / rms);
        d.family.push_back(family);
    };
    for (std::size_t o = 0; o < observables.size(); ++o) {
        double low = 1e300, high = -1e300, slow = 1e300, fast = -1e300;
        for (const DataPoint& p : data.points) {
            if (p.observable != static_cast<int>(o)) continue;
            low = std::min(low, p.axis);
            high = std::max(high, p.axis);
            slow = std::min(slow, p.level);
            fast = std::max(fast, p.level);
        }
        if (low > high) continue;
        for (int shape = 0; shape < (high > low ? 3 : 1); ++shape)
            for (int trend = 0; trend < (fast > slow ? 2 : 1); ++trend) {
                Eigen::VectorXd column = Eigen::VectorXd::Zero(data.value.size());
                for (std::size_t i = 0; i < data.points.size(); ++i) {
                    const DataPoint& p = data.points[i];
                    if (p.observable != static_cast<int>(o)) continue;
                    const double s = high > low ? 2.0 * (p.axis - low) / (high - low) - 1.0 : 0.0;
                    const double u = trend == 0 ? 1.0 : 2.0 * (p.level - slow) / (fast - slow) - 1.0;
                    column[static_cast<Eigen::Index>(i)] = u * (shape == 0 ? 1.0 : shape == 1 ? s : 1.5 * (s * s - 1.0 / 3.0));
                }
                static const char* const names[] = {"offset", "tilt", "curvature"};
                add(column, observables[o].name + ": " + names[shape]);
            }
    }
    d.shapes.resize(data.value.size(), static_cast<Eigen::Index>(columns.size()));
    for (std::size_t j = 0; j < columns.size(); ++j) d.shapes.col(static_cast<Eigen::Index>(j)) = columns[j];
    return d;
}

}  // namespace pelletlab::diagnosis
