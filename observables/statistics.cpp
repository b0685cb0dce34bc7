#include "observables/statistics.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/observables.hpp"

namespace pelletlab::observables {

namespace {

constexpr std::size_t fewest_blocks = 5;

double naive_standard_error(const std::vector<double>& values) {
    const double n = static_cast<double>(values.size());
    double mean = 0.0;
    for (const double value : values) mean += value;
    mean /= n;
    double squares = 0.0;
    for (const double value : values) squares += (value - mean) * (value - mean);
    // c4: mean of the standard deviation of n normal values over its true value, Γ(n/2) √(2/(n−1)) / Γ((n−1)/2).
    const double c4 = std::exp(std::lgamma(0.5 * n) - std::lgamma(0.5 * (n - 1.0))) * std::sqrt(2.0 / (n - 1.0));
    return std::sqrt(squares / (n - 1.0) / n) / c4;
}

}  // namespace

double percentile(std::vector<double> values, double fraction) {
    if (values.empty()) throw bad_input("a percentile of no values was asked for");
    std::sort(values.begin(), values.end());
    const double index = fraction * static_cast<double>(values.size() - 1);
    const auto lower = static_cast<std::size_t>(std::floor(index));
    const std::size_t upper = std::min(lower + 1, values.size() - 1);
    return values[lower] + (values[upper] - values[lower]) * (index - static_cast<double>(lower));
}

LineFit fit_line(std::span<const double> x, std::span<const double> y) {
    LineFit fit{not_known, not_known, 0};
    double sum_x = 0.0, sum_y = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        if (!std::isfinite(y[i])) continue;
        sum_x += x[i];
        sum_y += y[i];
        ++fit.points;
    }
    if (fit.points < 2) return fit;
    const double mean_x = sum_x / static_cast<double>(fit.points);
    const double mean_y = sum_y / static_cast<double>(fit.points);
    double xx = 0.0, xy = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        if (!std::isfinite(y[i])) continue;
        xx += (x[i] - mean_x) * (x[i] - mean_x);
        xy += (x[i] - mean_x) * (y[i] - mean_y);
    }
    if (xx <= 0.0) return fit;
    fit.slope = xy / xx;
    fit.intercept = mean_y - fit.slope * mean_x;
    return fit;
}

double mean_of(std::span<const double> values) {
    double sum = 0.0;
    std::size_t count = 0;
    for (const double value : values)
        if (std::isfinite(value)) {
            sum += value;
            ++count;
        }
    return count > 0 ? sum / static_cast<double>(count) : not_known;
}

double standard_error(std::span<const double> series) {
    std::vector<double> blocks;
    std::copy_if(series.begin(), series.end(), std::back_inserter(blocks), [](double value) { return std::isfinite(value); });
    if (blocks.size() < fewest_blocks) return not_known;
    double largest = 0.0;
    while (blocks.size() >= fewest_blocks) {
        largest = std::max(largest, naive_standard_error(blocks));
        // With an odd number of blocks the first one is dropped: the later ones are further from any remaining transient.
        const std::size_t odd = blocks.size() % 2;
        std::vector<double> pairs(blocks.size() / 2);
        for (std::size_t i = 0; i < pairs.size(); ++i) pairs[i] = 0.5 * (blocks[odd + 2 * i] + blocks[odd + 2 * i + 1]);
        blocks = std::move(pairs);
    }
    return largest;
}

}  // namespace pelletlab::observables
