#include "shapegen/detail/symmetric_loss.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/parallel.hpp"

namespace pelletlab::shapegen::detail {

namespace {

constexpr double pi = std::numbers::pi;

}  // namespace

// Integrals over one sphere's exposed part and their derivatives by its centre and radius.
struct SymmetricLoss::Part {
    double integral = 0.0, area = 0.0, largest = 0.0;
    Eigen::Vector4d integral_slope = Eigen::Vector4d::Zero(), area_slope = Eigen::Vector4d::Zero(), volume_slope = Eigen::Vector4d::Zero();
    Eigen::Matrix<double, 4, 3> spread_slope = Eigen::Matrix<double, 4, 3>::Zero();  // of ∫ x_k² dV along the body's axes
    Eigen::Matrix4d metric = Eigen::Matrix4d::Zero();
};

SymmetricLoss::SymmetricLoss(const SampleBlocks& samples, const meshes::SignedDistance& distance, std::span<const Sphere> spheres, const BodyMoments& body,
                             std::size_t points)
    : gap_loss_(samples, spheres), distance_(distance), table_of_(spheres.size(), 0) {
    const Eigen::SelfAdjointEigenSolver<Mat3> solver(body.covariance);
    axes_ = solver.eigenvectors();
    spread_ = solver.eigenvalues();
    const std::vector<ExposedPart> boundary = union_boundary(spheres);
    double area = 0.0;
    for (std::size_t i = 0; i < spheres.size(); ++i) area += spheres[i].radius * spheres[i].radius * boundary[i].solid_angle;
    // Tables of 64, 90, 128, … directions.
    for (std::size_t i = 0; i < spheres.size(); ++i) {
        const double wanted = 4.0 * pi * spheres[i].radius * spheres[i].radius / area * static_cast<double>(points);
        table_of_[i] = static_cast<std::size_t>(std::clamp(std::round(2.0 * std::log2(wanted / 64.0)), 0.0, 18.0));
    }
    tables_.resize(*std::max_element(table_of_.begin(), table_of_.end()) + 1);
    for (const std::size_t t : table_of_) {
        Directions& table = tables_[t];
        if (!table.x.empty()) continue;
        const auto n = static_cast<std::size_t>(64.0 * std::pow(2.0, 0.5 * static_cast<double>(t)));
        for (std::size_t k = 0; k < n; ++k) {
            const double z = 1.0 - 2.0 * (static_cast<double>(k) + 0.5) / static_cast<double>(n);
            const double turn = (static_cast<double>(k) + 0.5) * pi * (3.0 - std::sqrt(5.0));
            const double ring = std::sqrt(1.0 - z * z);
            table.x.push_back(static_cast<float>(ring * std::cos(turn)));
            table.y.push_back(static_cast<float>(ring * std::sin(turn)));
            table.z.push_back(static_cast<float>(z));
        }
    }
}

SymmetricLoss::Part SymmetricLoss::one_sphere(const Sphere& sphere, const ExposedPart& part, std::span<const Sphere> spheres,
                                              const Directions& directions) const {
    Part result;
    if (part.solid_angle <= 0.0) return result;
    const double r = sphere.radius, r2 = r * r;
    const Vec3& m = part.normal_integral;
    result.area = r2 * part.solid_angle;
    result.area_slope << 2.0 * r * m, 2.0 * r * part.solid_angle;
    result.volume_slope << r2 * m, r2 * part.solid_angle;

    // Patch. A direction near a crease counts by the share of its cell that is exposed, so the sum is smooth in the unknowns.
    const std::size_t n = directions.x.size();
    const double each = 4.0 * pi / static_cast<double>(n);
    const double cell = std::sqrt(each);
    std::vector<std::uint32_t> shown(n);
    std::size_t count = 0;
    for (std::size_t k = 0; k < n; ++k) shown[k] = static_cast<std::uint32_t>(k);
    count = n;
    for (const Cap& cap : part.caps) {
        const Eigen::Vector3f axis = cap.axis.cast<float>();
        const auto limit = static_cast<float>(cap.cosine + 0.5 * cap.sine * cell);
        std::size_t kept = 0;
        for (std::size_t k = 0; k < count; ++k) {
            const std::uint32_t d = shown[k];
            shown[kept] = d;
            kept += directions.x[d] * axis[0] + directions.y[d] * axis[1] + directions.z[d] * axis[2] < limit ? 1 : 0;
        }
        count = kept;
    }
    double total_share = 0.0;
    for (std::size_t k = 0; k < count; ++k) {
        const std::uint32_t d = shown[k];
        Vec3 normal(directions.x[d], directions.y[d], directions.z[d]);
        double share = 1.0, inside = 0.0;
        const Cap* edge = nullptr;
        for (const Cap& cap : part.caps) {
            const double distance = (cap.cosine - normal.dot(cap.axis)) / cap.sine;  // from the crease, about, in radians
            if (0.5 + distance / cell >= share) continue;
            share = 0.5 + distance / cell;
            inside = distance;
            edge = &cap;
        }
        if (share <= 0.0) continue;
        if (edge != nullptr) {  // the middle of the exposed part of the cell
            const Vec3 away = normal * normal.dot(edge->axis) - edge->axis;
            normal = (normal + away * (0.5 * (0.5 * cell - inside) / away.norm())).normalized();
        }
        total_share += share;
        const Vec3 q = sphere.centre + r * normal;
        const meshes::DistanceSample at = distance_.sample(q);
        const double weight = r2 * each * share;
        const double across = at.gradient.dot(normal);
        Eigen::Vector4d row;
        row << normal, 1.0;
        const GapCharge charged = charge(terms_.gaps, at.value, at.value > 0.0);
        result.largest = std::max(result.largest, std::abs(at.value));
        result.integral += weight * charged.value;
        result.integral_slope += weight * (2.0 * charged.half_slope * across + 2.0 * charged.value / r) * row;
        result.metric += (2.0 * weight * charged.half_bend * across * across) * row * row.transpose();
        const Vec3 along = axes_.transpose() * q;
        result.spread_slope += (weight * row) * along.cwiseProduct(along).transpose();
    }
    if (total_share > 0.0) {  // the exact area is known
        const double correction = part.solid_angle / (total_share * each);
        result.integral *= correction;
        result.integral_slope *= correction;
        result.spread_slope *= correction;
        result.metric *= correction;
    }

    // Creases: three Gauss points on each stretch of at most 30 degrees.
    for (const ExposedArc& arc : part.arcs) {
        const Sphere& other = spheres[arc.neighbour];
        const double d2 = (other.centre - sphere.centre).squaredNorm();
        const double cosine = std::clamp((r2 + other.radius * other.radius - d2) / (2.0 * r * other.radius), -1.0, 1.0);
        // cosine of the angle between the outward normals; tan(β/2)
        const double crease = std::sqrt(std::max(0.0, 1.0 - cosine) / std::max(1e-12, 1.0 + cosine));
        const double turn = arc.end - arc.begin;
        const int stretches = std::max(1, static_cast<int>(std::ceil(turn / (pi / 6.0))));
        const double step = turn / stretches;
        static const std::array<double, 3> node = {-0.7745966692414834, 0.0, 0.7745966692414834}, share = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
        for (int s = 0; s < stretches; ++s) {
            for (std::size_t g = 0; g < 3; ++g) {
                const double t = arc.begin + (s + 0.5 + 0.5 * node[g]) * step;
                const Vec3 normal = arc.cos_opening * arc.axis + arc.sin_opening * (arc.u * std::cos(t) + arc.v * std::sin(t));
                const double length = share[g] * step * r * arc.sin_opening;
                const double gap = distance_.value(sphere.centre + r * normal);
                result.largest = std::max(result.largest, std::abs(gap));
                Eigen::Vector4d row;
                row << normal, 1.0;
                result.integral_slope -= (charge(terms_.gaps, gap, gap > 0.0).value * crease * length) * row;
                result.area_slope -= (crease * length) * row;
            }
        }
    }
    return result;
}

void SymmetricLoss::charge_by(const SymmetricTerms& terms) {
    terms_ = terms;
    gap_loss_.charge_by(terms.gaps);
}

double SymmetricLoss::evaluate(const VectorXd& x, VectorXd& gradient, BlockMetric* metric) {
    first_ = gap_loss_.evaluate(x, &gradient, metric);
    const std::vector<Sphere> spheres = unpack(x);
    const std::vector<ExposedPart> boundary = union_boundary(spheres);
    std::vector<Part> parts(spheres.size());
    parallel_for(spheres.size(), 4, [&](std::size_t i) { parts[i] = one_sphere(spheres[i], boundary[i], spheres, tables_[table_of_[i]]); });
    double integral = 0.0, area = 0.0;
    largest_ = 0.0;
    for (const Part& part : parts) {
        integral += part.integral;
        area += part.area;
        largest_ = std::max(largest_, part.largest);
    }
    for (const double gap : gap_loss_.gaps()) largest_ = std::max(largest_, std::abs(gap));
    second_ = integral / area;

    // L = s² (E/s²)^(2/p): a length squared whatever the power.
    const double square = terms_.gaps.scale * terms_.gaps.scale, exponent = 2.0 / terms_.gaps.power;
    const double share = terms_.second, rest = 2.0 - share;
    const double both = 0.5 * (rest * first_ + share * second_) / square;
    const double outer = exponent * std::pow(both, exponent - 1.0);
    gradient *= 0.5 * outer * rest;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const auto at = static_cast<Eigen::Index>(4 * i);
        gradient.segment<4>(at) += 0.5 * outer * share * (parts[i].integral_slope - second_ * parts[i].area_slope) / area;
        if (metric) metric->blocks[i] = (0.5 * outer * (rest * metric->blocks[i] + share * parts[i].metric / area)).eval();
    }
    return square * std::pow(both, exponent) + add_penalties(spheres, boundary, parts, gradient, metric) + add_levels(spheres, gradient, metric);
}

