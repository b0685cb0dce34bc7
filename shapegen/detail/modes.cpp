#include "shapegen/detail/modes.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "shapegen/detail/feature_edges.hpp"
#include "shapegen/detail/settle.hpp"

namespace pelletlab::shapegen::detail {

namespace {

constexpr std::uint32_t usual_iterations = 40;
constexpr double usual_tolerance = 3e-4;
constexpr double pole_reach = 1.5;  // × usual gap: poles farther below a face would never touch a wall

void add_stage(MinimiserResult& total, const MinimiserResult& stage) {
    total.loss = stage.loss;
    total.iterations += stage.iterations;
    total.converged = stage.converged;
}

}  // namespace

MinimiserResult polish(std::vector<Sphere>& spheres, SymmetricLoss& loss, const ModeContext& context, std::uint32_t iterations, double tolerance) {
    BlockMetric metric;
    MinimiserSettings settings;
    settings.iterations = iterations;
    settings.tolerance = tolerance;
    if (context.map != nullptr) {
        const SymmetryMap& map = *context.map;
        BlockMetric of_all;
        VectorXd slope;
        VectorXd y = pack(map.first_of(spheres));
        const MinimiserResult result = minimise(
            y, lower_bounds(map.generators(), context.min_radius),
            [&](const VectorXd& at, VectorXd& gradient, bool refresh) {
                slope.resize(static_cast<Eigen::Index>(4 * map.spheres()));
                const double value = loss.evaluate(map.expand(at), slope, refresh ? &of_all : nullptr);
                gradient = map.reduce(slope);
                if (refresh) {
                    metric = map.reduce(of_all);
                    metric.factorise(0.05);
                }
                return value;
            },
            [&](VectorXd& q) { metric.apply(q); }, settings);
        spheres = map.expand(unpack(y));
        return result;
    }
    VectorXd x = pack(spheres);
    const MinimiserResult result = minimise(
        x, lower_bounds(spheres.size(), context.min_radius),
        [&](const VectorXd& at, VectorXd& gradient, bool refresh) {
            const double value = loss.evaluate(at, gradient, refresh ? &metric : nullptr);
            if (refresh) metric.factorise(0.05);
            return value;
        },
        [&](VectorXd& q) { metric.apply(q); }, settings);
    spheres = unpack(x);
    return result;
}

void restore_symmetry(std::vector<Sphere>& spheres, const ModeContext& context) {
    if (context.map == nullptr) return;
    spheres = context.map->expand(context.map->first_of(spheres));
}

MinimiserResult fit_mean(std::vector<Sphere>& spheres, const ModeContext& context, const SampleBlocks& samples, std::size_t points) {
    SymmetricLoss loss(samples, context.distance, spheres, context.moments, points);
    SymmetricTerms terms;
    terms.second = context.second;
    loss.charge_by(terms);
    return polish(spheres, loss, context, usual_iterations, usual_tolerance);
}

MinimiserResult fit_minimax(std::vector<Sphere>& spheres, const ModeContext& context, const SampleBlocks& samples, std::size_t points) {
    MinimiserResult total = fit_mean(spheres, context, samples, points);
    for (const int power : {4, 8, 16, 32}) {
        SymmetricLoss loss(samples, context.distance, spheres, context.moments, points);
        VectorXd gradient;
        loss.evaluate(pack(spheres), gradient, nullptr);
        SymmetricTerms terms;
        terms.gaps.power = power;
        terms.gaps.scale = loss.largest();
        loss.charge_by(terms);
        add_stage(total, polish(spheres, loss, context, usual_iterations, usual_tolerance));
    }
    return total;
}

namespace {

// Spheres whose pole in the direction of a flat face is exposed and lies at that face, for each face.
std::vector<SymmetricTerms::Level> pole_levels(const std::vector<Sphere>& spheres, const ModeContext& context, double reach) {
    std::vector<SymmetricTerms::Level> levels;
    for (const FlatFace& face : flat_faces(context.mesh, 0.02)) {
        SymmetricTerms::Level level;
        level.normal = face.normal;
        for (std::size_t i = 0; i < spheres.size(); ++i) {
            const Vec3 pole = spheres[i].centre + spheres[i].radius * face.normal;
            const double height = face.normal.dot(pole) - face.level;
            if (height < -reach || height > 4.0 * reach || std::abs(context.distance.value(pole) - height) > 0.1 * reach) continue;
            bool hidden = false;
            for (std::size_t j = 0; j < spheres.size() && !hidden; ++j) hidden = j != i && (pole - spheres[j].centre).norm() < spheres[j].radius;
            if (!hidden) level.spheres.push_back(static_cast<std::uint32_t>(i));
        }
        if (level.spheres.size() > 1) levels.push_back(std::move(level));
    }
    return levels;
}

// Usual distance between the surfaces, to tell what belongs to a face.
double usual_gap(const std::vector<Sphere>& spheres, const ModeContext& context) {
    const SampleBlocks samples = make_blocks(sample_surface(context.mesh, 4000, 1));
    GapLoss loss(samples, spheres);
    return std::sqrt(loss.evaluate(pack(spheres), nullptr, nullptr));
}

}  // namespace

MinimiserResult fit_flat(std::vector<Sphere>& spheres, const ModeContext& context, const SampleBlocks& samples, std::size_t points) {
    MinimiserResult total = fit_mean(spheres, context, samples, points);
    for (const double weight : {3.0, 30.0, 300.0}) {
        SymmetricLoss loss(samples, context.distance, spheres, context.moments, points);
        SymmetricTerms terms;
        terms.second = context.second;
        terms.levels = pole_levels(spheres, context, pole_reach * usual_gap(spheres, context));
        for (auto& level : terms.levels) level.weight = weight;
        loss.charge_by(terms);
        add_stage(total, polish(spheres, loss, context, usual_iterations, usual_tolerance));
    }
    return total;
}

void level_poles(std::vector<Sphere>& spheres, const ModeContext& context) {
    const std::vector<SymmetricTerms::Level> levels = pole_levels(spheres, context, pole_reach * usual_gap(spheres, context));
    // A sphere may carry several faces: the smallest change of centre and radius that serves all of them.
    std::vector<std::vector<Eigen::Vector4d>> rows(spheres.size());
    std::vector<std::vector<double>> off(spheres.size());
    for (const auto& level : levels) {
        double mean = 0.0;
        for (const std::uint32_t i : level.spheres) mean += level.normal.dot(spheres[i].centre) + spheres[i].radius;
        mean /= static_cast<double>(level.spheres.size());
        for (const std::uint32_t i : level.spheres) {
            Eigen::Vector4d row;
            row << level.normal, 1.0;
            rows[i].push_back(row);
            off[i].push_back(mean - level.normal.dot(spheres[i].centre) - spheres[i].radius);
        }
    }
    for (std::size_t i = 0; i < spheres.size(); ++i) {
        if (rows[i].empty()) continue;
        Eigen::MatrixXd a(static_cast<Eigen::Index>(rows[i].size()), 4);
        VectorXd b(static_cast<Eigen::Index>(rows[i].size()));
        for (std::size_t k = 0; k < rows[i].size(); ++k) {
            a.row(static_cast<Eigen::Index>(k)) = rows[i][k].transpose();
            b[static_cast<Eigen::Index>(k)] = off[i][k];
        }
        const Eigen::Vector4d change = a.completeOrthogonalDecomposition().solve(b);
        spheres[i].centre += change.head<3>();
        spheres[i].radius += change[3];
    }
    restore_symmetry(spheres, context);
}

}  // namespace pelletlab::shapegen::detail
