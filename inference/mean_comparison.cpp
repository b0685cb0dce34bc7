#include "inference/mean_comparison.hpp"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "inference/statistics.hpp"

namespace pelletlab::inference {

double student_cdf(double t, double degrees) {
    return boost::math::cdf(boost::math::students_t_distribution<double>(degrees), t);
}

double student_quantile(double p, double degrees) {
    return boost::math::quantile(boost::math::students_t_distribution<double>(degrees), p);
}

Repeats repeats_of(const std::vector<double>& values) {
    Repeats r;
    r.count = static_cast<int>(values.size());
    for (const double v : values) r.mean += v / static_cast<double>(values.size());
    double sum = 0.0;
    for (const double v : values) sum += (v - r.mean) * (v - r.mean);
    r.deviation = r.count > 1 ? std::sqrt(sum / (r.count - 1)) : std::numeric_limits<double>::quiet_NaN();
    return r;
}

MeanDifference mean_difference(const Repeats& a, const Repeats& b, double confidence) {
    for (const Repeats* r : {&a, &b}) {
        if (r->count < 1) throw bad_input("a mean of no values cannot be compared", "give at least one value a side");
        if (r->deviation < 0.0) throw bad_input("a standard deviation is negative", "give the deviation of the repeats");
    }
    const auto known = [](const Repeats& r) { return r.count > 1 && !std::isnan(r.deviation); };
    if (!known(a) && !known(b)) throw bad_input("neither side has repeats, so the scatter is not known", "measure or simulate at least one side twice");
    MeanDifference d;
    d.value = a.mean - b.mean;
    d.pooled = !known(a) || !known(b);
    const double sa = known(a) ? a.deviation : b.deviation, sb = known(b) ? b.deviation : a.deviation;
    const double va = sa * sa / a.count, vb = sb * sb / b.count;
    d.standard_error = std::sqrt(va + vb);
    if (d.pooled) {
        d.degrees = (known(a) ? a.count : b.count) - 1;
    } else {
        const double na = a.count - 1, nb = b.count - 1;
        d.degrees = va + vb > 0.0 ? (va + vb) * (va + vb) / (va * va / na + vb * vb / nb) : na + nb;
    }
    const double reach = student_quantile(0.5 + 0.5 * confidence, d.degrees) * d.standard_error;
    d.lower = d.value - reach;
    d.upper = d.value + reach;
    if (d.standard_error > 0.0)
        d.p = 2.0 * student_cdf(-std::abs(d.value) / d.standard_error, d.degrees);
    else
        d.p = d.value == 0.0 ? 1.0 : 0.0;
    return d;
}

Equivalence test_equivalence(const MeanDifference& d, double margin, double level) {
    if (!(margin > 0.0)) throw bad_input("the margin of an equivalence test must be above 0", "say which difference would not matter");
    Equivalence e;
    e.margin = margin;
    const double reach = student_quantile(1.0 - level, d.degrees) * d.standard_error;
    e.lower = d.value - reach;
    e.upper = d.value + reach;
    const double nearest = margin - std::abs(d.value);  // way to the nearer edge: its one-sided test has the larger p
    if (d.standard_error > 0.0)
        e.p = student_cdf(-nearest / d.standard_error, d.degrees);
    else
        e.p = nearest > 0.0 ? 0.0 : 1.0;
    e.equivalent = e.p < level;
    return e;
}

Agreement agreement_of(const MeanDifference& d, const Equivalence& e, double level) {
    if (e.equivalent) return Agreement::equivalent;
    return d.p < level ? Agreement::differs : Agreement::undecided;
}

int repeats_needed(const MeanDifference& d, const Repeats& a, const Repeats& b, double margin, double level, double power) {
    const double edge = std::abs(margin - std::abs(d.value));
    if (edge < 0.01 * margin) return 0;
    const double sa = std::isnan(a.deviation) ? b.deviation : a.deviation, sb = std::isnan(b.deviation) ? a.deviation : b.deviation;
    const double z = normal_quantile(1.0 - level) + normal_quantile(power);
    return std::max(2, static_cast<int>(std::ceil((sa * sa + sb * sb) * z * z / (edge * edge))));
}

}  // namespace pelletlab::inference
