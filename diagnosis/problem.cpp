#include "diagnosis/problem.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "core/units.hpp"

namespace pelletlab::diagnosis {

namespace {

/// Factor from one unit to another of the same dimension.
double conversion(const std::string& from, const std::string& to, const std::string& what, const Place& place) {
    if (from == to) return 1.0;
    const Dimension wanted = unit_dimension(to);
    if (!(unit_dimension(from) == wanted))
        throw bad_input(what + " is given in '" + from + "', and the campaign has it in '" + to + "': another quantity",
                        "units that fit: " + usual_units(wanted)[0] + " and its like", place);
    return unit_factor(from, wanted) / unit_factor(to, wanted);
}

double level_of(const Campaign& c, const Measurement& m) {
    if (c.description.regime_name.empty()) {
        if (!m.regime.empty()) throw bad_input("the measurement '" + m.name + "' names a regime, and the campaign has none", "remove regime", m.place);
        return 0.0;
    }
    if (m.regime.empty()) throw bad_input("the measurement '" + m.name + "' names no regime", "add regime = \"" + c.regimes[0].name + "\"", m.place);
    if (c.description.regime_unit.empty()) {
        std::vector<std::string> names;
        for (std::size_t r = 0; r < c.regimes.size(); ++r) {
            if (c.regimes[r].name == m.regime) return static_cast<double>(r);
            names.push_back(c.regimes[r].name);
        }
        const std::string guess = closest_word(m.regime, names);
        throw bad_input("the campaign has no regime '" + m.regime + "'", guess.empty() ? "use one of its regimes" : "did you mean '" + guess + "'?", m.place);
    }
    const Dimension wanted = unit_dimension(c.description.regime_unit);
    double level = 0.0;
    try {
        level = parse_quantity(m.regime, wanted) / unit_factor(c.description.regime_unit, wanted);
    } catch (const Error& error) {
        throw bad_input("regime of '" + m.name + "': " + error.problem(), "write for instance regime = \"" + c.regimes[0].name + "\"", m.place);
    }
    for (const CampaignRegime& r : c.regimes)
        if (std::abs(r.level - level) < 1e-9 * std::max(1.0, std::abs(r.level))) return r.level;
    if (level < c.regimes.front().level || level > c.regimes.back().level)
        throw bad_input("the measurement '" + m.name + "' was taken at " + m.regime + ", outside the campaign's regimes (" + c.regimes.front().name + " to " +
                            c.regimes.back().name + ")",
                        "leave it out: nothing is extrapolated", m.place);
    return level;
}

/// Weights of the campaign's regimes for one level: quadratic Lagrange through the three nearest, and the same linear.
struct RegimeWeights {
    std::vector<std::pair<int, double>> quadratic, linear;
};

RegimeWeights regime_weights(const Campaign& c, double level) {
    const auto n = static_cast<int>(c.regimes.size());
    const auto level_at = [&](int r) { return c.description.regime_unit.empty() ? static_cast<double>(r) : c.regimes[static_cast<std::size_t>(r)].level; };
    for (int r = 0; r < n; ++r)
        if (c.description.regime_name.empty() || level_at(r) == level) return {{{r, 1.0}}, {{r, 1.0}}};
    int above = 1;
    while (level_at(above) < level) ++above;
    const double t = (level - level_at(above - 1)) / (level_at(above) - level_at(above - 1));
    RegimeWeights w;
    w.linear = {{above - 1, 1.0 - t}, {above, t}};
    if (n < 3) {
        w.quadratic = w.linear;
        return w;
    }
    int first = above - 1;  // the third regime: the nearer neighbour of the interval
    if (above + 1 >= n || (first > 0 && level - level_at(first - 1) < level_at(above + 1) - level)) first -= 1;
    for (int i = first; i < first + 3; ++i) {
        double weight = 1.0;
        for (int j = first; j < first + 3; ++j)
            if (j != i) weight *= (level - level_at(j)) / (level_at(i) - level_at(j));
        w.quadratic.emplace_back(i, weight);
    }
    return w;
}

class Builder {
public:
    Builder(const Campaign& campaign, const Experiment& experiment, std::vector<std::string>& notes)
        : campaign_(campaign), experiment_(experiment), notes_(notes) {}

