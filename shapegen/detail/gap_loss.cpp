#include "shapegen/detail/gap_loss.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/parallel.hpp"

namespace pelletlab::shapegen::detail {

VectorXd pack(std::span<const Sphere> spheres) {
    VectorXd x(static_cast<Eigen::Index>(4 * spheres.size()));
    for (std::size_t i = 0; i < spheres.size(); ++i) {
        const auto k = static_cast<Eigen::Index>(4 * i);
        x.segment<3>(k) = spheres[i].centre;
        x[k + 3] = spheres[i].radius;
    }
    return x;
}

std::vector<Sphere> unpack(const VectorXd& x) {
    std::vector<Sphere> spheres(static_cast<std::size_t>(x.size()) / 4);
    for (std::size_t i = 0; i < spheres.size(); ++i) {
        const auto k = static_cast<Eigen::Index>(4 * i);
        spheres[i] = {x.segment<3>(k), x[k + 3]};
    }
    return spheres;
}

void BlockMetric::factorise(double damping) {
    double trace = 0.0;
    for (const auto& block : blocks) trace += block.trace();
    const double shift = blocks.empty() ? 0.0 : damping * trace / (4.0 * static_cast<double>(blocks.size()));
    inverse_.resize(blocks.size());
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        Eigen::Matrix4d damped = blocks[i];
        damped.diagonal().array() += shift + 1e-3 * blocks[i].trace();
        inverse_[i] = damped.inverse();
    }
    solved_.clear();
    factor_.clear();
    for (std::size_t k = 0; k < rows.size(); ++k) {
        VectorXd solved = rows[k];
        apply_first(solved, k);
        factor_.push_back(scales[k] / (1.0 + scales[k] * rows[k].dot(solved)));
        solved_.push_back(std::move(solved));
    }
}

void BlockMetric::apply_first(VectorXd& q, std::size_t terms) const {
    for (std::size_t i = 0; i < inverse_.size(); ++i) {
        const auto k = static_cast<Eigen::Index>(4 * i);
        const Eigen::Vector4d part = q.segment<4>(k);
        q.segment<4>(k) = inverse_[i] * part;
    }
    // With solved_j = M_j⁻¹ v_j: v_j · M_j⁻¹ q is what the terms before j leave, so the corrections follow one another.
    for (std::size_t j = 0; j < terms; ++j) q -= (factor_[j] * rows[j].dot(q)) * solved_[j];
}

void BlockMetric::apply(VectorXd& q) const {
    apply_first(q, solved_.size());
}

namespace {

constexpr double widest_margin = 0.04;  // in units of the body's size

std::vector<std::uint32_t> all_of(std::size_t n) {
    std::vector<std::uint32_t> list(n);
    std::iota(list.begin(), list.end(), 0u);
    return list;
}

}  // namespace

GapLoss::GapLoss(const SampleBlocks& samples, std::span<const Sphere> spheres)
    : GapLoss(samples, spheres, all_of(spheres.size()), all_of(samples.block_count())) {}

GapLoss::GapLoss(const SampleBlocks& samples, std::span<const Sphere> spheres, std::vector<std::uint32_t> free_spheres, std::vector<std::uint32_t> blocks)
    : samples_(samples), spheres_(spheres.begin(), spheres.end()), free_(std::move(free_spheres)), blocks_(std::move(blocks)), slot_(spheres.size(), -1) {
    for (std::size_t k = 0; k < free_.size(); ++k) slot_[free_[k]] = static_cast<std::int32_t>(k);
    arrays_.resize(spheres_.size());
    for (std::size_t i = 0; i < spheres_.size(); ++i) to_single(i);
    const std::size_t points = blocks_.size() * SampleBlocks::width;
    gap_.resize(points);
    gap_single_.resize(points);
    nearest_.resize(points);
}

VectorXd GapLoss::free_values() const {
    VectorXd x(static_cast<Eigen::Index>(4 * free_.size()));
    for (std::size_t k = 0; k < free_.size(); ++k) {
        const auto at = static_cast<Eigen::Index>(4 * k);
        x.segment<3>(at) = spheres_[free_[k]].centre;
        x[at + 3] = spheres_[free_[k]].radius;
    }
    return x;
}

