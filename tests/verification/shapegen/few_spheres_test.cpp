// Up to twelve spheres: the error of the fit never grows with their number, and no other method is better at the same number.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "meshes/mass_properties.hpp"
#include "meshes/named_body.hpp"
#include "shapegen/baselines/baselines.hpp"
#include "shapegen/fit.hpp"
#include "shapegen/quality.hpp"

namespace pelletlab::shapegen {
namespace {

// The search compares at 8000 points of each surface, the judge at 40 000 others: an rms scatters by 0.1 % to 0.2 % between them.
constexpr double tolerance = 1.002;
constexpr std::uint32_t chain = 8, most = 12;

struct Subject {
    std::string name;
    friend std::ostream& operator<<(std::ostream& out, const Subject& subject) { return out << subject.name; }
};

class FewSpheres : public testing::TestWithParam<Subject> {
protected:
    FewSpheres()
        : body(meshes::make_named_body(GetParam().name)),
          exact(meshes::exact_signed_distance(body)),
          grid(meshes::grid_signed_distance(body, bounding_box(body).sizes().minCoeff() / 32.0, meshes::GridFill::exact_query, exact)) {}

    FitResult fit(std::uint32_t spheres) const {
        FitSettings settings;
        settings.sphere_count = spheres;
        return fit_spheres(body, *grid, *exact, settings);
    }
    double rms(const std::vector<Sphere>& spheres) const { return measure_quality(spheres, body, *exact).both.rms; }

    TriangleMesh body;
    std::shared_ptr<const meshes::SignedDistance> exact;
    std::unique_ptr<meshes::SignedDistance> grid;
};

TEST_P(FewSpheres, OneMoreIsNeverWorseAndNoOtherMethodIsBetter) {
    // The search for eight goes through those for one to seven, and gives back what they gave.
    FitResult eight = fit(chain);
    ASSERT_EQ(eight.fewer.size(), chain - 1);
    std::vector<std::vector<Sphere>> best = eight.fewer;
    best.push_back(eight.spheres);
    const FitResult three = fit(3);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(three.spheres[i].centre, best[2][i].centre);
        EXPECT_EQ(three.spheres[i].radius, best[2][i].radius);
    }
    for (std::uint32_t n = chain + 1; n <= most; ++n) best.push_back(fit(n).spheres);

    std::vector<double> error;
    for (std::uint32_t n = 1; n <= most; ++n) {
        ASSERT_EQ(best[n - 1].size(), n);
        error.push_back(rms(best[n - 1]));
        if (n == 1) continue;
        EXPECT_LE(error[n - 1], tolerance * error[n - 2]) << n << " spheres";
    }
    // What the result says of itself is what the judge finds.
    EXPECT_NEAR(std::sqrt(eight.loss), error[chain - 1], 0.005 * error[chain - 1]);

    const double volume = meshes::mass_properties(body, 1.0).volume;
    for (const std::uint32_t n : {1u, 2u, 3u, 4u, 6u, 9u, 12u}) {
        for (const baselines::Method& method : baselines::methods()) {
            baselines::BaselineSettings settings;
            settings.sphere_count = n;
            settings.cell_fraction = 1.0 / 32.0;
            std::vector<Sphere> spheres;
            try {
                spheres = baselines::baseline(method.id, body, *exact, settings);
            } catch (const Error&) {
                continue;  // finds no place for a sphere in this body
            }
            EXPECT_LE(error[n - 1], tolerance * rms(spheres)) << method.name << ", " << n << " spheres";
            EXPECT_LE(error[n - 1], tolerance * rms(baselines::volume_matched(spheres, volume))) << method.name << ", volume-matched, " << n << " spheres";
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Bodies, FewSpheres,
                         testing::Values(Subject{"cylinder:diameter=3.12mm,height=2.96mm,facets=96"}, Subject{"ring:facets=32"}, Subject{"trilobe:facets=36"}),
                         [](const auto& info) { return info.param.name.substr(0, info.param.name.find(':')); });

}  // namespace
}  // namespace pelletlab::shapegen