    DataSet build(bool held_out) {
        DataSet set;
        std::vector<Eigen::RowVectorXd> operators, curves;
        for (std::size_t m = 0; m < experiment_.measurements.size(); ++m) {
            const Measurement& one = experiment_.measurements[m];
            if ((one.role == MeasurementRole::held_out) == held_out) add(set, static_cast<int>(m), one, operators, curves);
        }
        const auto n = static_cast<Eigen::Index>(set.points.size());
        set.from_outputs.resize(n, campaign_.output.cols());
        set.interpolation.resize(n, campaign_.output.cols());
        set.value.resize(n);
        for (Eigen::Index i = 0; i < n; ++i) {
            set.from_outputs.row(i) = operators[static_cast<std::size_t>(i)];
            set.interpolation.row(i) = curves[static_cast<std::size_t>(i)];
            set.value[i] = set.points[static_cast<std::size_t>(i)].value;
        }
        add_covariances(set);
        return set;
    }

private:
    int observable_of(const Measurement& m) const {
        std::vector<std::string> names;
        for (std::size_t o = 0; o < campaign_.description.observables.size(); ++o) {
            if (campaign_.description.observables[o].name == m.observable) return static_cast<int>(o);
            names.push_back(campaign_.description.observables[o].name);
        }
        const std::string guess = closest_word(m.observable, names);
        throw bad_input("the campaign has no observable '" + m.observable + "'", guess.empty() ? "use one of its observables" : "did you mean '" + guess + "'?",
                        m.place);
    }

    int output_index(int regime, int observable, int element) const {
        for (std::size_t j = 0; j < campaign_.outputs.size(); ++j) {
            const CampaignOutput& o = campaign_.outputs[j];
            if (o.regime == regime && o.observable == observable && o.element == element) return static_cast<int>(j);
        }
        return -1;
    }

    /// Elements of the observable's axis around x with their weights; empty when x lies outside.
    static std::vector<std::pair<int, double>> axis_weights(const CampaignObservable& o, double x) {
        if (o.axis.empty()) return {{0, 1.0}};
        const double slack = 1e-6 * (o.axis.back() - o.axis.front());
        if (x < o.axis.front() - slack || x > o.axis.back() + slack) return {};
        std::size_t above = 1;
        while (above + 1 < o.axis.size() && o.axis[above] < x - slack) ++above;
        const double t = std::clamp((x - o.axis[above - 1]) / (o.axis[above] - o.axis[above - 1]), 0.0, 1.0);
        if (t < 1e-6) return {{static_cast<int>(above) - 1, 1.0}};
        if (t > 1.0 - 1e-6) return {{static_cast<int>(above), 1.0}};
        return {{static_cast<int>(above) - 1, 1.0 - t}, {static_cast<int>(above), t}};
    }

    std::string region_of(const std::string& observable, double x, const CampaignObservable& o) const {
        for (const Region& r : experiment_.regions)
            if (r.observable == observable && x >= r.lower - 1e-9 && x < r.upper - 1e-9) return r.name;
        const bool has_own = std::any_of(experiment_.regions.begin(), experiment_.regions.end(), [&](const Region& r) { return r.observable == observable; });
        if (has_own) return "rest";
        if (o.axis.empty()) return "";
        const double t = (x - o.axis.front()) / (o.axis.back() - o.axis.front());
        return t < 1.0 / 3.0 ? "first third" : t < 2.0 / 3.0 ? "middle third" : "last third";
    }

