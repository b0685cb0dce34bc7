#include "diagnosis/audit_ranges.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace pelletlab::diagnosis {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

struct UnitMistake {
    double factor;  ///< measured / true
    const char* words;
};

constexpr std::array unit_mistakes{
    UnitMistake{60.0 / (2.0 * std::numbers::pi), "rpm taken for rad/s"},
    UnitMistake{2.0 * std::numbers::pi / 60.0, "rad/s taken for rpm"},
    UnitMistake{2.0 * std::numbers::pi, "turns taken for radians"},
    UnitMistake{60.0, "minutes taken for seconds"},
    UnitMistake{1.0 / 60.0, "seconds taken for minutes"},
    UnitMistake{1000.0, "a factor of 1000: m and mm, or g and kg"},
    UnitMistake{0.001, "a factor of 1000: mm and m, or kg and g"},
    UnitMistake{10.0, "a factor of 10: cm and mm"},
    UnitMistake{0.1, "a factor of 10: mm and cm"},
    UnitMistake{180.0 / std::numbers::pi, "radians taken for degrees"},
    UnitMistake{std::numbers::pi / 180.0, "degrees taken for radians"},
    UnitMistake{2.0, "a factor of 2: diameter and radius"},
    UnitMistake{0.5, "a factor of 2: radius and diameter"},
    UnitMistake{-1.0, "the sign: the drum turns the other way, or the axis points the other way"},
};

constexpr double close = 0.25;  // share of the range by which a corrected value may still lie outside

/// Sizes of all baseline runs beside their mean, in the regime of the points or in another one.
struct Baseline {
    VectorXd mean;
    double smallest = 0.0, largest = 0.0;
    bool usable = false;
    double size_of(const VectorXd& y) const { return y.dot(mean) / mean.squaredNorm(); }
    /// Standard deviation of that size when the points have these.
    double spread_of(const VectorXd& sigma) const { return (sigma.array() * mean.array()).matrix().norm() / mean.squaredNorm(); }
    /// Whether the size lies among the runs' own, their range widened on both sides by `share` of it (of its logarithm where all sizes are positive) and by
    /// `more`.
    bool holds(double size, double share, double more) const {
        if (smallest <= 0.0) return size >= smallest - share * (largest - smallest) - more && size <= largest + share * (largest - smallest) + more;
        const double factor = std::pow(largest / smallest, share);
        return size >= smallest / factor - more && size <= largest * factor + more;
    }
};

/// `with`: points × outputs.
Baseline baseline_of(const Campaign& c, const MatrixXd& with) {
    std::vector<int> rows;
    for (Index i = 0; i < c.amplitude.rows(); ++i)
        if (c.amplitude.cols() == 0 || c.amplitude.row(i).cwiseAbs().maxCoeff() == 0.0) rows.push_back(static_cast<int>(i));
    const MatrixXd runs = c.output(rows, Eigen::all) * with.transpose();
    Baseline b;
    b.mean = runs.colwise().mean().transpose();
    b.usable = b.mean.squaredNorm() > 0.0;
    if (!b.usable) return b;
    const VectorXd sizes = runs * b.mean / b.mean.squaredNorm();
    b.smallest = sizes.minCoeff();
    b.largest = sizes.maxCoeff();
    return b;
}

/// The same points read in another regime; nothing when it lacks one of them.
bool moved_to(const Campaign& c, int regime, const MatrixXd& from, MatrixXd& to) {
    to = MatrixXd::Zero(from.rows(), from.cols());
    for (std::size_t j = 0; j < c.outputs.size(); ++j) {
        const VectorXd column = from.col(static_cast<Index>(j));
        if (column.isZero(0.0)) continue;
        const auto there = std::find_if(c.outputs.begin(), c.outputs.end(), [&](const CampaignOutput& o) {
            return o.regime == regime && o.observable == c.outputs[j].observable && o.element == c.outputs[j].element;
        });
        if (there == c.outputs.end()) return false;
        to.col(static_cast<Index>(there - c.outputs.begin())) += column;
    }
    return true;
}

void look(const Problem& problem, const DataSet& set, int measurement, std::vector<AuditItem>& items) {
    const Campaign& c = problem.model->campaign;
    std::vector<Index> points;
    for (std::size_t i = 0; i < set.points.size(); ++i)
        if (set.points[i].measurement == measurement) points.push_back(static_cast<Index>(i));
    if (points.empty()) return;
    const Measurement& m = problem.experiment.measurements[static_cast<std::size_t>(measurement)];
    const MatrixXd with = set.from_outputs(points, Eigen::all);
    const VectorXd y = set.value(points);
    const Baseline own = baseline_of(c, with);
    if (!own.usable) return;
    VectorXd sigma(y.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        const DataPoint& p = set.points[static_cast<std::size_t>(points[i])];
        sigma[static_cast<Index>(i)] = std::hypot(p.uncertainty, p.offset_uncertainty) + p.tolerance;
    }
    const double uncertainty = own.spread_of(sigma), size = own.size_of(y);
    if (own.holds(size, 1.0, 3.0 * uncertainty)) return;
    std::string text =
        fmt::format("'{}' is {:.3g} times the mean of all baseline runs, which reach from {:.3g} to {:.3g}", m.name, size, own.smallest, own.largest);
    std::vector<std::string> causes;
    for (const UnitMistake& mistake : unit_mistakes)
        if (own.holds(size / mistake.factor, close, 2.0 * uncertainty / std::max(1.0, std::abs(mistake.factor)))) causes.emplace_back(mistake.words);
    for (std::size_t r = 0; r < c.regimes.size(); ++r) {
        MatrixXd there;
        const bool is_own = std::any_of(c.outputs.begin(), c.outputs.end(), [&](const CampaignOutput& o) {
            return o.regime == static_cast<int>(r) && !with.col(&o - c.outputs.data()).isZero(0.0);
        });
        if (is_own || !moved_to(c, static_cast<int>(r), with, there)) continue;
        const Baseline other = baseline_of(c, there);
        if (other.usable && other.holds(other.size_of(y), close, 2.0 * other.spread_of(sigma)))
            causes.push_back("filed under the wrong regime, it fits " + c.regimes[r].name);
    }
    text += causes.empty() ? ": check scale, speed, fill and mass before an effect is looked for" : ": ";
    for (std::size_t i = 0; i < causes.size(); ++i) text += (i == 0 ? "" : "; or ") + causes[i];
    items.push_back({true, text + (causes.empty() ? "" : "?")});
}

}  // namespace

std::vector<AuditItem> audit_ranges(const Problem& problem) {
    std::vector<AuditItem> items;
    for (std::size_t m = 0; m < problem.experiment.measurements.size(); ++m)
        for (const DataSet* set : {&problem.fitted, &problem.held_out})
            if (!set->empty()) look(problem, *set, static_cast<int>(m), items);
    return items;
}

}  // namespace pelletlab::diagnosis