// Volume and spread of the union.
double SymmetricLoss::add_penalties(const std::vector<Sphere>& spheres, const std::vector<ExposedPart>& boundary, const std::vector<Part>& parts,
                                    VectorXd& gradient, BlockMetric* metric) {
    const UnionMoments moments = union_moments(spheres, boundary, Vec3::Zero());
    union_volume_ = moments.volume;
    const double excess = moments.volume - 1.0;
    const Vec3 centre = axes_.transpose() * moments.first / moments.volume;
    const Vec3 spread = (axes_.transpose() * moments.second * axes_).diagonal() / moments.volume - centre.cwiseProduct(centre);
    const Vec3 spread_excess = spread.cwiseQuotient(spread_) - Vec3::Ones();
    VectorXd volume_row(gradient.size());
    std::vector<VectorXd> spread_row(3, VectorXd(gradient.size()));
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const auto at = static_cast<Eigen::Index>(4 * i);
        volume_row.segment<4>(at) = parts[i].volume_slope;
        for (std::size_t k = 0; k < 3; ++k) {  // d(spread) = (d∫x² − spread dV) / V, the centre being near the origin
            const auto axis = static_cast<Eigen::Index>(k);
            spread_row[k].segment<4>(at) = (parts[i].spread_slope.col(axis) - spread[axis] * parts[i].volume_slope) / (moments.volume * spread_[axis]);
        }
    }
    gradient += (2.0 * terms_.volume * excess - terms_.volume_reward) * volume_row;
    for (std::size_t k = 0; k < 3; ++k) gradient += (2.0 * terms_.inertia * spread_excess[static_cast<Eigen::Index>(k)]) * spread_row[k];
    if (metric) {
        metric->rows.clear();
        metric->scales.clear();
        if (terms_.volume > 0.0) {
            metric->rows.push_back(std::move(volume_row));
            metric->scales.push_back(2.0 * terms_.volume);
        }
        for (std::size_t k = 0; k < 3 && terms_.inertia > 0.0; ++k) {
            metric->rows.push_back(std::move(spread_row[k]));
            metric->scales.push_back(2.0 * terms_.inertia);
        }
    }
    return terms_.volume * excess * excess + terms_.inertia * spread_excess.squaredNorm() - terms_.volume_reward * excess;
}

