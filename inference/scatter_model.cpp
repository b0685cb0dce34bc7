#include "inference/scatter_model.hpp"

#include <cmath>

#include "inference/gaussian.hpp"
#include "inference/minimise.hpp"

namespace pelletlab::inference {

namespace {

Eigen::VectorXd features(const Eigen::VectorXd& phi, const Eigen::VectorXd& theta) {
    const Eigen::VectorXd size = theta.cwiseAbs();
    Eigen::VectorXd x(2 + 2 * phi.size() + theta.size());
    x << 1.0, phi, phi.cwiseAbs2(), size, 0.5 * (size.sum() * size.sum() - size.squaredNorm());
    return x;
}

}  // namespace

double ScatterModel::factor(const Eigen::VectorXd& phi, const Eigen::VectorXd& theta) const {
    return std::exp(coefficients.dot(features(phi, theta)));
}

double ScatterModel::relative(const Eigen::VectorXd& phi, const Eigen::VectorXd& theta) const {
    return std::exp(coefficients.dot(features(phi, theta)) - middle);
}

ScatterModel fit_scatter(const SpokeInputs& runs, const std::vector<double>& distance, Eigen::Index dimensions, const ScatterOptions& options) {
    const auto q = static_cast<double>(dimensions);
    Eigen::MatrixXd x(runs.runs(), 2 + 2 * runs.phi.cols() + runs.theta.cols());
    for (Eigen::Index i = 0; i < runs.runs(); ++i) x.row(i) = features(runs.phi.row(i).transpose(), runs.theta.row(i).transpose()).transpose();
    ScatterModel best;
    double best_value = 1e300;
    for (const double nu : {4.0, 6.0, 9.0, 14.0, 25.0, 60.0, 200.0}) {
        if (options.normal && nu < 200.0) continue;
        const auto f = [&](const Eigen::VectorXd& beta, Eigen::VectorXd& gradient) {
            const double precision = 1.0 / (options.width * options.width);
            double value = 0.5 * beta.tail(beta.size() - 1).squaredNorm() * precision;
            gradient = beta * precision;
            gradient[0] = 0.0;
            for (Eigen::Index i = 0; i < x.rows(); ++i) {
                const double log_scale = x.row(i).dot(beta), d = distance[static_cast<std::size_t>(i)] * std::exp(-log_scale);
                value -= options.weight * log_student_density(d, dimensions, q * log_scale, nu);
                gradient += options.weight * (0.5 * q - 0.5 * (nu + q) * d / (nu + d)) * x.row(i).transpose();
            }
            return value;
        };
        const Minimum minimum = minimise(f, Eigen::VectorXd::Zero(x.cols()), 1e-4, 200);
        if (minimum.value < best_value) {
            best_value = minimum.value;
            best.coefficients = minimum.x;
            best.nu = nu;
        }
    }
    best.middle = (x * best.coefficients).mean();
    return best;
}

}  // namespace pelletlab::inference
