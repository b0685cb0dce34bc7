#include "diagnosis/signatures.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"
#include "tests/unit/diagnosis/made_up_campaign.hpp"

namespace pelletlab::diagnosis {
namespace {

/// y = 3 + 2 φ₀ − φ₁² + 4 θ₀ + 0·θ₁ + noise 0.5, repeated runs among them.
CampaignTable known_table(std::uint64_t seed, int repeats) {
    CampaignTable t;
    t.name = "known";
    t.file = "known.toml";
    t.parameters = {{"a", "a", "1", 0.0, 1.0, false}, {"b", "b", "1", 0.0, 1.0, false}};
    t.effects = {{"strong", "", "strong", "1", 0.0, 2.0, false, false, "contact"}, {"dead", "", "dead", "1", 0.0, 1.0, false, true, "contact"}};
    t.observables = {{"y", "mm", "", "", {}, {"y"}, 0.1}};
    RandomStream random(seed, 5);
    const auto run = [&](int i, double strong, double dead) {
        const Eigen::VectorXd u = inference::halton(static_cast<std::uint64_t>(i) + 1, 2);
        t.rows.push_back({i, "", 0.0, false, {u[0], u[1]}, {strong, dead}, {3.0 + 2.0 * u[0] - u[1] * u[1] + 2.0 * strong + 0.5 * random.normal()}});
    };
    for (int i = 0; i < 40; ++i) run(i, 0.0, 0.0);
    for (int r = 1; r < repeats; ++r)
        for (int i = 0; i < 10; ++i) run(i, 0.0, 0.0);
    for (int i = 0; i < 20; ++i) {
        run(100 + i, 0.1 * (i + 1), 0.0);
        run(200 + i, 0.0, (i % 2 == 0 ? 0.05 : -0.05) * (i + 1));
    }
    return t;
}

TEST(Signatures, MovesAndScatterOfAKnownCampaign) {
    const SignatureTable table = signature_table(campaign::assemble(known_table(1, 4)));
    ASSERT_EQ(table.rows.size(), 1u);
    EXPECT_EQ(table.runs, (std::vector<int>{20, 20}));
    EXPECT_TRUE(table.scatter_from_repeats);
    EXPECT_EQ(table.repeats, 30);
    const SignatureRow& row = table.rows[0];
    EXPECT_NEAR(row.scatter, 0.5, 3 * 0.5 / std::sqrt(2.0 * 30));  // three standard errors of a standard deviation
    EXPECT_NEAR(row.effects[0].move, 4.0, 4 * row.effects[0].error * row.scatter);
    EXPECT_LT(row.effects[0].error * row.scatter, 0.3);
    EXPECT_TRUE(row.effects[0].is_significant);
    EXPECT_NEAR(row.effects[0].in_scatter, row.effects[0].move / row.scatter, 1e-12);
    EXPECT_FALSE(signature_table(campaign::assemble(known_table(1, 1))).scatter_from_repeats);
}

TEST(Signatures, ADeadEffectIsMarkedOnceInAHundred) {
    int marked = 0, found = 0;
    for (std::uint64_t seed = 1; seed <= 300; ++seed) {
        const auto row = signature_table(campaign::assemble(known_table(seed, 2))).rows[0];
        marked += row.effects[1].is_significant ? 1 : 0;
        found += row.effects[0].is_significant ? 1 : 0;
    }
    EXPECT_LE(marked, 10);  // mean 3, P(> 10) < 0.001
    EXPECT_EQ(found, 300);
}

TEST(Signatures, TooFewRunsAreRefused) {
    CampaignTable t = known_table(1, 1);
    CampaignTable few = t;
    few.rows.clear();
    for (const std::size_t i : {0u, 1u, 40u, 41u, 42u}) few.rows.push_back(t.rows[i]);
    EXPECT_THROW(signature_table(campaign::assemble(few)), Error);
}

TEST(Signatures, AProfileCountsAsItsMean) {
    const Campaign c = campaign::assemble(made_up::table());
    const SignatureTable table = signature_table(c);
    ASSERT_EQ(table.rows.size(), 2u);
    double mean = 0.0;
    for (const double x : made_up::axis) mean += 4.0 * x * x * (1.3 - 0.4) / 7.0;  // «bend» at 20 rpm
    EXPECT_NEAR(table.rows[0].effects[0].move, mean, 4 * table.rows[0].effects[0].error * table.rows[0].scatter);
    EXPECT_EQ(table.rows[0].regime, c.regimes[0].name);
}

}  // namespace
}  // namespace pelletlab::diagnosis
