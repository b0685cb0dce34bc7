#include "diagnosis/locate.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "inference/statistics.hpp"

namespace pelletlab::diagnosis {

namespace {

/// Maps a group's residuals to their informative, decorrelated part: rows are directions.
struct GroupTest {
    Eigen::MatrixXd directions;
    double statistic(const Eigen::VectorXd& r, const std::vector<int>& points) const { return (directions * r(points)).squaredNorm(); }
};

GroupTest make_test(const Eigen::MatrixXd& v, const std::vector<int>& points) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(Eigen::MatrixXd(v(points, points)));
    std::vector<Eigen::Index> kept;
    for (Eigen::Index i = 0; i < eigen.eigenvalues().size(); ++i)
        if (eigen.eigenvalues()[i] > 0.15) kept.push_back(i);
    const Eigen::VectorXd scale = eigen.eigenvalues()(kept).array().rsqrt();
    return {scale.asDiagonal() * eigen.eigenvectors()(Eigen::all, kept).transpose()};
}

std::vector<int> others(Eigen::Index n, const std::vector<int>& points) {
    std::vector<bool> out(static_cast<std::size_t>(n), false);
    for (const int i : points) out[static_cast<std::size_t>(i)] = true;
    std::vector<int> rows;
    for (int i = 0; i < n; ++i)
        if (!out[static_cast<std::size_t>(i)]) rows.push_back(i);
    return rows;
}

/// The baseline near a fit: its mean, the covariance of the fitted data, and ∂mean/∂ψ by differences that stay inside the unit cube.
struct Linearised {
    Eigen::VectorXd mean;
    Eigen::MatrixXd sigma, jacobian;
};

Linearised linearised_baseline(const Attributor& attributor, const Eigen::VectorXd& psi) {
    const Hypothesis& none = attributor.hypotheses()[0];
    Linearised at;
    at.mean = attributor.mean(none, psi);
    Eigen::VectorXd phi, theta;
    attributor.split(none, psi, phi, theta);
    at.sigma = covariance(attributor.problem(), attributor.problem().fitted, phi, theta);
    at.jacobian.resize(at.mean.size(), psi.size());
    for (Eigen::Index i = 0; i < psi.size(); ++i) {
        Eigen::VectorXd moved = psi;
        const double step = moved[i] > 0.5 ? -1e-3 : 1e-3;
        moved[i] += step;
        at.jacobian.col(i) = (attributor.mean(none, moved) - at.mean) / step;
    }
    return at;
}

/// Standardised mean miss of the points when the baseline is fitted to the other rows.
double left_out_z(const Attributor& attributor, const Eigen::VectorXd& y, const std::vector<int>& points) {
    const auto rows = others(y.size(), points);
    if (rows.size() < static_cast<std::size_t>(attributor.problem().phi_lower.size()) + 1) return not_known;
    const Fit fit = attributor.fit_rows(0, y, rows);
    const Linearised at = linearised_baseline(attributor, fit.mode.psi);
    const Eigen::VectorXd miss = y - at.mean;
    Eigen::VectorXd w = Eigen::VectorXd::Zero(y.size());
    for (const int i : points) w[i] = 1.0 / static_cast<double>(points.size());
    const Eigen::VectorXd jw = at.jacobian.transpose() * w;
    const double variance = w.dot(at.sigma * w) + jw.dot(fit.mode.precision.ldlt().solve(jw));
    return w.dot(miss) / std::sqrt(variance);
}

}  // namespace