    void add(DataSet& set, int index, const Measurement& m, std::vector<Eigen::RowVectorXd>& operators, std::vector<Eigen::RowVectorXd>& curves) {
        const int observable = observable_of(m);
        const CampaignObservable& o = campaign_.description.observables[static_cast<std::size_t>(observable)];
        if (o.axis.empty() != m.axis.empty())
            throw bad_input("'" + m.name + "' is " + (m.axis.empty() ? "a number, and the campaign has a profile" : "a profile, and the campaign has a number"),
                            "measure the same thing", m.place);
        const double factor = conversion(m.unit, o.unit, "'" + m.name + "'", m.place);
        const double axis_factor = m.axis.empty() ? 1.0 : conversion(m.axis_unit, o.axis_unit, "the axis of '" + m.name + "'", m.place);
        const double level = level_of(campaign_, m);
        const RegimeWeights regimes = regime_weights(campaign_, level);
        int outside = 0;
        for (std::size_t i = 0; i < m.value.size(); ++i) {
            const double x = m.axis.empty() ? 0.0 : m.axis[i] * axis_factor;
            const auto elements = axis_weights(o, x);
            Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(campaign_.output.cols()), linear = row;
            bool known = !elements.empty();
            const auto fill = [&](Eigen::RowVectorXd& to, const std::vector<std::pair<int, double>>& weights) {
                for (const auto& [regime, w] : weights)
                    for (const auto& [element, v] : elements) {
                        const int j = output_index(regime, observable, element);
                        if (j < 0)
                            known = false;
                        else
                            to[j] += w * v;
                    }
            };
            fill(row, regimes.quadratic);
            fill(linear, regimes.linear);
            if (!known) {
                ++outside;
                continue;
            }
            DataPoint p;
            p.measurement = index;
            p.observable = observable;
            p.axis = x;
            p.level = level;
            p.regime = m.regime;
            p.value = m.value[i] * factor;
            p.uncertainty = m.uncertainty[i] * factor;
            p.offset_uncertainty = m.offset_uncertainty * factor;
            p.tolerance = std::isnan(m.tolerance) ? o.tolerance : m.tolerance * factor;
            p.group = group_of(set, o.name, region_of(o.name, x, o), m.regime);
            set.groups[static_cast<std::size_t>(p.group)].points.push_back(static_cast<int>(set.points.size()));
            set.points.push_back(p);
            operators.push_back(row);
            curves.push_back(row - linear);
        }
        if (outside == static_cast<int>(m.value.size()))
            throw bad_input("no point of '" + m.name + "' lies where the campaign has results", "check axis, axis_unit and regime", m.place);
        if (outside > 0) notes_.push_back(std::to_string(outside) + " points of '" + m.name + "' lie outside the campaign's axis and are not used");
        if (regimes.quadratic.size() > 1)
            notes_.push_back("'" + m.name + "' lies between regimes of the campaign: interpolated, with half of the quadratic term as one standard deviation");
    }

    static int group_of(DataSet& set, const std::string& observable, const std::string& region, const std::string& regime) {
        for (std::size_t g = 0; g < set.groups.size(); ++g)
            if (set.groups[g].observable == observable && set.groups[g].region == region && set.groups[g].regime == regime) return static_cast<int>(g);
        Group group{observable, observable, region, regime, {}};
        if (!region.empty()) group.name += ", " + region;
        if (!regime.empty()) group.name += ", " + regime;
        set.groups.push_back(group);
        return static_cast<int>(set.groups.size()) - 1;
    }

    void add_covariances(DataSet& set) const {
        const auto n = static_cast<Eigen::Index>(set.points.size());
        set.measurement_covariance = Eigen::MatrixXd::Zero(n, n);
        set.tolerance_covariance = Eigen::MatrixXd::Zero(n, n);
        const double rho = experiment_.settings.tolerance_correlation;
        for (Eigen::Index a = 0; a < n; ++a)
            for (Eigen::Index b = 0; b < n; ++b) {
                const DataPoint &p = set.points[static_cast<std::size_t>(a)], &q = set.points[static_cast<std::size_t>(b)];
                if (a == b) set.measurement_covariance(a, b) += p.uncertainty * p.uncertainty;
                const std::string &one = experiment_.measurements[static_cast<std::size_t>(p.measurement)].instrument,
                                  &other = experiment_.measurements[static_cast<std::size_t>(q.measurement)].instrument;
                const bool together = p.measurement == q.measurement || (p.observable == q.observable && !one.empty() && one == other);
                if (together) set.measurement_covariance(a, b) += p.offset_uncertainty * q.offset_uncertainty;
                const double correlation = a == b ? 1.0 : p.group == q.group ? rho : 0.0;
                set.tolerance_covariance(a, b) = 0.25 * p.tolerance * q.tolerance * correlation;  // t is two standard deviations
            }
    }