void GapLoss::set_spheres(const VectorXd& x) {
    for (std::size_t k = 0; k < free_.size(); ++k) {
        const auto at = static_cast<Eigen::Index>(4 * k);
        spheres_[free_[k]] = {x.segment<3>(at), x[at + 3]};
        to_single(free_[k]);
    }
}

void GapLoss::to_single(std::size_t i) {
    arrays_.x[i] = static_cast<float>(spheres_[i].centre.x());
    arrays_.y[i] = static_cast<float>(spheres_[i].centre.y());
    arrays_.z[i] = static_cast<float>(spheres_[i].centre.z());
    arrays_.radius[i] = static_cast<float>(spheres_[i].radius);
}

bool GapLoss::candidates_valid() const {
    if (reference_.empty()) return false;
    for (const std::uint32_t i : free_) {
        const double moved = (spheres_[i].centre - reference_[i].centre).norm() + std::abs(spheres_[i].radius - reference_[i].radius);
        if (moved > margin_) return false;
    }
    return true;
}

// A sphere can be nearest to a point of a ball (m, ρ) only if its distance from m is within 2ρ of the least one; 2·margin more while spheres move.
void GapLoss::rebuild_candidates() {
    // Spheres move some gap widths while they settle, and less and less. A wide margin is cheap: the kernel costs less than collecting candidates.
    margin_ = reference_.empty() ? widest_margin : std::clamp(8.0 * last_rms_, 1e-4, widest_margin);
    reference_ = spheres_;
    const std::size_t n = spheres_.size();
    struct Part {
        std::vector<std::uint32_t> count, list;
    };
    constexpr std::size_t grain = 8;       // groups of blocks
    std::vector<std::size_t> group_begin;  // runs of listed blocks in one group
    for (std::size_t k = 0; k < blocks_.size(); ++k) {
        if (k == 0 || blocks_[k] / SampleBlocks::group != blocks_[k - 1] / SampleBlocks::group) group_begin.push_back(k);
    }
    const std::size_t groups = group_begin.size();
    group_begin.push_back(blocks_.size());
    std::vector<Part> parts((groups + grain - 1) / grain);
    parallel_blocks(groups, grain, [&](std::size_t begin, std::size_t end) {
        Part& part = parts[begin / grain];
        std::vector<float> distance(n), near(n);
        std::vector<std::uint32_t> coarse(n);
        SphereArrays few;  // the coarse candidates side by side
        few.resize(n);
        const float slack = 2.0f * static_cast<float>(margin_) + 1e-6f;
        for (std::size_t g = begin; g < end; ++g) {
            const std::size_t group = blocks_[group_begin[g]] / SampleBlocks::group;
            distances_to_spheres(samples_.group_x[group], samples_.group_y[group], samples_.group_z[group], arrays_, n, distance.data());
            const float limit = *std::min_element(distance.begin(), distance.end()) + 2.0f * samples_.group_radius[group] + slack;
            std::size_t kept = 0;
            for (std::size_t i = 0; i < n; ++i) {
                if (distance[i] > limit) continue;
                coarse[kept] = static_cast<std::uint32_t>(i);
                few.x[kept] = arrays_.x[i];
                few.y[kept] = arrays_.y[i];
                few.z[kept] = arrays_.z[i];
                few.radius[kept++] = arrays_.radius[i];
            }
            for (std::size_t k = group_begin[g]; k < group_begin[g + 1]; ++k) {
                const std::uint32_t b = blocks_[k];
                distances_to_spheres(samples_.ball_x[b], samples_.ball_y[b], samples_.ball_z[b], few, kept, near.data());
                float least = near[0];
                for (std::size_t c = 1; c < kept; ++c) least = std::min(least, near[c]);
                const float bound = least + 2.0f * samples_.ball_radius[b] + slack;
                const std::size_t before = part.list.size();
                for (std::size_t c = 0; c < kept; ++c) {
                    if (near[c] <= bound) part.list.push_back(coarse[c]);
                }
                part.count.push_back(static_cast<std::uint32_t>(part.list.size() - before));
            }
        }
    });
    start_.assign(1, 0);
    candidate_.clear();
    for (const Part& part : parts) {
        for (const std::uint32_t count : part.count) start_.push_back(start_.back() + count);
        candidate_.insert(candidate_.end(), part.list.begin(), part.list.end());
    }
}

