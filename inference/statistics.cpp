#include "inference/statistics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "core/error.hpp"

namespace pelletlab::inference {

double normal_cdf(double x) {
    return 0.5 * std::erfc(-x / std::numbers::sqrt2);
}

double normal_quantile(double p) {
    if (!(p > 0.0 && p < 1.0)) throw numerical_failure("a normal quantile was asked for at p = " + std::to_string(p));
    constexpr std::array a{-3.969683028665376e+01, 2.209460984245205e+02,  -2.759285104469687e+02,
                           1.383577518672690e+02,  -3.066479806614716e+01, 2.506628277459239e+00};
    constexpr std::array b{-5.447609879822406e+01, 1.615858368580409e+02, -1.556989798598866e+02, 6.680131188771972e+01, -1.328068155288572e+01};
    constexpr std::array c{-7.784894002430293e-03, -3.223964580411365e-01, -2.400758277161838e+00,
                           -2.549732539343734e+00, 4.374664141464968e+00,  2.938163982698783e+00};
    constexpr std::array d{7.784695709041462e-03, 3.224671290700398e-01, 2.445134137142996e+00, 3.754408661907416e+00};
    double x = 0.0;
    const auto tail = [&](double q) {
        return (((((c[0] * q + c[1]) * q + c[2]) * q + c[3]) * q + c[4]) * q + c[5]) / ((((d[0] * q + d[1]) * q + d[2]) * q + d[3]) * q + 1.0);
    };
    if (p < 0.02425) {
        x = tail(std::sqrt(-2.0 * std::log(p)));
    } else if (p > 1.0 - 0.02425) {
        x = -tail(std::sqrt(-2.0 * std::log(1.0 - p)));
    } else {
        const double q = p - 0.5, r = q * q;
        x = (((((a[0] * r + a[1]) * r + a[2]) * r + a[3]) * r + a[4]) * r + a[5]) * q / (((((b[0] * r + b[1]) * r + b[2]) * r + b[3]) * r + b[4]) * r + 1.0);
    }
    const double error = (normal_cdf(x) - p) * std::sqrt(2.0 * std::numbers::pi) * std::exp(0.5 * x * x);
    return x - error / (1.0 + 0.5 * x * error);
}

double chi_squared_survival(double x, double k) {
    if (x <= 0.0) return 1.0;
    const double a = 0.5 * k, z = 0.5 * x;
    const double front = std::exp(a * std::log(z) - z - std::lgamma(a));
    if (z < a + 1.0) {  // series of the lower function
        double term = 1.0 / a, sum = term;
        for (int i = 1; i < 10000 && std::abs(term) > 1e-17 * std::abs(sum); ++i) sum += term *= z / (a + i);
        return std::clamp(1.0 - front * sum, 0.0, 1.0);
    }
    constexpr double tiny = 1e-300;  // Lentz's continued fraction of the upper function
    double b = z + 1.0 - a, c = 1.0 / tiny, d = 1.0 / b, h = d;
    for (int i = 1; i < 10000; ++i) {
        const double an = -i * (i - a);
        b += 2.0;
        d = an * d + b;
        d = 1.0 / (std::abs(d) < tiny ? tiny : d);
        c = b + an / c;
        if (std::abs(c) < tiny) c = tiny;
        h *= d * c;
        if (std::abs(d * c - 1.0) < 1e-15) break;
    }
    return std::clamp(front * h, 0.0, 1.0);
}

double draw_chi_squared(RandomStream& random, double k) {
    double shape = 0.5 * k, boost = 1.0;
    if (shape < 1.0) {  // Gamma(a) = Gamma(a + 1)·U^(1/a)
        boost = std::pow(1.0 - random.uniform(), 1.0 / shape);
        shape += 1.0;
    }
    const double d = shape - 1.0 / 3.0, c = 1.0 / std::sqrt(9.0 * d);
    for (;;) {
        const double x = random.normal(), v = std::pow(1.0 + c * x, 3);
        if (v <= 0.0) continue;
        const double u = 1.0 - random.uniform();
        if (std::log(u) < 0.5 * x * x + d - d * v + d * std::log(v)) return 2.0 * d * v * boost;
    }
}

namespace {

std::vector<std::size_t> ascending(const std::vector<double>& p) {
    std::vector<std::size_t> order(p.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&p](std::size_t a, std::size_t b) { return p[a] < p[b]; });
    return order;
}

}  // namespace

std::vector<bool> false_discovery_control(const std::vector<double>& p, double q, bool dependent) {
    const auto order = ascending(p);
    double penalty = 1.0;
    if (dependent) {
        penalty = 0.0;
        for (std::size_t i = 1; i <= p.size(); ++i) penalty += 1.0 / static_cast<double>(i);
    }
    std::size_t last = 0;  // number of discoveries
    for (std::size_t i = 0; i < p.size(); ++i)
        if (p[order[i]] <= q * static_cast<double>(i + 1) / (static_cast<double>(p.size()) * penalty)) last = i + 1;
    std::vector<bool> discovery(p.size(), false);
    for (std::size_t i = 0; i < last; ++i) discovery[order[i]] = true;
    return discovery;
}