// Spheres level with each other, or below a plane.
double SymmetricLoss::add_levels(const std::vector<Sphere>& spheres, VectorXd& gradient, BlockMetric* metric) const {
    double sum = 0.0;
    for (const SymmetricTerms::Level& level : terms_.levels) {
        const double each = level.weight / static_cast<double>(level.spheres.size());
        double mean = 0.0;
        for (const std::uint32_t i : level.spheres) mean += level.normal.dot(spheres[i].centre) + spheres[i].radius;
        mean /= static_cast<double>(level.spheres.size());
        Eigen::Vector4d row;
        row << level.normal, 1.0;
        for (const std::uint32_t i : level.spheres) {
            const double off = level.normal.dot(spheres[i].centre) + spheres[i].radius - mean;
            sum += each * off * off;
            gradient.segment<4>(static_cast<Eigen::Index>(4 * i)) += 2.0 * each * off * row;
            if (metric) metric->blocks[i] += 2.0 * each * row * row.transpose();
        }
    }
    for (const SymmetricTerms::Below& term : terms_.below) {
        const double over = term.normal.dot(spheres[term.sphere].centre) + spheres[term.sphere].radius - term.level;
        if (over <= 0.0) continue;
        Eigen::Vector4d row;
        row << term.normal, 1.0;
        sum += term.weight * over * over;
        gradient.segment<4>(static_cast<Eigen::Index>(4 * term.sphere)) += 2.0 * term.weight * over * row;
        if (metric) metric->blocks[term.sphere] += 2.0 * term.weight * row * row.transpose();
    }
    return sum;
}

}  // namespace pelletlab::shapegen::detail
