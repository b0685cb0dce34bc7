#include "diagnosis/attribute.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "inference/statistics.hpp"

namespace pelletlab::diagnosis {

namespace {

/// Orthonormal basis of the columns, those that are (nearly) dependent left out.
Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& columns) {
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(columns);
    qr.setThreshold(1e-6);
    const Eigen::Index rank = qr.rank();
    return Eigen::MatrixXd(qr.householderQ() * Eigen::MatrixXd::Identity(columns.rows(), rank));
}

}  // namespace

Eigen::MatrixXd noise_draws(const Problem& problem, int draws, std::uint64_t seed, std::uint64_t stream) {
    Eigen::MatrixXd noise(problem.fitted.value.size(), draws);
    RandomStream random(seed, stream);
    for (int d = 0; d < draws; ++d) noise.col(d) = inference::draw_student(random, noise.rows(), problem.model->emulator.nu());
    return noise;
}

Adequacy test_adequacy(const Problem& problem, const Fit& fit, const Eigen::MatrixXd& noise) {
    const Eigen::Index n = fit.mode.residual.size();
    const Eigen::MatrixXd m = inference::residual_operator(fit.mode);
    const Eigen::VectorXd sigma = fit.whitener.factor().rowwise().norm();
    const Distortions distortions = generic_distortions(problem, sigma);
    const Eigen::MatrixXd shapes = m * fit.whitener.whiten_columns(distortions.shapes);

    std::map<std::string, std::vector<int>> families;
    for (std::size_t i = 0; i < distortions.family.size(); ++i) families[distortions.family[i]].push_back(static_cast<int>(i));
    std::vector<std::string> names;
    std::vector<Eigen::MatrixXd> bases;
    for (const auto& [name, columns] : families) {
        const Eigen::MatrixXd chosen = shapes(Eigen::all, columns);
        if (chosen.colwise().norm().maxCoeff() < 1e-3) continue;  // the fit absorbs it whole: nothing to test
        names.push_back(name);
        bases.push_back(orthonormal(chosen));
    }
    const Eigen::MatrixXd basis = orthonormal(fit.whitener.whiten_columns(problem.fitted.from_outputs * problem.model->emulator.basis().modes));
    const bool has_rest = basis.cols() + 3 <= n;
    const auto statistics = [&](const Eigen::MatrixXd& r) {  // rows: families; columns: those of r
        Eigen::MatrixXd t(static_cast<Eigen::Index>(bases.size()) + (has_rest ? 2 : 1), r.cols());
        Eigen::Index row = 0;
        for (const auto& q : bases) t.row(row++) = (q.transpose() * r).colwise().squaredNorm();
        t.row(row++) = r.colwise().squaredNorm();
        if (has_rest) t.row(row) = t.row(row - 1) - (basis.transpose() * r).colwise().squaredNorm();
        return t;
    };
    names.emplace_back("whole misfit");
    if (has_rest) names.emplace_back("pattern no run has");
    const Eigen::MatrixXd reference = statistics(m * noise), observed = statistics(fit.mode.residual);
    std::vector<double> p;
    for (Eigen::Index i = 0; i < observed.rows(); ++i) {
        const Eigen::RowVectorXd row = reference.row(i);
        p.push_back(inference::reference_p_value(observed(i, 0), {row.data(), row.data() + row.size()}));
    }
    const auto adjusted = inference::holm(p);
    Adequacy result;
    for (std::size_t i = 0; i < names.size(); ++i) {
        result.parts.push_back({names[i], observed(static_cast<Eigen::Index>(i), 0), p[i]});
        if (i == 0 || adjusted[i] < result.p) {
            result.p = adjusted[i];
            result.family = names[i];
        }
    }
    return result;
}

void normalise(Attribution& a, const std::vector<Hypothesis>& hypotheses, double temperature, Eigen::Index effects) {
    std::vector<double> value(hypotheses.size());
    double largest = -std::numeric_limits<double>::infinity();
    for (std::size_t h = 0; h < hypotheses.size(); ++h) {
        value[h] = hypotheses[h].log_prior + a.log_evidence[h] / temperature;
        largest = std::max(largest, value[h]);
    }
    double sum = 0.0;
    for (double& v : value) sum += v = std::exp(v - largest);
    a.probability.assign(hypotheses.size(), 0.0);
    a.inclusion.assign(static_cast<std::size_t>(effects), 0.0);
    a.probability_of_open = a.probability_of_none = 0.0;
    a.best_closed = 0;
    for (std::size_t h = 0; h < hypotheses.size(); ++h) {
        const double p = a.probability[h] = value[h] / sum;
        for (const int e : hypotheses[h].effects) a.inclusion[static_cast<std::size_t>(e)] += p;
        if (hypotheses[h].open) a.probability_of_open = p;
        if (!hypotheses[h].open && hypotheses[h].effects.empty()) a.probability_of_none = p;
        if (!hypotheses[h].open && p > a.probability[static_cast<std::size_t>(a.best_closed)]) a.best_closed = static_cast<int>(h);
    }
    std::vector<int> order(hypotheses.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](int x, int y) { return a.probability[static_cast<std::size_t>(x)] > a.probability[static_cast<std::size_t>(y)]; });
    a.credible_set.clear();
    double covered = 0.0;
    for (const int h : order) {
        a.credible_set.push_back(h);
        covered += a.probability[static_cast<std::size_t>(h)];
        if (covered >= 0.90) break;
    }
}

Attribution attribute(const Attributor& attributor, const Eigen::VectorXd& y, double temperature, int bootstrap, std::uint64_t seed) {
    Attribution a;
    const auto& hypotheses = attributor.hypotheses();
    for (std::size_t h = 0; h < hypotheses.size(); ++h) {
        a.fits.push_back(attributor.fit(h, y));
        a.log_evidence.push_back(a.fits.back().log_evidence);
    }
    normalise(a, hypotheses, temperature, attributor.problem().model->effects());
    const Eigen::MatrixXd noise = noise_draws(attributor.problem(), bootstrap, seed, 0x61646571);
    a.baseline_adequacy = test_adequacy(attributor.problem(), a.fits[0], noise);
    a.adequacy = a.best_closed == 0 ? a.baseline_adequacy : test_adequacy(attributor.problem(), a.fits[static_cast<std::size_t>(a.best_closed)], noise);
    return a;
}

}  // namespace pelletlab::diagnosis
