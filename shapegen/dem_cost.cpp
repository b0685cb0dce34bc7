#include "shapegen/dem_cost.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "meshes/makers.hpp"
#include "meshes/mass_properties.hpp"
#include "shapegen/hand_made.hpp"
#include "shapegen/make_clump.hpp"

namespace pelletlab::shapegen {

namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr std::size_t spread_directions = 400;

// Fibonacci directions, every one with its opposite, after the six ways along the body axes.
Vec3 direction(std::size_t k) {
    if (k < 6) return (k % 2 == 0 ? 1.0 : -1.0) * Vec3::Unit(static_cast<Eigen::Index>(k / 2));
    const std::size_t pair = (k - 6) / 2;
    const double z = (static_cast<double>(pair) + 0.5) / (0.5 * static_cast<double>(spread_directions));
    const double turn = static_cast<double>(pair) * std::numbers::pi * (3.0 - std::sqrt(5.0));
    const Vec3 u(std::sqrt(1.0 - z * z) * std::cos(turn), std::sqrt(1.0 - z * z) * std::sin(turn), z);
    return k % 2 == 0 ? u : Vec3(-u);
}

struct Pressed {
    Matrix6 stiffness = Matrix6::Zero();  // M^(−½) K M^(−½)
    std::size_t contacts = 0;
};

Pressed press_plane(std::span<const Sphere> spheres, const MassProperties& mass, const Vec3& u, double depth, const DemCostSettings& settings) {
    double top = -std::numeric_limits<double>::infinity();
    for (const Sphere& s : spheres) top = std::max(top, u.dot(s.centre) + s.radius);
    const double modulus = settings.shear_modulus / (1.0 - settings.poisson_ratio);  // E* of two bodies of one material
    const double ratio = 2.0 * (1.0 - settings.poisson_ratio) / (2.0 - settings.poisson_ratio);
    const Vec3 v = u.unitOrthogonal(), w = u.cross(v);
    const Vec3 inertia_root = mass.principal_inertia.cwiseSqrt().cwiseInverse();
    Pressed result;
    for (const Sphere& s : spheres) {
        const double overlap = depth - (top - u.dot(s.centre) - s.radius);
        if (overlap <= 0.0) continue;
        ++result.contacts;
        const double stiffness = 2.0 * modulus * std::sqrt(s.radius * overlap);
        const Vec3 arm = s.centre + s.radius * u;
        const std::array<Vec3, 3> sides = {u, v, w};  // the normal, and two tangents
        for (std::size_t k = 0; k < 3; ++k) {
            Eigen::Matrix<double, 6, 1> row;
            row << sides[k] / std::sqrt(mass.mass), arm.cross(sides[k]).cwiseProduct(inertia_root);
            result.stiffness += stiffness * (k == 0 ? 1.0 : ratio) * row * row.transpose();
        }
    }
    return result;
}

}  // namespace

DemCost dem_cost(std::span<const Sphere> spheres, const MassProperties& mass, const DemCostSettings& settings) {
    if (spheres.empty()) throw bad_input("a clump without spheres has no cost", "give at least one sphere");
    if (!(mass.mass > 0.0) || !(mass.principal_inertia.minCoeff() > 0.0)) throw bad_input("a clump without mass has no time step", "give a density above 0");
    const double depth = settings.press > 0.0 ? settings.press : equivalent_diameter(mass.volume) / 300.0;
    struct Row {
        double eigenvalue = 0.0;
        std::size_t contacts = 0, most = 0;
    };
    std::vector<Row> rows((6 + spread_directions) / 2);
    parallel_for(rows.size(), 16, [&](std::size_t k) {
        const Pressed front = press_plane(spheres, mass, direction(2 * k), depth, settings),
                      back = press_plane(spheres, mass, direction(2 * k + 1), depth, settings);
        const Matrix6 sum = front.stiffness + back.stiffness;
        rows[k] = {Eigen::SelfAdjointEigenSolver<Matrix6>(sum, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff(), front.contacts + back.contacts,
                   std::max(front.contacts, back.contacts)};
    });
    DemCost result;
    double largest = 0.0;
    for (std::size_t k = 0; k < rows.size(); ++k) {
        largest = std::max(largest, rows[k].eigenvalue);
        result.contacts_most = std::max(result.contacts_most, rows[k].most);
        if (k >= 3) result.contacts_mean += static_cast<double>(rows[k].contacts) / static_cast<double>(spread_directions);
    }
    result.time_step = 2.0 / std::sqrt(largest);
    result.work = settings.work_of_pellet + static_cast<double>(spheres.size()) * settings.work_of_sphere + 0.5 * settings.neighbours * result.contacts_mean;
    result.cost = result.work / result.time_step;
    return result;
}

DemCost dem_cost_of_shape_2(double density, const DemCostSettings& settings) {
    const MassProperties mass = meshes::mass_properties(meshes::make_cylinder(3.12e-3, 2.96e-3, 128, true), density);
    const RigidTemplate rigid = rigid_template("Shape 2", hand_made_shape(2), mass);
    return dem_cost(rigid.spheres, rigid.mass_properties, settings);
}

}  // namespace pelletlab::shapegen
