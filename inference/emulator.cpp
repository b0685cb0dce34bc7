#include "inference/emulator.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "inference/gaussian.hpp"

namespace pelletlab::inference {

namespace {

/// Covariance of the residuals (each run weighed by its scatter) shrunk halfway to its diagonal: there are fewer runs than pairs of outputs.
Eigen::MatrixXd covariance_of_rest(const PodBasis& basis, const Eigen::MatrixXd& outputs, const Eigen::VectorXd& scatter) {
    Eigen::MatrixXd rest(outputs.rows(), outputs.cols());
    for (Eigen::Index i = 0; i < outputs.rows(); ++i) rest.row(i) = basis.residual(outputs.row(i).transpose()).transpose() / std::sqrt(scatter[i]);
    const double freedom = std::max(1.0, static_cast<double>(outputs.rows() - basis.modes.cols() - 1));
    Eigen::MatrixXd covariance = rest.transpose() * rest / freedom;
    const Eigen::VectorXd diagonal = covariance.diagonal();
    covariance *= 0.5;
    covariance.diagonal() = diagonal;
    return covariance;
}

/// What the standardised left-out errors of each mode show over parameters and effects: a mode that the kernel takes for smooth can be far off where the
/// response bends most, at an edge say, while the others are right. Runs at one point share the baseline's error and each effect's, so they count as that many.
std::vector<ScatterModel> fit_own(const SpokeInputs& inputs, const Eigen::MatrixXd& z, const std::vector<int>& point) {
    const auto points = static_cast<double>(std::set<int>(point.begin(), point.end()).size());
    ScatterOptions options;
    options.normal = true;
    options.weight = std::min(1.0, points * static_cast<double>(1 + inputs.theta.cols()) / static_cast<double>(z.rows()));
    std::vector<ScatterModel> own(static_cast<std::size_t>(z.cols()));
    parallel_for(own.size(), 1, [&](std::size_t m) {
        std::vector<double> square;
        for (Eigen::Index i = 0; i < z.rows(); ++i) square.push_back(z(i, static_cast<Eigen::Index>(m)) * z(i, static_cast<Eigen::Index>(m)));
        own[m] = fit_scatter(inputs, square, 1, options);
    });
    return own;
}

}  // namespace

Emulator::Emulator(const TrainingRuns& runs, const Eigen::VectorXd& weight, const EmulatorOptions& options) {
    std::vector<int> spokes, pairs;
    for (Eigen::Index i = 0; i < runs.output.rows(); ++i) {
        const auto active = (runs.inputs.theta.row(i).array() != 0.0).count();
        if (active <= 1) spokes.push_back(static_cast<int>(i));
        if (active == 2) pairs.push_back(static_cast<int>(i));
    }
    const auto needed = static_cast<std::size_t>(2 * (runs.inputs.phi.cols() + runs.inputs.theta.cols()) + 2);
    if (spokes.size() < needed)
        throw bad_input("the campaign has " + std::to_string(spokes.size()) + " runs with at most one effect, and the emulator needs " + std::to_string(needed),
                        "add runs, or diagnose with fewer effects and parameters");
    if (pairs.size() > static_cast<std::size_t>(options.largest_pairs)) {
        std::vector<int> some;
        for (int i = 0; i < options.largest_pairs; ++i)
            some.push_back(pairs[static_cast<std::size_t>(i) * pairs.size() / static_cast<std::size_t>(options.largest_pairs)]);
        pairs = some;
    }
    std::vector<int> used = spokes;
    used.insert(used.end(), pairs.begin(), pairs.end());
    const Eigen::MatrixXd outputs = runs.output(used, Eigen::all);
    basis_ = make_pod(outputs, weight, options.keep, options.largest_modes);

    const Eigen::Index modes = basis_.modes.cols();
    const auto n = static_cast<Eigen::Index>(used.size());
    Eigen::MatrixXd scores(runs.output.rows(), modes);
    for (Eigen::Index i = 0; i < runs.output.rows(); ++i) scores.row(i) = basis_.scores(runs.output.row(i).transpose()).transpose();
    for (const int i : used) point_.push_back(runs.point[static_cast<std::size_t>(i)]);
    SpokeInputs inputs = runs.inputs;
    inputs.scatter = Eigen::VectorXd::Ones(inputs.phi.rows());
    Eigen::MatrixXd z(n, modes), error(n, modes);
    std::vector<double> distance;
    error_scale_.resize(modes);
    // First with equal noise for all runs; then with the noise that the left-out errors show to depend on parameters and effects.
    for (int pass = 0; pass < 2; ++pass) {
        processes_.assign(static_cast<std::size_t>(modes), {});
        parallel_for(processes_.size(), 1,
                     [&](std::size_t m) { processes_[m] = GaussianProcess(inputs, scores.col(static_cast<Eigen::Index>(m)), spokes, pairs); });
        for (Eigen::Index m = 0; m < modes; ++m) {
            const auto left = processes_[static_cast<std::size_t>(m)].leave_groups_out(point_);
            error.col(m) = left.error;
            z.col(m) = left.error.cwiseQuotient(left.deviation);
        }
        report_.standardised_rms = std::sqrt(z.squaredNorm() / static_cast<double>(n * modes));
        for (Eigen::Index m = 0; m < modes; ++m) error_scale_[m] = std::max(0.3, std::sqrt(z.col(m).squaredNorm() / static_cast<double>(n)));
        z = z * error_scale_.cwiseInverse().asDiagonal();
        const SpokeInputs used_inputs = inputs.rows(used);
        if (pass == 1) {
            own_ = fit_own(used_inputs, z, point_);
            for (Eigen::Index m = 0; m < modes; ++m)
                for (Eigen::Index i = 0; i < n; ++i)
                    z(i, m) /= std::sqrt(own_[static_cast<std::size_t>(m)].factor(used_inputs.phi.row(i).transpose(), used_inputs.theta.row(i).transpose()));
        }
        correlation_ = shrunk_correlation(z);
        const Whitener whitener(correlation_);
        distance.clear();
        for (Eigen::Index i = 0; i < n; ++i) distance.push_back(whitener.whiten(z.row(i).transpose()).squaredNorm());
        if (pass == 0) {
            scatter_ = fit_scatter(used_inputs, distance, modes);
            for (Eigen::Index i = 0; i < inputs.phi.rows(); ++i)
                inputs.scatter[i] = scatter_.relative(inputs.phi.row(i).transpose(), inputs.theta.row(i).transpose());
        } else {
            left_over_ = fit_scatter(used_inputs, distance, modes);
            for (Eigen::Index i = 0; i < n; ++i)
                z.row(i) /= std::sqrt(left_over_.factor(used_inputs.phi.row(i).transpose(), used_inputs.theta.row(i).transpose()));
        }
    }
    rest_ = covariance_of_rest(basis_, outputs, inputs.scatter(used));
    report_.nu = left_over_.nu;
    report_.smallest_scatter = std::sqrt(inputs.scatter.minCoeff());
    report_.largest_scatter = std::sqrt(inputs.scatter.maxCoeff());

    Eigen::Index small = 0;
    for (Eigen::Index i = 0; i < n; ++i) {
        const Eigen::VectorXd field = basis_.modes * error.row(i).transpose();
        small += (field.array().abs() * weight.array() < 0.5).count();
    }
    report_.runs = static_cast<int>(n);
    report_.spoke_runs = static_cast<int>(spokes.size());
    report_.pair_runs = static_cast<int>(pairs.size());
    report_.modes = static_cast<int>(modes);
    report_.kept_variance = basis_.kept;
    report_.share_beyond_three = static_cast<double>((z.array().abs() > 3.0).count()) / static_cast<double>(z.size());
    report_.share_small = static_cast<double>(small) / static_cast<double>(n * weight.size());
    const SpokeInputs used_inputs = inputs.rows(used);
    const Eigen::RowVectorXd low = used_inputs.phi.colwise().minCoeff(), high = used_inputs.phi.colwise().maxCoeff();
    double edge = 0.0, inner = 0.0, edges = 0.0;
    for (Eigen::Index i = 0; i < n; ++i) {
        const auto phi = used_inputs.phi.row(i).array();
        const bool at_edge = (phi <= low.array() + 1e-9).any() || (phi >= high.array() - 1e-9).any();
        (at_edge ? edge : inner) += z.row(i).squaredNorm() / static_cast<double>(modes);
        edges += at_edge ? 1.0 : 0.0;
    }
    report_.edge_rms = std::sqrt(edge / std::max(1.0, edges));
    report_.inner_rms = std::sqrt(inner / std::max(1.0, static_cast<double>(n) - edges));
    report_.accepted = report_.standardised_rms > 0.5 && report_.standardised_rms < 2.0 && report_.share_beyond_three < 0.02;
}

Emulator Emulator::without_point(int point) const {
    Emulator rest = *this;
    std::vector<int> out;
    rest.point_.clear();
    for (std::size_t i = 0; i < point_.size(); ++i)
        if (point_[i] == point)
            out.push_back(static_cast<int>(i));
        else
            rest.point_.push_back(point_[i]);
    if (!out.empty())
        for (GaussianProcess& process : rest.processes_) process = process.without(out);
    return rest;
}

Eigen::VectorXd Emulator::scores(const Eigen::VectorXd& phi, const Eigen::VectorXd& theta) const {
    Eigen::VectorXd s(static_cast<Eigen::Index>(processes_.size()));
    for (std::size_t m = 0; m < processes_.size(); ++m) s[static_cast<Eigen::Index>(m)] = processes_[m].mean(phi, theta);
    return s;
}

Eigen::MatrixXd Emulator::score_covariance(const Eigen::VectorXd& phi, const Eigen::VectorXd& theta, bool one_run) const {
    Eigen::VectorXd deviation(static_cast<Eigen::Index>(processes_.size()));
    const double noise = one_run ? scatter_.relative(phi, theta) : 0.0, rest = std::sqrt(left_over_.factor(phi, theta));
    for (std::size_t m = 0; m < processes_.size(); ++m) {
        const double variance = processes_[m].variance(phi, theta) + noise * processes_[m].noise_variance();
        deviation[static_cast<Eigen::Index>(m)] = rest * error_scale_[static_cast<Eigen::Index>(m)] * std::sqrt(variance * own_[m].factor(phi, theta));
    }
    return deviation.asDiagonal() * correlation_ * deviation.asDiagonal();
}

}  // namespace pelletlab::inference
