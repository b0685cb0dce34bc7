#include "shapegen/detail/contact_limit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/parallel.hpp"
#include "shapegen/detail/feature_edges.hpp"

namespace pelletlab::shapegen::detail {

namespace {

constexpr std::size_t looked_at = 1000;
constexpr double room = 1.02;  // × press: held back a little more than needed

double height(const Sphere& sphere, const Vec3& normal) {
    return normal.dot(sphere.centre) + sphere.radius;
}

struct TooHigh {
    std::uint32_t sphere;
    double level;  // it should stay below
};

// Spheres that touch a plane in that direction beyond the limit: the lowest ones of those that touch.
std::vector<TooHigh> beyond_limit(const std::vector<Sphere>& spheres, const Vec3& normal, const ContactLimit& limit) {
    std::vector<std::pair<double, std::uint32_t>> order;
    double top = -std::numeric_limits<double>::infinity();
    for (const Sphere& sphere : spheres) top = std::max(top, height(sphere, normal));
    for (std::size_t i = 0; i < spheres.size(); ++i) {
        const double h = height(spheres[i], normal);
        if (h > top - limit.press) order.emplace_back(-h, static_cast<std::uint32_t>(i));
    }
    std::vector<TooHigh> result;
    if (order.size() <= limit.most) return result;
    std::sort(order.begin(), order.end());
    for (std::size_t k = limit.most; k < order.size(); ++k) result.push_back({order[k].second, top - room * limit.press});
    return result;
}

}  // namespace

std::vector<Vec3> plane_directions(const TriangleMesh& mesh, std::size_t spread) {
    std::vector<Vec3> result;
    for (const FlatFace& face : flat_faces(mesh, 0.02)) result.push_back(face.normal);
    for (std::size_t k = 0; k < spread; ++k) {
        const double z = 1.0 - 2.0 * (static_cast<double>(k) + 0.5) / static_cast<double>(spread);
        const double turn = (static_cast<double>(k) + 0.5) * std::numbers::pi * (3.0 - std::sqrt(5.0));
        result.push_back({std::sqrt(1.0 - z * z) * std::cos(turn), std::sqrt(1.0 - z * z) * std::sin(turn), z});
    }
    return result;
}

std::size_t plane_contacts(std::span<const Sphere> spheres, const Vec3& normal, double press) {
    double top = -std::numeric_limits<double>::infinity();
    for (const Sphere& sphere : spheres) top = std::max(top, height(sphere, normal));
    return static_cast<std::size_t>(std::count_if(spheres.begin(), spheres.end(), [&](const Sphere& sphere) { return height(sphere, normal) > top - press; }));
}

MinimiserResult fit_within_contacts(std::vector<Sphere>& spheres, const ModeContext& context, const ContactLimit& limit, const SampleBlocks& samples,
                                    std::size_t points) {
    MinimiserResult total;
    const std::vector<Vec3> normals = plane_directions(context.mesh, looked_at);
    SymmetricTerms terms;
    terms.second = context.second;
    for (const double weight : {3.0, 30.0, 300.0}) {
        for (const Vec3& normal : normals) {
            for (const TooHigh& sphere : beyond_limit(spheres, normal, limit)) terms.below.push_back({sphere.sphere, normal, sphere.level, weight});
        }
        if (terms.below.empty()) return total;
        for (auto& term : terms.below) term.weight = weight / static_cast<double>(terms.below.size());
        SymmetricLoss loss(samples, context.distance, spheres, context.moments, points);
        loss.charge_by(terms);
        const MinimiserResult stage = polish(spheres, loss, context, 30, 3e-4);
        total.iterations += stage.iterations;
        total.converged = stage.converged;
        total.loss = stage.loss;
    }
    return total;
}

bool hold_contacts(std::vector<Sphere>& spheres, const ModeContext& context, const ContactLimit& limit) {
    const std::vector<Vec3> normals = plane_directions(context.mesh, looked_at);
    for (int round = 0; round < 60; ++round) {
        std::vector<std::vector<TooHigh>> found(normals.size());
        parallel_for(normals.size(), 32, [&](std::size_t k) { found[k] = beyond_limit(spheres, normals[k], limit); });
        bool clear = true, moved = false;
        for (std::size_t k = 0; k < normals.size(); ++k) {
            for (const TooHigh& one : found[k]) {
                clear = false;
                Sphere& sphere = spheres[one.sphere];
                const double over = height(sphere, normals[k]) - one.level;
                if (over <= 0.0) continue;  // made smaller for another direction already
                const double smaller = std::max(context.min_radius, sphere.radius - over);
                moved = moved || smaller < sphere.radius;
                sphere.radius = smaller;
            }
        }
        if (clear) return true;
        restore_symmetry(spheres, context);
        if (!moved) return false;
    }
    return false;
}

}  // namespace pelletlab::shapegen::detail
