#include "shapegen/symmetry.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>

#include "core/parallel.hpp"
#include "meshes/mass_properties.hpp"

namespace pelletlab::shapegen {

namespace {

constexpr double pi = std::numbers::pi;
constexpr std::uint32_t largest_fold = 12;
constexpr std::size_t most_samples = 4000;

Mat3 turn(const Vec3& axis, std::uint32_t fold) {
    return Eigen::AngleAxisd(2.0 * pi / fold, axis).toRotationMatrix();
}
Mat3 reflection(const Vec3& n) {
    return Mat3::Identity() - 2.0 * n * n.transpose();
}

// The surface, and how far a motion about the centre takes it off itself.
struct Surface {
    const meshes::SignedDistance& exact;
    Vec3 centre = Vec3::Zero();
    std::vector<Vec3> points;  // about the centre

    Surface(const TriangleMesh& body, const meshes::SignedDistance& distance, const Vec3& about) : exact(distance), centre(about) {
        std::vector<Vec3> all = body.vertices;
        for (std::size_t f = 0; f < body.faces.size(); ++f) all.push_back((body.corner(f, 0) + body.corner(f, 1) + body.corner(f, 2)) / 3.0);
        const std::size_t stride = (all.size() + most_samples - 1) / most_samples;
        for (std::size_t k = 0; k < all.size(); k += stride) points.push_back(all[k] - centre);
    }
    double residual(const Mat3& motion, std::size_t stride = 1) const {
        return parallel_reduce((points.size() + stride - 1) / stride, 256, 0.0,
                               [&](std::size_t begin, std::size_t end) {
                                   double largest = 0.0;
                                   for (std::size_t k = begin; k < end; ++k)
                                       largest = std::max(largest, std::abs(exact.value(centre + motion * points[k * stride])));
                                   return largest;
                               },
                               [](double a, double b) { return std::max(a, b); });
    }
};

// Mirror plane that holds the axis, where any there is: the best of many angles, made sharper by thirds.
Vec3 best_upright_mirror(const Surface& surface, const Vec3& axis, std::uint32_t fold) {
    const Vec3 u = axis.unitOrthogonal(), v = axis.cross(u);
    const auto normal = [&](double angle) { return Vec3(std::cos(angle) * u + std::sin(angle) * v); };
    const double range = pi / fold;  // planes repeat after half a turn of the fold
    constexpr int tries = 48;
    double best = 0.0, least = std::numeric_limits<double>::infinity();
    for (int k = 0; k < tries; ++k) {
        const double angle = range * k / tries, residual = surface.residual(reflection(normal(angle)), 8);
        if (residual < least) {
            least = residual;
            best = angle;
        }
    }
    double low = best - range / tries, high = best + range / tries;
    for (int k = 0; k < 25; ++k) {
        const double a = low + (high - low) / 3.0, b = high - (high - low) / 3.0;
        if (surface.residual(reflection(normal(a)), 8) < surface.residual(reflection(normal(b)), 8)) {
            high = b;
        } else {
            low = a;
        }
    }
    return normal(0.5 * (low + high));
}

}  // namespace

FoundSymmetry find_symmetry(const TriangleMesh& body, const meshes::SignedDistance& exact, double tolerance) {
    const MassProperties mass = meshes::mass_properties(body, 1.0);
    const Surface surface(body, exact, mass.centre_of_mass_mesh);
    const double allowed = tolerance > 0.0 ? tolerance : bounding_box(body).sizes().minCoeff() / 300.0;
    const Mat3 axes = mass.principal_axes.toRotationMatrix();
    FoundSymmetry found;
    double residual = 0.0;
    const auto holds = [&](const Mat3& motion) {
        if (surface.residual(motion, 16) > allowed) return false;  // most motions fail at once
        residual = surface.residual(motion);
        return residual <= allowed;
    };
    const auto keep = [&] { found.residual = std::max(found.residual, residual); };

    // The axis of the highest fold; the principal z axis is the one of an axisymmetric inertia, so it goes first.
    for (const Eigen::Index k : {2, 1, 0}) {
        const Vec3 axis = axes.col(k);
        std::uint32_t fold = largest_fold;
        while (fold > 1 && !holds(turn(axis, fold))) --fold;
        if (fold <= found.symmetry.fold) continue;
        keep();
        found.symmetry.fold = fold;
        found.symmetry.axis = axis;
    }
    const Vec3 axis = found.symmetry.fold > 1 ? found.symmetry.axis : Vec3(axes.col(2));
    found.symmetry.axis = axis;
    // Only a body of revolution has two folds without a common factor above 12.
    found.revolution = found.symmetry.fold > 1 && holds(turn(axis, 7)) && holds(turn(axis, 11)) && holds(turn(axis, 5));
    if (found.revolution) {
        keep();
        found.symmetry.fold = 1;
    }
    if (holds(reflection(axis))) {
        keep();
        found.symmetry.mirrors.push_back(axis);
    }
    if (!found.revolution) {
        if (found.symmetry.fold > 2) {
            const Vec3 upright = best_upright_mirror(surface, axis, found.symmetry.fold);
            if (holds(reflection(upright))) {
                keep();
                found.symmetry.mirrors.push_back(upright);
            }
        } else {  // three different moments: only principal planes can be mirrors
            for (Eigen::Index k = 0; k < 3; ++k) {
                if (std::abs(axes.col(k).dot(axis)) > 0.5 || !holds(reflection(axes.col(k)))) continue;
                keep();
                found.symmetry.mirrors.push_back(axes.col(k));
            }
        }
    }
    return found;
}

Symmetry symmetry_for(const FoundSymmetry& found, std::uint32_t spheres) {
    Symmetry result = found.symmetry;
    if (!found.revolution) return result;
    // Rings about as far apart as their spheres: on a body as high as wide N spheres make rings of about 1.1 √N. What is left over goes on the axis, where
    // few are of use.
    const double wanted = 1.1 * std::sqrt(static_cast<double>(spheres));
    double least = std::numeric_limits<double>::infinity();
    for (std::uint32_t fold = 2; fold <= std::min<std::uint32_t>(32, std::max<std::uint32_t>(2, spheres)); ++fold) {
        const double misfit = std::abs(std::log(fold / wanted)), left_over = static_cast<double>(spheres % fold);
        const double badness = misfit + 0.2 * std::max(0.0, left_over - 2.0);
        if (badness < least) {
            least = badness;
            result.fold = fold;
        }
    }
    return result;
}

std::string describe(const Symmetry& symmetry) {
    if (symmetry.trivial()) return "none";
    std::string text;
    if (symmetry.fold > 1) {
        char buffer[96];
        std::snprintf(buffer, sizeof buffer, "%u-fold about (%.3g, %.3g, %.3g)", symmetry.fold, symmetry.axis.x(), symmetry.axis.y(), symmetry.axis.z());
        text = buffer;
    }
    if (!symmetry.mirrors.empty()) {
        text += (text.empty() ? "" : ", ") + std::to_string(symmetry.mirrors.size()) + (symmetry.mirrors.size() == 1 ? " mirror plane" : " mirror planes");
    }
    return text;
}

}  // namespace pelletlab::shapegen
