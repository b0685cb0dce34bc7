#include "inference/spoke_kernel.hpp"

#include <cmath>

namespace pelletlab::inference {

namespace {

/// One effect over all pairs of runs: the curved bracket, its derivative by log ℓ, and θθ′.
struct EffectParts {
    Eigen::ArrayXXd product, bracket, derivative;
};

EffectParts effect_parts(const Eigen::VectorXd& theta, double length) {
    const double inverse = 1.0 / (length * length);
    const Eigen::ArrayXXd column = theta.array().replicate(1, theta.size());
    const Eigen::ArrayXXd row = column.transpose();
    const Eigen::ArrayXXd difference = (column - row).square() * inverse, sum = (column.square() + row.square()) * inverse;
    const Eigen::ArrayXXd near = (-0.5 * difference).exp(), far = (-0.5 * sum).exp();
    return {column * row, near - far, near * difference - far * sum};
}

Eigen::ArrayXXd square_differences(const Eigen::VectorXd& x) {
    const Eigen::ArrayXXd column = x.array().replicate(1, x.size());
    return (column - column.transpose()).square();
}

}  // namespace

Eigen::VectorXd SpokeLayout::prior_mean() const {
    Eigen::VectorXd m(size());
    m[linear()] = std::log(0.5);
    m[base()] = std::log(0.3);
    for (Eigen::Index i = 0; i < parameters; ++i) m[length(i)] = std::log(1.0);
    for (Eigen::Index k = 0; k < effects; ++k) {
        m[slope(k)] = std::log(0.5);
        m[curve(k)] = std::log(0.2);
        m[effect_length(k)] = std::log(0.7);
    }
    m[stretch()] = std::log(1.5);
    m[pair()] = std::log(0.1);
    m[noise()] = std::log(0.01);
    return m;
}

Eigen::VectorXd SpokeLayout::prior_width() const {
    Eigen::VectorXd w = Eigen::VectorXd::Constant(size(), 2.0);
    for (Eigen::Index i = 0; i < parameters; ++i) w[length(i)] = 0.8;
    for (Eigen::Index k = 0; k < effects; ++k) w[effect_length(k)] = 0.5;
    w[stretch()] = 0.5;
    return w;
}

Eigen::MatrixXd spoke_covariance(const SpokeLayout& layout, const Eigen::VectorXd& logs, const SpokeInputs& x, std::vector<Eigen::MatrixXd>* derivatives) {
    const Eigen::Index n = x.runs();
    const Eigen::VectorXd value = logs.array().exp();
    const double stretch_square = std::pow(value[layout.stretch()], 2);
    std::vector<Eigen::ArrayXXd> scaled(static_cast<std::size_t>(layout.parameters));
    Eigen::ArrayXXd distance = Eigen::ArrayXXd::Zero(n, n);
    for (Eigen::Index i = 0; i < layout.parameters; ++i) {
        auto& one = scaled[static_cast<std::size_t>(i)];
        one = square_differences(x.phi.col(i)) / std::pow(value[layout.length(i)], 2);
        distance += one;
    }
    const Eigen::ArrayXXd linear = value[layout.linear()] * (x.phi * x.phi.transpose()).array();
    const Eigen::ArrayXXd base = value[layout.base()] * (-0.5 * distance).exp();
    const Eigen::ArrayXXd field = (-0.5 / stretch_square * distance).exp();

    Eigen::ArrayXXd effects = Eigen::ArrayXXd::Zero(n, n), sum = Eigen::ArrayXXd::Zero(n, n), sum_square = Eigen::ArrayXXd::Zero(n, n);
    std::vector<EffectParts> parts;
    for (Eigen::Index k = 0; k < layout.effects; ++k) {
        parts.push_back(effect_parts(x.theta.col(k), value[layout.effect_length(k)]));
        const EffectParts& e = parts.back();
        effects += value[layout.slope(k)] * e.product + value[layout.curve(k)] * e.bracket;
        const Eigen::ArrayXXd unit = e.product + e.bracket;
        sum += unit;
        sum_square += unit.square();
    }
    const Eigen::ArrayXXd pairs = value[layout.pair()] * 0.5 * (sum.square() - sum_square);  // Σ_{k<l} b_k b_l
    Eigen::MatrixXd covariance = (spoke_constant_variance + linear + base + (effects + pairs) * field).matrix();
    covariance.diagonal() += value[layout.noise()] * x.scatter;
    if (derivatives == nullptr) return covariance;

    derivatives->assign(static_cast<std::size_t>(layout.size()), Eigen::MatrixXd());
    const auto at = [derivatives](Eigen::Index i) -> Eigen::MatrixXd& { return (*derivatives)[static_cast<std::size_t>(i)]; };
    const Eigen::ArrayXXd effect_field = (effects + pairs) * field;
    at(layout.linear()) = linear.matrix();
    at(layout.base()) = base.matrix();
    for (Eigen::Index i = 0; i < layout.parameters; ++i)
        at(layout.length(i)) = ((base + effect_field / stretch_square) * scaled[static_cast<std::size_t>(i)]).matrix();
    for (Eigen::Index k = 0; k < layout.effects; ++k) {
        const EffectParts& e = parts[static_cast<std::size_t>(k)];
        at(layout.slope(k)) = (value[layout.slope(k)] * e.product * field).matrix();
        at(layout.curve(k)) = (value[layout.curve(k)] * e.bracket * field).matrix();
        const Eigen::ArrayXXd others = sum - (e.product + e.bracket);
        at(layout.effect_length(k)) = ((value[layout.curve(k)] + value[layout.pair()] * others) * e.derivative * field).matrix();
    }
    at(layout.stretch()) = (effect_field * distance / stretch_square).matrix();
    at(layout.pair()) = (pairs * field).matrix();
    at(layout.noise()) = Eigen::MatrixXd((value[layout.noise()] * x.scatter).asDiagonal());
    return covariance;
}

SpokeEvaluator::SpokeEvaluator(const SpokeLayout& layout, const Eigen::VectorXd& logs, const SpokeInputs& x) : x_(x) {
    const Eigen::VectorXd value = logs.array().exp();
    linear_ = value[layout.linear()];
    base_ = value[layout.base()];
    stretch_square_ = std::pow(value[layout.stretch()], 2);
    pair_ = value[layout.pair()];
    noise_ = value[layout.noise()];
    inverse_length_square_ = value.segment(2, layout.parameters).array().square().inverse();
    slope_.resize(layout.effects);
    curve_.resize(layout.effects);
    effect_inverse_square_.resize(layout.effects);
    at_zero_.resize(x.runs(), layout.effects);
    for (Eigen::Index k = 0; k < layout.effects; ++k) {
        slope_[k] = value[layout.slope(k)];
        curve_[k] = value[layout.curve(k)];
        effect_inverse_square_[k] = std::pow(value[layout.effect_length(k)], -2);
        at_zero_.col(k) = (-0.5 * effect_inverse_square_[k] * x.theta.col(k).array().square()).exp();
    }
}

Eigen::ArrayXd SpokeEvaluator::bracket(double theta, Eigen::Index k) const {
    const double c = -0.5 * effect_inverse_square_[k];
    return (c * (x_.theta.col(k).array() - theta).square()).exp() - std::exp(c * theta * theta) * at_zero_.col(k);
}

Eigen::ArrayXd SpokeEvaluator::covariances(const Eigen::VectorXd& phi, const Eigen::VectorXd& theta) const {
    Eigen::ArrayXd distance = Eigen::ArrayXd::Zero(x_.runs());
    for (Eigen::Index i = 0; i < phi.size(); ++i) distance += inverse_length_square_[i] * (x_.phi.col(i).array() - phi[i]).square();
    Eigen::ArrayXd k = spoke_constant_variance + linear_ * (x_.phi * phi).array() + base_ * (-0.5 * distance).exp();
    Eigen::ArrayXd effects, sum, sum_square;
    int active = 0;
    for (Eigen::Index e = 0; e < theta.size(); ++e) {
        if (theta[e] == 0.0) continue;
        const Eigen::ArrayXd product = theta[e] * x_.theta.col(e).array(), curved = bracket(theta[e], e), unit = product + curved;
        const Eigen::ArrayXd own = slope_[e] * product + curve_[e] * curved;
        if (active++ == 0) {
            effects = own;
            sum = unit;
            sum_square = unit.square();
        } else {
            effects += own;
            sum += unit;
            sum_square += unit.square();
        }
    }
    if (active == 0) return k;
    if (active > 1) effects += 0.5 * pair_ * (sum.square() - sum_square);
    return k + effects * (-0.5 / stretch_square_ * distance).exp();
}

double SpokeEvaluator::variance(const Eigen::VectorXd& phi, const Eigen::VectorXd& theta) const {
    double effects = 0.0, sum = 0.0, sum_square = 0.0;
    for (Eigen::Index e = 0; e < theta.size(); ++e) {
        const double square = theta[e] * theta[e], curved = 1.0 - std::exp(-effect_inverse_square_[e] * square), unit = square + curved;
        effects += slope_[e] * square + curve_[e] * curved;
        sum += unit;
        sum_square += unit * unit;
    }
    return spoke_constant_variance + linear_ * phi.squaredNorm() + base_ + effects + 0.5 * pair_ * (sum * sum - sum_square);
}

}  // namespace pelletlab::inference