std::vector<DiagnosisWhere> locate(const Attributor& attributor, const Eigen::VectorXd& y, const Fit& baseline, int draws, std::uint64_t seed, bool leave_out) {
    const Problem& problem = attributor.problem();
    const DataSet& data = problem.fitted;
    const Eigen::Index n = y.size();
    const Eigen::MatrixXd& j = baseline.mode.jacobian;
    const Eigen::MatrixXd m = Eigen::MatrixXd::Identity(n, n) - j * baseline.mode.precision.ldlt().solve(j.transpose());
    // Residuals in physical units decorrelate badly over groups when whitened by a triangular factor: each group keeps its own rows of C·r.
    const Eigen::MatrixXd& c = baseline.whitener.factor();
    const Eigen::VectorXd sd = c.rowwise().norm();
    const Eigen::MatrixXd to_physical = sd.cwiseInverse().asDiagonal() * c;  // residuals in units of their own standard deviation
    const Eigen::MatrixXd operator_of_noise = to_physical * m;
    const Eigen::MatrixXd v = operator_of_noise * operator_of_noise.transpose();
    const Eigen::VectorXd r = to_physical * baseline.mode.residual;
    const Eigen::MatrixXd physical_covariance = sd.asDiagonal() * v * sd.asDiagonal();
    const Eigen::VectorXd miss = y - attributor.mean(attributor.hypotheses()[0], baseline.mode.psi);

    std::vector<GroupTest> tests;
    std::vector<std::vector<double>> reference(data.groups.size());
    for (const Group& g : data.groups) tests.push_back(make_test(v, g.points));
    RandomStream random(seed, 0x6c6f6361);
    for (int d = 0; d < draws; ++d) {
        const Eigen::VectorXd noise = operator_of_noise * inference::draw_student(random, n, problem.model->emulator.nu());
        for (std::size_t g = 0; g < tests.size(); ++g) reference[g].push_back(tests[g].statistic(noise, data.groups[g].points));
    }
    std::vector<DiagnosisWhere> where;
    std::vector<double> p;
    for (std::size_t g = 0; g < data.groups.size(); ++g) {
        const Group& group = data.groups[g];
        DiagnosisWhere w;
        w.group = group.name;
        w.observable = group.observable;
        w.region = group.region;
        w.regime = group.regime;
        w.unit =
            problem.model->campaign.description.observables[static_cast<std::size_t>(data.points[static_cast<std::size_t>(group.points[0])].observable)].unit;
        w.statistic = tests[g].statistic(r, group.points);
        w.degrees = static_cast<double>(tests[g].directions.rows());
        w.p = w.degrees > 0.0 ? inference::reference_p_value(w.statistic, reference[g]) : 1.0;
        const auto count = static_cast<double>(group.points.size());
        w.gap = miss(group.points).sum() / count;
        const double half = 1.6449 * std::sqrt(Eigen::MatrixXd(physical_covariance(group.points, group.points)).sum()) / count;
        w.lower = w.gap - half;
        w.upper = w.gap + half;
        w.left_out_z = leave_out ? left_out_z(attributor, y, group.points) : not_known;
        p.push_back(w.p);
        where.push_back(w);
    }
    const auto discovered = inference::false_discovery_control(p, problem.experiment.settings.false_discovery_rate);
    for (std::size_t g = 0; g < where.size(); ++g) where[g].discovery = discovered[g];
    return where;
}

double transfer_p_value(const Attributor& attributor, const Eigen::VectorXd& y, int draws, std::uint64_t seed) {
    const Problem& problem = attributor.problem();
    std::vector<int> calibrated, rest;
    for (std::size_t i = 0; i < problem.is_calibration.size(); ++i) (problem.is_calibration[i] ? calibrated : rest).push_back(static_cast<int>(i));
    if (calibrated.empty() || rest.empty()) return not_known;
    const Fit fit = attributor.fit_rows(0, y, calibrated);
    const auto [f, sigma, jacobian] = linearised_baseline(attributor, fit.mode.psi);
    // Miss of the rest: its own noise, minus what the calibrated data's noise drags along through the fit.
    const inference::Whitener calibrated_whitener(Eigen::MatrixXd(sigma(calibrated, calibrated)));
    const Eigen::MatrixXd jc = calibrated_whitener.whiten_columns(jacobian(calibrated, Eigen::all));
    const Eigen::MatrixXd gain = jacobian(rest, Eigen::all) * fit.mode.precision.ldlt().solve(jc.transpose());
    const inference::Whitener whole(sigma);
    Eigen::MatrixXd to_miss = whole.factor()(rest, Eigen::all);
    to_miss -= gain * calibrated_whitener.whiten_columns(Eigen::MatrixXd(whole.factor()(calibrated, Eigen::all)));
    const inference::Whitener miss_whitener(to_miss * to_miss.transpose() + 1e-12 * Eigen::MatrixXd::Identity(to_miss.rows(), to_miss.rows()));
    const double observed = miss_whitener.whiten(Eigen::VectorXd((y - f)(rest))).squaredNorm();
    RandomStream random(seed, 0x7472616e);
    std::vector<double> reference;
    for (int d = 0; d < draws; ++d)
        reference.push_back(miss_whitener.whiten(to_miss * inference::draw_student(random, y.size(), problem.model->emulator.nu())).squaredNorm());
    return inference::reference_p_value(observed, reference);
}

}  // namespace pelletlab::diagnosis
