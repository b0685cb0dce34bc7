#include "solver/detail/damping_calibration.hpp"

#include <cmath>

namespace pelletlab::solver::detail {

namespace {

struct Motion {
    double x, v;
};

/// Rebound speed / impact speed of x'' = −x^(3/2) − α x^(1/4) x', x'(0) = 1, when the force stays zero once it has become zero on the way back.
/// Time is t = τ⁴, which takes the root's singularity at the first touch away; classical Runge–Kutta of fourth order in τ.
double restitution_without_tension(double alpha) {
    const auto rate = [alpha](double tau, const Motion& m) {
        const double root = std::sqrt(std::max(m.x, 0.0)), stretch = 4.0 * tau * tau * tau;
        return Motion{stretch * m.v, stretch * -(m.x * root + alpha * std::sqrt(root) * m.v)};
    };
    const auto force = [alpha](const Motion& m) { return std::pow(m.x, 1.25) + alpha * m.v; };
    const double h = 5e-4;
    Motion m{0.0, 1.0};
    for (int k = 0; k < 1000000; ++k) {
        const double tau = h * k;
        const Motion a = rate(tau, m), b = rate(tau + 0.5 * h, {m.x + 0.5 * h * a.x, m.v + 0.5 * h * a.v});
        const Motion c = rate(tau + 0.5 * h, {m.x + 0.5 * h * b.x, m.v + 0.5 * h * b.v}), d = rate(tau + h, {m.x + h * c.x, m.v + h * c.v});
        const Motion next{m.x + h / 6.0 * (a.x + 2.0 * b.x + 2.0 * c.x + d.x), m.v + h / 6.0 * (a.v + 2.0 * b.v + 2.0 * c.v + d.v)};
        if (next.v < 0.0 && (next.x <= 0.0 || force(next) <= 0.0)) {
            if (next.x <= 0.0) return -next.v;
            const double before = force(m), after = force(next);
            return -(m.v + (next.v - m.v) * before / (before - after));
        }
        m = next;
    }
    return 0.0;
}

}  // namespace

double damping_without_tension(double restitution) {
    if (restitution >= 1.0) return 0.0;
    double low = 0.0, high = 1.0;
    while (restitution_without_tension(high) > restitution) low = high, high *= 2.0;
    for (int k = 0; k < 60 && high - low > 1e-13 * high; ++k) {
        const double middle = 0.5 * (low + high);
        (restitution_without_tension(middle) > restitution ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

}  // namespace pelletlab::solver::detail
