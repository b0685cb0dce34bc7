#include "shapegen/detail/lbfgs.hpp"

#include <algorithm>
#include <deque>

#include "core/progress.hpp"

namespace pelletlab::shapegen::detail {

namespace {

using Eigen::VectorXd;

struct Pair {
    VectorXd step, change;
    double curvature;  // 1 / (step · change)
};

// Two-loop recursion: −(inverse Hessian) · gradient.
VectorXd direction(const VectorXd& gradient, const std::deque<Pair>& pairs, const Precondition& precondition) {
    VectorXd q = -gradient;
    std::vector<double> weight(pairs.size());
    for (std::size_t k = pairs.size(); k-- > 0;) {
        weight[k] = pairs[k].curvature * pairs[k].step.dot(q);
        q -= weight[k] * pairs[k].change;
    }
    precondition(q);
    for (std::size_t k = 0; k < pairs.size(); ++k) q += (weight[k] - pairs[k].curvature * pairs[k].change.dot(q)) * pairs[k].step;
    return q;
}

// Components that a bound holds back count for nothing.
void mask(VectorXd& gradient, const VectorXd& x, const VectorXd& lower) {
    for (Eigen::Index i = 0; i < x.size(); ++i) {
        if (x[i] <= lower[i] && gradient[i] > 0.0) gradient[i] = 0.0;
    }
}

}  // namespace

MinimiserResult minimise(VectorXd& x, const VectorXd& lower, const Objective& objective, const Precondition& precondition, const MinimiserSettings& settings) {
    MinimiserResult result;
    x = x.cwiseMax(lower);
    VectorXd gradient(x.size()), next_gradient(x.size());
    result.loss = objective(x, gradient, true);
    mask(gradient, x, lower);
    std::deque<Pair> pairs;
    int idle = 0;
    double recent_gain = 0.0;
    for (; result.iterations < settings.iterations; ++result.iterations) {
        throw_if_interrupted();
        VectorXd step = direction(gradient, pairs, precondition);
        double slope = gradient.dot(step);
        if (!(slope < 0.0)) {
            pairs.clear();
            step = direction(gradient, pairs, precondition);
            slope = gradient.dot(step);
            if (!(slope < 0.0)) {
                result.converged = true;
                return result;
            }
        }
        const double longest = step.cwiseAbs().maxCoeff();
        double t = longest > settings.longest_step ? settings.longest_step / longest : 1.0;
        const bool refresh = (result.iterations + 1) % settings.metric_every == 0;
        VectorXd next;
        double loss = 0.0;
        bool lower_loss = false;
        for (int attempt = 0; attempt < 8 && !lower_loss; ++attempt) {
            next = (x + t * step).cwiseMax(lower);
            loss = objective(next, next_gradient, refresh);
            lower_loss = loss <= result.loss + 1e-4 * t * slope;
            t *= 0.5;
        }
        if (!lower_loss) {
            if (pairs.empty()) {  // not even along the plain gradient: the loss is flat to rounding
                result.converged = true;
                return result;
            }
            pairs.clear();
            continue;
        }
        mask(next_gradient, next, lower);
        Pair pair{next - x, next_gradient - gradient, 0.0};
        const double product = pair.step.dot(pair.change);
        if (product > 1e-12 * pair.step.norm() * pair.change.norm()) {
            pair.curvature = 1.0 / product;
            pairs.push_back(std::move(pair));
            if (pairs.size() > settings.memory) pairs.pop_front();
        }
        const double gain = result.loss - loss;
        x = next;
        gradient = next_gradient;
        result.loss = loss;
        recent_gain = 0.6 * recent_gain + 0.4 * gain;
        if (result.iterations >= 4 && loss - 4.0 * recent_gain > settings.give_up_above) return result;
        idle = gain < settings.tolerance * loss ? idle + 1 : 0;
        if (idle >= 3) {
            ++result.iterations;
            result.converged = true;
            return result;
        }
    }
    return result;
}

}  // namespace pelletlab::shapegen::detail
