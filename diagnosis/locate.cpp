#include "diagnosis/locate.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "inference/statistics.hpp"

namespace pelletlab::diagnosis {

namespace {

/// Unit patterns of a group's residuals after decorrelation: z = filters · r_g are standardised.
struct GroupTest {
    Eigen::MatrixXd filters;      ///< patterns × points
    std::vector<bool> one_sided;  ///< only a positive z speaks for the pattern
    /// Largest z² of each column of residuals.
    Eigen::RowVectorXd statistic(const Eigen::MatrixXd& r) const {
        Eigen::MatrixXd z = filters * r;
        for (Eigen::Index i = 0; i < z.rows(); ++i)
            if (one_sided[static_cast<std::size_t>(i)]) z.row(i) = z.row(i).cwiseMax(0.0);
        return z.cwiseAbs2().colwise().maxCoeff();
    }
};

GroupTest make_test(const Eigen::MatrixXd& v, const Eigen::MatrixXd& patterns, const std::vector<bool>& one_sided) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(v);
    std::vector<Eigen::Index> kept;
    for (Eigen::Index i = 0; i < eigen.eigenvalues().size(); ++i)
        if (eigen.eigenvalues()[i] > 0.15) kept.push_back(i);
    const Eigen::VectorXd scale = eigen.eigenvalues()(kept).array().rsqrt();
    const Eigen::MatrixXd decorrelated = scale.asDiagonal() * eigen.eigenvectors()(Eigen::all, kept).transpose();
    GroupTest test;
    std::vector<Eigen::RowVectorXd> rows;
    for (Eigen::Index i = 0; i < patterns.cols() && !kept.empty(); ++i) {
        const Eigen::VectorXd s = decorrelated * patterns.col(i);
        if (s.norm() < 1e-3 * std::max(1e-300, patterns.col(i).norm())) continue;  // calibration absorbs it
        rows.push_back(s.normalized().transpose() * decorrelated);
        test.one_sided.push_back(one_sided[static_cast<std::size_t>(i)]);
    }
    test.filters.resize(static_cast<Eigen::Index>(rows.size()), v.rows());
    for (std::size_t i = 0; i < rows.size(); ++i) test.filters.row(static_cast<Eigen::Index>(i)) = rows[i];
    return test;
}

/// Directions in which a gap is looked for, whole data, in units of each datum's standard deviation: a shift, and what each effect leaves after recalibration.
Eigen::MatrixXd patterns_of(const Attributor& attributor, const Fit& baseline, const Eigen::MatrixXd& operator_of_noise, std::vector<bool>& one_sided) {
    const Problem& problem = attributor.problem();
    Eigen::VectorXd phi, theta;
    attributor.split(attributor.hypotheses()[0], baseline.mode.psi, phi, theta);
    const Eigen::VectorXd f0 = predict(*problem.model, problem.fitted, phi, theta);
    Eigen::MatrixXd patterns = Eigen::MatrixXd::Ones(f0.size(), 1 + theta.size());
    one_sided.assign(1, false);
    for (Eigen::Index e = 0; e < theta.size(); ++e) {
        Eigen::VectorXd with = theta;
        with[e] = 0.7;
        patterns.col(1 + e) = operator_of_noise * baseline.whitener.whiten(predict(*problem.model, problem.fitted, phi, with) - f0);
        const auto& effect = problem.model->effect(static_cast<int>(e));
        one_sided.push_back(!effect.two_sided);
    }
    return patterns;
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
    const Eigen::MatrixXd m = inference::residual_operator(baseline.mode);
    // Residuals in physical units decorrelate badly over groups when whitened by a triangular factor: each group keeps its own rows of C·r.
    const Eigen::MatrixXd& c = baseline.whitener.factor();
    const Eigen::VectorXd sd = c.rowwise().norm();
    const Eigen::MatrixXd to_physical = sd.cwiseInverse().asDiagonal() * c;  // residuals in units of their own standard deviation
    const Eigen::MatrixXd operator_of_noise = to_physical * m;
    const Eigen::MatrixXd v = operator_of_noise * operator_of_noise.transpose();
    const Eigen::VectorXd r = to_physical * baseline.mode.residual;
    const Eigen::MatrixXd physical_covariance = sd.asDiagonal() * v * sd.asDiagonal();
    const Eigen::VectorXd miss = y - attributor.mean(attributor.hypotheses()[0], baseline.mode.psi);

    std::vector<bool> one_sided;
    const Eigen::MatrixXd patterns = patterns_of(attributor, baseline, operator_of_noise, one_sided);
    const Eigen::MatrixXd noise = operator_of_noise * noise_draws(problem, draws, seed, 0x6c6f6361);
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
        const GroupTest test = make_test(v(group.points, group.points), patterns(group.points, Eigen::all), one_sided);
        w.degrees = static_cast<double>(test.filters.rows());
        if (w.degrees > 0.0) {
            w.statistic = test.statistic(r(group.points))[0];
            const Eigen::RowVectorXd reference = test.statistic(noise(group.points, Eigen::all));
            w.p = inference::reference_p_value(w.statistic, {reference.data(), reference.data() + reference.size()});
        }
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
    const Eigen::MatrixXd gain = fit.mode.weight * jacobian(rest, Eigen::all) * fit.mode.precision.ldlt().solve(jc.transpose());
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
