#include "diagnosis/signatures.hpp"

#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <map>

#include "campaign/assemble.hpp"
#include "core/observables.hpp"

namespace pelletlab::diagnosis {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

Index terms_of(Index parameters, bool quadratic) {
    return 1 + parameters + (quadratic ? parameters * (parameters + 1) / 2 : 0);
}

MatrixXd regressors(const Campaign& c, const std::vector<Index>& rows, bool quadratic) {
    const Index p = c.parameter.cols(), effects = c.amplitude.cols();
    MatrixXd x(static_cast<Index>(rows.size()), terms_of(p, quadratic) + effects);
    for (std::size_t r = 0; r < rows.size(); ++r) {
        const auto row = static_cast<Index>(r);
        VectorXd phi(p);
        for (Index j = 0; j < p; ++j) phi[j] = campaign::unit_coordinate(c.description.parameters[static_cast<std::size_t>(j)], c.parameter(rows[r], j)) - 0.5;
        Index at = 0;
        x(row, at++) = 1.0;
        for (Index j = 0; j < p; ++j) x(row, at++) = phi[j];
        if (quadratic)
            for (Index j = 0; j < p; ++j)
                for (Index k = j; k < p; ++k) x(row, at++) = phi[j] * phi[k];
        for (Index k = 0; k < effects; ++k) x(row, at++) = c.amplitude(rows[r], k);
    }
    return x;
}

/// Outputs of one observable in one regime, as the mean over its elements.
VectorXd mean_output(const Campaign& c, const std::vector<Index>& rows, int observable, int regime) {
    VectorXd sum = VectorXd::Zero(static_cast<Index>(rows.size()));
    int elements = 0;
    for (std::size_t j = 0; j < c.outputs.size(); ++j) {
        if (c.outputs[j].observable != observable || c.outputs[j].regime != regime) continue;
        for (std::size_t r = 0; r < rows.size(); ++r) sum[static_cast<Index>(r)] += c.output(rows[r], static_cast<Index>(j));
        ++elements;
    }
    return elements == 0 ? VectorXd() : VectorXd(sum / elements);
}

/// Standard deviation within repeated configurations, pooled; NaN where nothing is repeated. `freedom` becomes its degrees of freedom.
double pooled_scatter(const Campaign& c, const std::vector<Index>& rows, const VectorXd& y, int& freedom) {
    std::map<int, std::vector<double>> groups;
    for (std::size_t r = 0; r < rows.size(); ++r) groups[c.replicate[static_cast<std::size_t>(rows[r])]].push_back(y[static_cast<Index>(r)]);
    double sum = 0.0;
    freedom = 0;
    for (const auto& [number, values] : groups) {
        double mean = 0.0;
        for (const double v : values) mean += v / static_cast<double>(values.size());
        for (const double v : values) sum += (v - mean) * (v - mean);
        freedom += static_cast<int>(values.size()) - 1;
    }
    return freedom > 0 ? std::sqrt(sum / freedom) : not_known;
}

}  // namespace

SignatureTable signature_table(const Campaign& c) {
    SignatureTable table;
    const Index effects = c.amplitude.cols(), p = c.parameter.cols();
    for (const auto& e : c.description.effects) table.effects.push_back(e.name);
    table.runs.assign(static_cast<std::size_t>(effects), 0);
    std::vector<Index> rows;
    Index baseline = 0;
    for (Index i = 0; i < c.amplitude.rows(); ++i) {
        Index on = 0, which = 0;
        for (Index k = 0; k < effects; ++k)
            if (c.amplitude(i, k) != 0.0) ++on, which = k;
        if (on > 1) continue;
        rows.push_back(i);
        if (on == 0) ++baseline;
        if (on == 1) ++table.runs[static_cast<std::size_t>(which)];
    }
    const bool quadratic = baseline >= 2 * terms_of(p, true);
    const Index columns = terms_of(p, quadratic) + effects, freedom = static_cast<Index>(rows.size()) - columns;
    if (freedom < 2)
        throw bad_input(
            "the campaign has " + std::to_string(rows.size()) + " usable configurations, too few for a table of " + std::to_string(effects) + " effects",
            "run more of it: at least " + std::to_string(columns + 2), {c.description.file});
    table.configurations = static_cast<int>(rows.size());
    const MatrixXd x = regressors(c, rows, quadratic);
    const Eigen::CompleteOrthogonalDecomposition<MatrixXd> solver(x);
    const MatrixXd inverse = (x.transpose() * x).completeOrthogonalDecomposition().pseudoInverse();
    const double limit = boost::math::quantile(boost::math::complement(boost::math::students_t(static_cast<double>(freedom)), 0.005));
    for (std::size_t o = 0; o < c.description.observables.size(); ++o)
        for (std::size_t regime = 0; regime < c.regimes.size(); ++regime) {
            const VectorXd y = mean_output(c, rows, static_cast<int>(o), static_cast<int>(regime));
            if (y.size() == 0) continue;
            const VectorXd fit = solver.solve(y);
            const double residual = std::sqrt((y - x * fit).squaredNorm() / static_cast<double>(freedom));
            SignatureRow row;
            row.observable = c.description.observables[o].name;
            row.regime = c.regimes[regime].name;
            row.unit = c.description.observables[o].unit;
            row.tolerance = c.description.observables[o].tolerance;
            row.scatter = pooled_scatter(c, rows, y, table.repeats);
            table.scatter_from_repeats = !std::isnan(row.scatter);
            if (!table.scatter_from_repeats) row.scatter = residual;
            for (Index k = 0; k < effects; ++k) {
                const Index at = terms_of(p, quadratic) + k;
                SignatureEntry entry;
                entry.move = fit[at];
                const double error = residual * std::sqrt(std::max(0.0, inverse(at, at)));
                entry.in_scatter = entry.move / row.scatter;
                entry.error = error / row.scatter;
                entry.is_significant = std::abs(entry.move) > limit * error;
                row.effects.push_back(entry);
            }
            table.rows.push_back(row);
        }
    return table;
}

}  // namespace pelletlab::diagnosis
