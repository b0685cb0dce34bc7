#include "inference/gaussian.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "inference/statistics.hpp"

namespace pelletlab::inference {

Whitener::Whitener(const Eigen::MatrixXd& covariance) {
    const Eigen::LLT<Eigen::MatrixXd> llt(covariance);
    if (llt.info() != Eigen::Success) throw numerical_failure("a covariance is not positive definite", "give every measurement an uncertainty and a tolerance");
    factor_ = llt.matrixL();
    log_determinant_ = 2.0 * factor_.diagonal().array().log().sum();
}

Eigen::VectorXd Whitener::whiten(const Eigen::VectorXd& v) const {
    return factor_.triangularView<Eigen::Lower>().solve(v);
}

Eigen::MatrixXd Whitener::whiten_columns(const Eigen::MatrixXd& m) const {
    return factor_.triangularView<Eigen::Lower>().solve(m);
}

double log_student_density(double chi2, Eigen::Index n, double log_determinant, double nu) {
    const auto dimensions = static_cast<double>(n);
    if (!std::isfinite(nu)) return -0.5 * (chi2 + log_determinant + dimensions * std::log(2.0 * std::numbers::pi));
    return std::lgamma(0.5 * (nu + dimensions)) - std::lgamma(0.5 * nu) - 0.5 * dimensions * std::log(nu * std::numbers::pi) - 0.5 * log_determinant -
           0.5 * (nu + dimensions) * std::log1p(chi2 / nu);
}

double log_heavy_tailed_likelihood(double chi2, Eigen::Index n, double log_determinant, double nu) {
    const auto dimensions = static_cast<double>(n);
    const double inside = std::isfinite(nu) ? std::min(chi2, dimensions) : chi2;
    double value = -0.5 * (inside + log_determinant + dimensions * std::log(2.0 * std::numbers::pi));
    if (chi2 > inside) value -= 0.5 * (nu + dimensions) * std::log((nu + chi2) / (nu + dimensions));
    return value;
}

double heavy_tailed_weight(double chi2, Eigen::Index n, double nu) {
    const auto dimensions = static_cast<double>(n);
    return std::isfinite(nu) && chi2 > dimensions ? (nu + dimensions) / (nu + chi2) : 1.0;
}

Eigen::VectorXd draw_student(RandomStream& random, Eigen::Index n, double nu) {
    Eigen::VectorXd x(n);
    for (Eigen::Index i = 0; i < n; ++i) x[i] = random.normal();
    return std::isfinite(nu) ? Eigen::VectorXd(x * std::sqrt(nu / draw_chi_squared(random, nu))) : x;
}

Eigen::MatrixXd shrunk_correlation(const Eigen::MatrixXd& z) {
    const auto n = static_cast<double>(z.rows());
    Eigen::MatrixXd unit = z;
    for (Eigen::Index j = 0; j < z.cols(); ++j) unit.col(j) /= std::max(1e-300, std::sqrt(z.col(j).squaredNorm() / n));
    Eigen::MatrixXd r = unit.transpose() * unit / n;
    double variance = 0.0, square = 0.0;
    for (Eigen::Index a = 0; a < z.cols(); ++a)
        for (Eigen::Index b = 0; b < a; ++b) {
            const Eigen::ArrayXd product = unit.col(a).array() * unit.col(b).array();
            variance += (product - r(a, b)).square().sum() / (n * std::max(1.0, n - 1.0));
            square += r(a, b) * r(a, b);
        }
    const double shrink = square > 0.0 ? std::clamp(variance / square, 0.0, 1.0) : 1.0;
    r *= 1.0 - shrink;
    r.diagonal().setOnes();
    return r;
}

}  // namespace pelletlab::inference
