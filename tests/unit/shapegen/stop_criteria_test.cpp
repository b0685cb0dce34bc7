#include "shapegen/stop_criteria.hpp"

#include <gtest/gtest.h>

#include "analytic_cylinder.hpp"
#include "core/error.hpp"
#include "meshes/makers.hpp"
#include "meshes/mass_properties.hpp"
#include "shapegen/make_clump.hpp"
#include "shapegen/quality.hpp"

namespace pelletlab::shapegen {
namespace {

const AnalyticCylinder& cylinder() {
    static const AnalyticCylinder instance(3.12e-3, 2.96e-3);
    return instance;
}

TriangleMesh pellet() {
    return meshes::make_cylinder(3.12e-3, 2.96e-3, 128, true);
}

TEST(StopCriteria, FewestSpheresForAnRms) {
    StopCriteria criteria;
    criteria.rms = 0.08e-3;
    const StoppedFit stopped = fit_to_criteria(pellet(), cylinder(), cylinder(), {}, criteria);
    ASSERT_NE(stopped.fit.status, FitStatus::criterion_not_met);
    EXPECT_LE(stopped.quality.both.rms, criteria.rms);
    FitSettings one_less;
    one_less.sphere_count = static_cast<std::uint32_t>(stopped.fit.spheres.size()) - 1;
    EXPECT_GT(measure_quality(fit_spheres(pellet(), cylinder(), one_less).spheres, pellet(), cylinder()).both.rms, criteria.rms);
    EXPECT_LE(stopped.attempts, 12u);  // doubling and halving, not one by one
}

TEST(StopCriteria, AllCriteriaTogether) {
    StopCriteria criteria;
    criteria.symmetric_difference = 0.12;
    criteria.inertia_error = 0.02;
    criteria.max = 0.4e-3;
    criteria.edge_radius = 0.6e-3;
    const StoppedFit stopped = fit_to_criteria(pellet(), cylinder(), cylinder(), {}, criteria);
    ASSERT_NE(stopped.fit.status, FitStatus::criterion_not_met);
    EXPECT_LE(stopped.quality.symmetric_difference, 0.12);
    EXPECT_LE(stopped.quality.inertia_error.cwiseAbs().maxCoeff(), 0.02);
    EXPECT_LE(stopped.quality.both.max, 0.4e-3);
}

TEST(StopCriteria, OutOfReachSaysSo) {
    StopCriteria criteria;
    criteria.max = 1e-6;
    criteria.most_spheres = 6;
    const StoppedFit stopped = fit_to_criteria(pellet(), cylinder(), cylinder(), {}, criteria);
    EXPECT_EQ(stopped.fit.status, FitStatus::criterion_not_met);
    EXPECT_EQ(stopped.fit.spheres.size(), 6u);
}

TEST(StopCriteria, NoCriterionIsAnError) {
    EXPECT_THROW(fit_to_criteria(pellet(), cylinder(), cylinder(), {}, {}), Error);
    StopCriteria criteria;
    criteria.rms = -1.0;
    EXPECT_THROW(fit_to_criteria(pellet(), cylinder(), cylinder(), {}, criteria), Error);
}

}  // namespace
}  // namespace pelletlab::shapegen
