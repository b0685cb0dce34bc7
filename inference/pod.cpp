#include "inference/pod.hpp"

#include <Eigen/SVD>
#include <algorithm>

#include "core/error.hpp"

namespace pelletlab::inference {

Eigen::VectorXd PodBasis::scores(const Eigen::VectorXd& y) const {
    return modes.transpose() * (weight.array().square() * (y - mean).array()).matrix();
}

PodBasis make_pod(const Eigen::MatrixXd& outputs, const Eigen::VectorXd& weight, double keep, int largest) {
    if (outputs.rows() < 2) throw numerical_failure("a basis needs at least two runs", "use a larger campaign");
    PodBasis basis;
    basis.mean = outputs.colwise().mean();
    basis.weight = weight;
    const Eigen::MatrixXd centred = (outputs.rowwise() - basis.mean.transpose()) * weight.asDiagonal();
    const Eigen::BDCSVD<Eigen::MatrixXd> svd(centred, Eigen::ComputeThinV);
    const Eigen::VectorXd square = svd.singularValues().array().square();
    const double total = std::max(square.sum(), 1e-300);
    Eigen::Index count = 0;
    while (count < square.size() && count < largest && basis.kept < keep && square[count] > 1e-14 * total) basis.kept += square[count++] / total;
    count = std::max<Eigen::Index>(count, 1);
    basis.modes = weight.cwiseInverse().asDiagonal() * svd.matrixV().leftCols(count);
    basis.singular_share = square.head(count) / total;
    return basis;
}

}  // namespace pelletlab::inference
