#include "inference/minimise.hpp"

#include <cmath>

namespace pelletlab::inference {

Minimum minimise(const std::function<double(const Eigen::VectorXd&, Eigen::VectorXd&)>& f, const Eigen::VectorXd& start, double tolerance, int largest_count) {
    Eigen::VectorXd gradient(start.size()), new_gradient(start.size());
    Minimum best{start, f(start, gradient), 1};
    Eigen::MatrixXd inverse = Eigen::MatrixXd::Identity(start.size(), start.size());
    bool scaled = false;
    while (best.evaluations < largest_count) {
        Eigen::VectorXd step = -inverse * gradient;
        if (step.dot(gradient) >= 0.0) {  // lost descent by rounding: start again along the gradient
            inverse.setIdentity();
            step = -gradient;
        }
        const double longest = step.cwiseAbs().maxCoeff();
        if (longest > 1.0) step /= longest;  // the unknowns are logarithms: more than a factor e a step is never wise
        double length = 1.0, value = 0.0;
        Eigen::VectorXd x;
        bool found = false;
        for (int i = 0; i < 12 && best.evaluations < largest_count; ++i, length *= 0.4) {
            x = best.x + length * step;
            value = f(x, new_gradient);
            ++best.evaluations;
            if (std::isfinite(value) && value <= best.value + 1e-4 * length * step.dot(gradient)) {
                found = true;
                break;
            }
        }
        if (!found) break;
        const Eigen::VectorXd s = x - best.x, y = new_gradient - gradient;
        const double gain = best.value - value, sy = s.dot(y);
        best.x = x;
        best.value = value;
        gradient = new_gradient;
        if (sy > 1e-12 * s.norm() * y.norm()) {
            if (!scaled) inverse *= sy / y.squaredNorm();
            scaled = true;
            const Eigen::VectorXd hy = inverse * y;
            inverse += (1.0 + y.dot(hy) / sy) / sy * (s * s.transpose()) - (hy * s.transpose() + s * hy.transpose()) / sy;
        }
        if (gain < tolerance) break;
    }
    return best;
}

}  // namespace pelletlab::inference