std::vector<bool> expected_false_discovery_control(const std::vector<double>& doubt, double q) {
    const auto order = ascending(doubt);
    std::vector<bool> discovery(doubt.size(), false);
    double sum = 0.0;
    for (std::size_t i = 0; i < doubt.size(); ++i) {
        sum += doubt[order[i]];
        if (sum > q * static_cast<double>(i + 1)) break;  // the mean of ascending numbers only grows
        discovery[order[i]] = true;
    }
    return discovery;
}

std::vector<double> holm(const std::vector<double>& p) {
    const auto order = ascending(p);
    std::vector<double> adjusted(p.size());
    double largest = 0.0;
    for (std::size_t i = 0; i < p.size(); ++i) {
        largest = std::max(largest, std::min(1.0, p[order[i]] * static_cast<double>(p.size() - i)));
        adjusted[order[i]] = largest;
    }
    return adjusted;
}

double reference_p_value(double observed, const std::vector<double>& reference) {
    const auto larger = std::count_if(reference.begin(), reference.end(), [observed](double r) { return r >= observed; });
    return (1.0 + static_cast<double>(larger)) / (1.0 + static_cast<double>(reference.size()));
}

double quantile(std::vector<double> values, double p) {
    if (values.empty()) throw numerical_failure("a quantile of no values was asked for");
    std::sort(values.begin(), values.end());
    const double at = p * static_cast<double>(values.size() - 1);
    const auto low = static_cast<std::size_t>(std::floor(at));
    const std::size_t high = std::min(low + 1, values.size() - 1);
    return values[low] + (at - static_cast<double>(low)) * (values[high] - values[low]);
}

Eigen::VectorXd halton(std::uint64_t i, int dimensions) {
    constexpr std::array primes{2,  3,  5,  7,  11, 13,  17,  19,  23,  29,  31,  37,  41,  43,  47,  53,  59,  61,  67,  71,
                                73, 79, 83, 89, 97, 101, 103, 107, 109, 113, 127, 131, 137, 139, 149, 151, 157, 163, 167, 173};
    if (dimensions > static_cast<int>(primes.size())) throw numerical_failure("more than 40 dimensions of a Halton sequence");
    Eigen::VectorXd x(dimensions);
    for (int d = 0; d < dimensions; ++d) {
        const auto base = static_cast<std::uint64_t>(primes[static_cast<std::size_t>(d)]);
        double value = 0.0, step = 1.0;
        for (std::uint64_t n = i; n > 0; n /= base) {
            step /= static_cast<double>(base);
            value += step * static_cast<double>(n % base);
        }
        x[d] = value;
    }
    return x;
}

double weighted_quantile(std::vector<std::pair<double, double>> values, double p) {
    std::sort(values.begin(), values.end());
    double total = 0.0;
    for (const auto& [value, weight] : values) total += weight;
    double sum = 0.0;
    for (const auto& [value, weight] : values) {
        sum += weight;
        if (sum >= p * total) return value;
    }
    return values.empty() ? std::numeric_limits<double>::quiet_NaN() : values.back().first;
}

CalibrationScore calibration_score(const std::vector<double>& probability, const std::vector<bool>& truth, int bins) {
    CalibrationScore score;
    score.bins.resize(static_cast<std::size_t>(bins));
    const auto n = static_cast<double>(probability.size());
    double share = 0.0;
    for (std::size_t i = 0; i < probability.size(); ++i) {
        auto& bin = score.bins[static_cast<std::size_t>(std::min(bins - 1, static_cast<int>(probability[i] * bins)))];
        ++bin.count;
        bin.mean_probability += probability[i];
        bin.share_true += truth[i] ? 1.0 : 0.0;
        score.brier += std::pow(probability[i] - (truth[i] ? 1.0 : 0.0), 2) / n;
        share += (truth[i] ? 1.0 : 0.0) / n;
    }
    score.climatology_brier = share * (1.0 - share);
    for (auto& bin : score.bins) {
        if (bin.count == 0) continue;
        bin.mean_probability /= bin.count;
        bin.share_true /= bin.count;
        score.expected_error += bin.count / n * std::abs(bin.mean_probability - bin.share_true);
    }
    return score;
}

Share share_of(int hits, int count) {
    Share s{0.0, 0.0, 1.0, hits, count};
    if (count == 0) return s;
    constexpr double z = 1.6448536269514722;  // 90 % interval
    const double n = count, p = hits / n, centre = (p + z * z / (2 * n)) / (1 + z * z / n);
    const double half = z / (1 + z * z / n) * std::sqrt(p * (1 - p) / n + z * z / (4 * n * n));
    s.value = p;
    s.lower = std::max(0.0, centre - half);
    s.upper = std::min(1.0, centre + half);
    return s;
}

}  // namespace pelletlab::inference
