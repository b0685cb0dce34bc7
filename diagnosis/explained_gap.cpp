#include "diagnosis/explained_gap.hpp"

#include <limits>

#include "inference/statistics.hpp"

namespace pelletlab::diagnosis {

namespace {

/// f_H(ψ) at every draw of the explanation's posterior, a column a draw; with a draw of the distortion in the open class.
Eigen::MatrixXd predicted(const Attributor& attributor, const Hypothesis& h, const Fit& fit, const Eigen::VectorXd& y, RandomStream& random) {
    const auto& draws = fit.posterior.draws;
    Eigen::MatrixXd f(y.size(), static_cast<Eigen::Index>(draws.size()));
    if (!h.open) {
        for (std::size_t d = 0; d < draws.size(); ++d) f.col(static_cast<Eigen::Index>(d)) = attributor.mean(h, draws[d]);
        return f;
    }
    // a | y ~ N(Dᵀ Σ⁻¹ r, 1 − Dᵀ Σ⁻¹ D), Σ with D Dᵀ in it.
    const Eigen::MatrixXd d_white = fit.whitener.whiten_columns(fit.distortion);
    const Eigen::Index k = d_white.cols();
    const inference::Whitener spread((1.0 + 1e-9) * Eigen::MatrixXd::Identity(k, k) - d_white.transpose() * d_white);
    const Hypothesis& none = attributor.hypotheses()[0];
    for (std::size_t d = 0; d < draws.size(); ++d) {
        const Eigen::VectorXd base = attributor.mean(none, draws[d]);
        Eigen::VectorXd a = d_white.transpose() * fit.whitener.whiten(y - base);
        a += spread.colour(inference::draw_student(random, k, std::numeric_limits<double>::infinity()));
        f.col(static_cast<Eigen::Index>(d)) = base + fit.distortion * a;
    }
    return f;
}

}  // namespace

std::vector<ExplainedGap> explained_gaps(const Attributor& attributor, const Eigen::VectorXd& y, const Attribution& a, double q, std::uint64_t seed) {
    const auto& hypotheses = attributor.hypotheses();
    const auto& groups = attributor.problem().fitted.groups;
    const Fit& base = a.fits[0];
    const Eigen::VectorXd sigma = base.whitener.factor().rowwise().norm(), f0 = attributor.mean(hypotheses[0], base.mode.psi);
    const Eigen::MatrixXd m = inference::residual_operator(base.mode);
    RandomStream random(seed, 0x77686572);

    std::vector<ExplainedGap> result(groups.size());
    std::vector<std::vector<std::pair<double, double>>> means(groups.size());  // value and weight
    for (std::size_t h = 0; h < hypotheses.size(); ++h) {
        const double p = a.probability[h];
        if (p < 1e-4) continue;
        const bool none = !hypotheses[h].open && hypotheses[h].effects.empty();
        Eigen::MatrixXd shift = Eigen::MatrixXd::Zero(y.size(), 1);
        if (!none) {
            if (a.fits[h].posterior.draws.empty()) continue;
            shift = predicted(attributor, hypotheses[h], a.fits[h], y, random).colwise() - f0;
            shift = base.whitener.factor().triangularView<Eigen::Lower>() * (m * base.whitener.whiten_columns(shift));
        }
        const double weight = p / static_cast<double>(shift.cols());
        for (std::size_t g = 0; g < groups.size(); ++g)
            for (Eigen::Index d = 0; d < shift.cols(); ++d) {
                const Eigen::VectorXd one = shift.col(d);
                const Eigen::VectorXd in_group = one(groups[g].points);
                means[g].emplace_back(in_group.mean(), weight);
                result[g].gap += weight * in_group.mean();
                if (in_group.cwiseQuotient(Eigen::VectorXd(sigma(groups[g].points))).squaredNorm() > 1.0) result[g].probability += weight;
            }
    }
    for (std::size_t g = 0; g < groups.size(); ++g) {
        result[g].lower = inference::weighted_quantile(means[g], 0.05);
        result[g].upper = inference::weighted_quantile(means[g], 0.95);
    }
    std::vector<double> doubt;
    for (const ExplainedGap& one : result) doubt.push_back(1.0 - one.probability);
    const auto found = inference::expected_false_discovery_control(doubt, q);
    for (std::size_t g = 0; g < groups.size(); ++g) result[g].discovery = found[g];
    return result;
}

}  // namespace pelletlab::diagnosis