    const Campaign& campaign_;
    const Experiment& experiment_;
    std::vector<std::string>& notes_;
};

/// The same picture, or the same numbers, in two measurements: found in the wild, and never right.
void refuse_duplicates(const Experiment& e) {
    for (std::size_t i = 0; i < e.measurements.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
            const Measurement &a = e.measurements[i], &b = e.measurements[j];
            const bool same_picture = !a.picture.empty() && a.picture == b.picture && a.observable == b.observable;
            const bool same_data = !a.data_sha256.empty() && a.data_sha256 == b.data_sha256;
            const bool same_name = a.observable == b.observable && a.regime == b.regime && a.axis == b.axis && a.instrument == b.instrument;
            if (same_picture || same_data)
                throw bad_input("'" + a.name + "' and '" + b.name + "' are the same " + (same_picture ? "picture" : "data") +
                                    (a.role != b.role ? ", once fitted and once held out" : ""),
                                "one of them is filed under the wrong name: find out which, or remove one", a.place);
            if (same_name)
                throw bad_input("'" + a.name + "' is measured twice in the same regime by the same instrument" +
                                    (a.role != b.role ? ", once fitted and once held out" : ""),
                                "average the repeats (repeats = n, uncertainty of the mean), or name different instruments", a.place);
        }
}

}  // namespace

Problem make_problem(std::shared_ptr<const Model> model, const Experiment& experiment, FewData few) {
    Problem p;
    p.model = std::move(model);
    p.experiment = experiment;
    refuse_duplicates(experiment);
    const Campaign& c = p.model->campaign;
    Builder builder(c, experiment, p.notes);
    p.fitted = builder.build(false);
    p.held_out = builder.build(true);
    if (p.fitted.empty()) throw bad_input("every measurement is held out", "fit at least one", {experiment.file});
    for (const DataPoint& point : p.fitted.points)
        p.is_calibration.push_back(experiment.measurements[static_cast<std::size_t>(point.measurement)].role == MeasurementRole::calibration);

    p.phi_lower = Eigen::VectorXd::Zero(c.parameter.cols());
    p.phi_upper = Eigen::VectorXd::Ones(c.parameter.cols());
    for (const CalibrationParameter& one : experiment.parameters) {
        const auto& known = c.description.parameters;
        const auto found = std::find_if(known.begin(), known.end(), [&](const CampaignParameter& k) { return k.name == one.name; });
        if (found == known.end()) throw bad_input("'" + one.name + "' is no parameter of the campaign", "correct the name", one.place);
        const auto i = found - known.begin();
        if (found->logarithmic && one.lower <= 0.0) throw bad_input("the range of '" + one.name + "' must be positive", "its scale is logarithmic", one.place);
        const double low = campaign::unit_coordinate(*found, one.lower), high = campaign::unit_coordinate(*found, one.upper);
        if (low < -1e-9 || high > 1.0 + 1e-9)
            throw bad_input(
                "the range of '" + one.name + "' leaves the campaign's, " + format_quantity(found->lower, "") + " to " + format_quantity(found->upper, ""),
                "narrow it, or extend the campaign: nothing is extrapolated", one.place);
        p.phi_lower[i] = low;
        p.phi_upper[i] = one.fixed ? low + 1e-6 : high;  // a known parameter keeps a width that no result can feel
    }
    int unknowns = 0;
    for (Eigen::Index i = 0; i < p.phi_lower.size(); ++i) unknowns += p.phi_upper[i] - p.phi_lower[i] > 1e-5 ? 1 : 0;
    if (few == FewData::refuse && static_cast<int>(p.fitted.points.size()) <= unknowns)
        throw bad_input("there are " + std::to_string(p.fitted.points.size()) + " fitted data for " + std::to_string(unknowns) + " free calibration parameters",
                        "every set of data would fit: measure more, or fix parameters with value = …", {experiment.file});
    return p;
}

}  // namespace pelletlab::diagnosis
