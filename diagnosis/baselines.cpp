#include "diagnosis/baselines.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace pelletlab::diagnosis {

namespace {

std::vector<int> ranked(const std::vector<double>& score) {
    std::vector<int> order(score.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return score[static_cast<std::size_t>(a)] > score[static_cast<std::size_t>(b)]; });
    return order;
}

double cosine(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
    return a.dot(b) / std::max(1e-12, a.norm() * b.norm());
}

/// Coordinate descent for ½‖r − S b‖² + κ Σ|b|, b ≥ 0, S with columns of unit norm.
Eigen::VectorXd lasso(const Eigen::MatrixXd& s, const Eigen::VectorXd& r, double kappa) {
    Eigen::VectorXd b = Eigen::VectorXd::Zero(s.cols());
    Eigen::VectorXd left = r;
    for (int sweep = 0; sweep < 200; ++sweep)
        for (Eigen::Index k = 0; k < s.cols(); ++k) {
            const double old = b[k];
            b[k] = std::max(0.0, s.col(k).dot(left) + old - kappa);
            left += (old - b[k]) * s.col(k);
        }
    return b;
}

}  // namespace

std::vector<BaselineRanking> baseline_rankings(const Attributor& attributor, const Eigen::VectorXd& y, const Attribution& a) {
    const Problem& problem = attributor.problem();
    const DataSet& data = problem.fitted;
    const Eigen::Index k = problem.model->effects(), n = y.size();
    const Fit& base = a.fits[0];
    const auto& w = base.whitener;
    Eigen::VectorXd phi, none;
    attributor.split(attributor.hypotheses()[0], base.mode.psi, phi, none);
    const Eigen::VectorXd centre = 0.5 * (problem.phi_lower + problem.phi_upper);
    const Eigen::MatrixXd m = inference::residual_operator(base.mode);
    Eigen::MatrixXd raw(n, k), fitted(n, k), physical(n, k);
    for (Eigen::Index e = 0; e < k; ++e) {
        Eigen::VectorXd theta = none;
        theta[e] = 0.7;
        raw.col(e) = w.whiten(predict(*problem.model, data, centre, theta) - predict(*problem.model, data, centre, none));
        physical.col(e) = predict(*problem.model, data, phi, theta) - predict(*problem.model, data, phi, none);
        fitted.col(e) = m * w.whiten(physical.col(e));
    }
    const Eigen::VectorXd raw_residual = w.whiten(y - predict(*problem.model, data, centre, none)), residual = base.mode.residual;
    const Eigen::VectorXd miss = y - predict(*problem.model, data, phi, none);

    std::vector<BaselineRanking> list;
    const auto add = [&](const std::string& rule, const auto& score) {
        std::vector<double> s;
        for (Eigen::Index e = 0; e < k; ++e) s.push_back(score(e));
        list.push_back({rule, ranked(s)});
    };
    std::size_t largest = 0;
    std::vector<double> group_miss;
    for (const Group& g : data.groups) group_miss.push_back(miss(g.points).mean());
    for (std::size_t g = 0; g < group_miss.size(); ++g)
        if (std::abs(group_miss[g]) > std::abs(group_miss[largest])) largest = g;
    add("largest residual",
        [&](Eigen::Index e) { return physical(data.groups[largest].points, e).mean() * (group_miss[largest] > 0 ? 1.0 : -1.0) / physical.col(e).norm(); });
    add("nearest signature, raw", [&](Eigen::Index e) { return cosine(raw.col(e), raw_residual); });
    add("nearest signature, after the fit", [&](Eigen::Index e) { return cosine(fitted.col(e), residual); });
    const Distortions d = generic_distortions(problem, w.factor().rowwise().norm());
    const Eigen::MatrixXd smooth = w.whiten_columns(d.shapes);
    const Eigen::VectorXd delta = smooth * smooth.colPivHouseholderQr().solve(residual);
    add("smooth discrepancy, nearest signature", [&](Eigen::Index e) { return cosine(fitted.col(e), delta); });
    add("smallest chi-square", [&](Eigen::Index e) {
        for (std::size_t h = 0; h < attributor.hypotheses().size(); ++h)
            if (attributor.hypotheses()[h].effects == std::vector<int>{static_cast<int>(e)}) return -a.fits[h].mode.chi2;
        return 0.0;
    });
    list.push_back({"parameters only", {}});
    Eigen::MatrixXd unit = fitted;
    for (Eigen::Index e = 0; e < k; ++e) unit.col(e) /= std::max(1e-12, fitted.col(e).norm());
    const Eigen::VectorXd b = lasso(unit, residual, std::sqrt(2.0 * std::log(std::max<double>(2.0, static_cast<double>(k)))));
    BaselineRanking sparse{"LASSO on signatures", ranked(std::vector<double>(b.data(), b.data() + b.size()))};
    if (b.maxCoeff() <= 0.0) sparse.effects.clear();
    list.push_back(sparse);
    add("sign table", [&](Eigen::Index e) {
        double agree = 0.0;
        for (std::size_t g = 0; g < data.groups.size(); ++g) agree += physical(data.groups[g].points, e).mean() * group_miss[g] > 0.0 ? 1.0 : 0.0;
        return agree;
    });
    return list;
}

}  // namespace pelletlab::diagnosis
