#include "campaign/design.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "core/random.hpp"

namespace pelletlab::campaign {
namespace {

CampaignPlan plan() {
    CampaignPlan p;
    p.rigs = {{"pile", "pile.toml", {}, {}}, {"tube", "tube.toml", {}, {}}};
    p.parameters = {{"sliding", "sliding", "1", 0.2, 0.8, true}, {"speed", "speed", "rpm", 10, 50, false}};
    p.parameter_keys = {{"contacts.a.sliding_friction", "contacts.b.sliding_friction"}, {"drum.speed"}};
    p.effects = {{"rolling", "", "rolling", "1", 0.0, 0.4, true, false, "contact"}, {"size", "", "size", "mm", 3.0, 3.3, false, true, "particle"}};
    p.effect_keys = {{"contacts.a.rolling_friction"}, {"pellet.size"}};
    p.effect_kinds = {PlannedEffectKind::case_keys, PlannedEffectKind::case_keys};
    p.effect_levels = {{}, {}};
    p.points = 20;
    p.runs_an_effect = 5;
    p.anchors = 4;
    p.repeats = 3;
    return p;
}

/// Largest gap between sorted coordinates: 1/n for a perfect spread, about ln(n)/n for random points.
TEST(Design, SobolPointsFillEveryAxisEvenly) {
    for (const int dimensions : {1, 2, 6})
        for (int j = 0; j < dimensions; ++j) {
            std::vector<double> x{0.0, 1.0};
            for (int i = 0; i < 200; ++i) x.push_back(sobol_point(i, dimensions)[j]);
            std::sort(x.begin(), x.end());
            double gap = 0.0;
            for (std::size_t i = 1; i < x.size(); ++i) gap = std::max(gap, x[i] - x[i - 1]);
            EXPECT_LT(gap, 3.01 / 128) << dimensions << " " << j;  // 128 points have one in each of 128 equal parts, but for the corner left out
            EXPECT_GE(x[2], 0.0);
            EXPECT_LE(x[x.size() - 2], 1.0);
        }
}

/// Share of points in random boxes against their volume: better than random points, which miss it by √(v(1 − v)/n).
TEST(Design, SobolPointsFillTheCube) {
    RandomStream random(1, 1);
    constexpr int n = 256, boxes = 200;
    double even = 0.0, chance = 0.0;
    for (int b = 0; b < boxes; ++b) {
        const Eigen::Vector3d corner(random.uniform(), random.uniform(), random.uniform());
        const double volume = corner.prod();
        int inside = 0;
        for (int i = 0; i < n; ++i) inside += (sobol_point(i, 3).array() < corner.array()).all() ? 1 : 0;
        even += std::pow(inside / double(n) - volume, 2);
        chance += volume * (1 - volume) / n;
    }
    EXPECT_LT(even, 0.1 * chance);
}

TEST(Design, HasBasePointsRepeatsAndOneBlockAnEffect) {
    const CampaignPlan p = plan();
    const auto runs = design_of(p);
    ASSERT_EQ(runs.size(), 2u * (20 + 2 * 4 + 2 * 5));
    std::set<std::uint64_t> seeds;
    int with_rolling = 0, with_size = 0, negative = 0;
    for (const PlannedRun& run : runs) {
        seeds.insert(run.seed);
        for (std::size_t j = 0; j < 2; ++j) {
            EXPECT_GE(run.parameters[j], p.parameters[j].lower);
            EXPECT_LE(run.parameters[j], p.parameters[j].upper);
        }
        EXPECT_FALSE(run.effects[0] != 0.0 && run.effects[1] != 3.0);  // one effect at a time
        with_rolling += run.effects[0] != 0.0 ? 1 : 0;
        with_size += run.effects[1] != 3.0 ? 1 : 0;
        negative += run.effects[1] < 3.0 ? 1 : 0;
    }
    EXPECT_EQ(seeds.size(), runs.size() / 2);  // the rigs of a configuration share one
    EXPECT_EQ(with_rolling, 10);
    EXPECT_EQ(with_size, 10);
    EXPECT_EQ(negative, 4);
    // A longer campaign begins as the shorter one.
    CampaignPlan longer = p;
    longer.points = 30;
    EXPECT_EQ(design_of(longer)[38].parameters, runs[38].parameters);
}

TEST(Design, OverridesCarryUnits) {
    const CampaignPlan p = plan();
    const auto list = overrides_of(p, {0, {0.5, 20.0}, {0.0, 3.125}, 17});
    const std::vector<std::string> expected{"contacts.a.sliding_friction=0.5",
                                            "contacts.b.sliding_friction=0.5",
                                            "drum.speed=20 rpm",
                                            "contacts.a.rolling_friction=0",
                                            "pellet.size=3.125 mm",
                                            "seed=17"};
    EXPECT_EQ(list, expected);
}

}  // namespace
}  // namespace pelletlab::campaign