double GapLoss::evaluate(const VectorXd& x, VectorXd* gradient, BlockMetric* metric) {
    set_spheres(x);
    if (!candidates_valid()) rebuild_candidates();
    constexpr std::size_t width = SampleBlocks::width;
    parallel_for(blocks_.size(), 256, [&](std::size_t k) {
        const std::size_t at = static_cast<std::size_t>(blocks_[k]) * width;
        nearest_of_candidates(&samples_.x[at], &samples_.y[at], &samples_.z[at], &candidate_[start_[k]], start_[k + 1] - start_[k], arrays_,
                              &gap_single_[k * width], &nearest_[k * width]);
    });

    const double weight = 1.0 / static_cast<double>(samples_.size());
    double sum = 0.0, squares = 0.0;
    // Per free sphere: Σ ½f′ (n, 1), and for the metric Σ ½f″ (n, 1)(n, 1)ᵀ.
    std::vector<Eigen::Vector4d> slope(free_.size(), Eigen::Vector4d::Zero());
    if (metric) metric->blocks.assign(free_.size(), Eigen::Matrix4d::Zero());
    for (std::size_t k = 0; k < blocks_.size(); ++k) {
        const std::size_t at = static_cast<std::size_t>(blocks_[k]) * width;
        for (std::size_t lane = 0; lane < width; ++lane) {
            const std::uint32_t i = nearest_[k * width + lane];
            const Vec3 offset = samples_.points[at + lane] - spheres_[i].centre;
            const double length = offset.norm();
            const double gap = length - spheres_[i].radius;
            gap_[k * width + lane] = gap;
            squares += gap * gap;
            const GapCharge charged = samples_.weight[at + lane] * charge(shape_, gap, gap < 0.0);
            sum += charged.value;
            if (!gradient || slot_[i] < 0) continue;
            const auto s = static_cast<std::size_t>(slot_[i]);
            const double inverse = 1.0 / length;
            const Eigen::Vector4d row(offset.x() * inverse, offset.y() * inverse, offset.z() * inverse, 1.0);
            slope[s] += charged.half_slope * row;
            if (!metric) continue;
            Eigen::Matrix4d& block = metric->blocks[s];
            const Eigen::Vector4d weighted = charged.half_bend * row;
            block.col(0) += row[0] * weighted;
            block.col(1) += row[1] * weighted;
            block.col(2) += row[2] * weighted;
            block.col(3) += weighted;
        }
    }
    if (gradient) {
        gradient->resize(static_cast<Eigen::Index>(4 * free_.size()));
        for (std::size_t s = 0; s < free_.size(); ++s) gradient->segment<4>(static_cast<Eigen::Index>(4 * s)) = -2.0 * weight * slope[s];
    }
    if (metric) {
        for (auto& block : metric->blocks) block *= 2.0 * weight;
    }
    last_rms_ = std::sqrt(squares / static_cast<double>(std::max<std::size_t>(1, gap_.size())));
    gap_part_ = sum * weight;
    return gap_part_ + (containment_.distance ? add_containment(gradient, metric) : 0.0);
}

double GapLoss::add_containment(VectorXd* gradient, BlockMetric* metric) {
    const double weight = 2.0 / static_cast<double>(spheres_.size());
    double sum = 0.0;
    if (known_.empty()) known_.resize(free_.size());
    for (std::size_t s = 0; s < free_.size(); ++s) {
        const Sphere& sphere = spheres_[free_[s]];
        // A distance grows by no more than the way gone: most spheres need no new query.
        const Known& known = known_[s];
        if (sphere.radius + known.distance + (sphere.centre - known.at).norm() <= containment_.slack) continue;
        const meshes::DistanceSample at = containment_.distance->sample(sphere.centre);
        known_[s] = {sphere.centre, at.value};
        const double excess = sphere.radius + at.value - containment_.slack;
        if (excess <= 0.0) continue;
        sum += excess * excess;
        Eigen::Vector4d row;
        row << at.gradient, 1.0;
        if (gradient) gradient->segment<4>(static_cast<Eigen::Index>(4 * s)) += 2.0 * weight * excess * row;
        if (metric) metric->blocks[s] += 2.0 * weight * row * row.transpose();
    }
    return sum * weight;
}

}  // namespace pelletlab::shapegen::detail
