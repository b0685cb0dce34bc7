// «Best within a cost»: what is bought is affordable, and one sphere more is not.
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "core/error.hpp"
#include "meshes/makers.hpp"
#include "meshes/mass_properties.hpp"
#include "shapegen/make_clump.hpp"
#include "shapegen/stop_criteria.hpp"

namespace pelletlab::shapegen {
namespace {

constexpr double density = 1800.0, allowed = 0.6;

double relative_cost(const std::vector<Sphere>& spheres, const TriangleMesh& body) {
    const MassProperties mass = meshes::mass_properties(body, density);
    return dem_cost(rigid_template("", spheres, mass).spheres, mass).cost / dem_cost_of_shape_2(density).cost;
}

TEST(Cost, TheBestThatItBuys) {
    const TriangleMesh body = meshes::make_cylinder(3.12e-3, 2.96e-3, 96, true);
    const std::shared_ptr<const meshes::SignedDistance> exact = meshes::exact_signed_distance(body);
    const auto grid = meshes::grid_signed_distance(body, 2.96e-3 / 32.0, meshes::GridFill::exact_query, exact);
    FitSettings settings;
    const StoppedFit bought = fit_within_cost(body, *grid, *exact, settings, density, allowed, {});
    EXPECT_LE(relative_cost(bought.fit.spheres, body), allowed);
    EXPECT_NE(bought.fit.status, FitStatus::criterion_not_met);
    // With the contacts held as they come it is the number of spheres that counts: one more costs too much.
    settings.most_contacts = 1000;
    const StoppedFit plain = fit_within_cost(body, *grid, *exact, settings, density, allowed, {});
    FitSettings one_more;
    one_more.sphere_count = static_cast<std::uint32_t>(plain.fit.spheres.size()) + 1;
    EXPECT_GT(relative_cost(fit_spheres(body, *grid, *exact, one_more).spheres, body), allowed);
    EXPECT_LE(bought.quality.both.rms, plain.quality.both.rms);
    EXPECT_EQ(fit_within_cost(body, *grid, *exact, {}, density, 1e-3, {}).fit.status, FitStatus::criterion_not_met);
    EXPECT_THROW(fit_within_cost(body, *grid, *exact, {}, density, 0.0, {}), Error);
}

}  // namespace
}  // namespace pelletlab::shapegen
