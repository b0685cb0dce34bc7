#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "diagnosis/audit_ranges.hpp"
#include "tests/unit/diagnosis/made_up_campaign.hpp"

namespace pelletlab::diagnosis {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::vector<std::string> warnings(const Experiment& e) {
    static const auto model = make_model(campaign::assemble(made_up::table()), {}, {}, "made-up.toml");
    std::vector<std::string> texts;
    for (const AuditItem& item : audit_ranges(make_problem(model, e))) {
        EXPECT_TRUE(item.is_warning);
        texts.push_back(item.text);
    }
    return texts;
}

Experiment plain(std::uint64_t seed = 3) {
    return made_up::reality(seed, {0.4, 0.6}, Eigen::Vector3d::Zero());
}

TEST(AuditRanges, SilentOnGoodDataAndOnEffects) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        EXPECT_THAT(warnings(plain(seed)), IsEmpty()) << seed;
        EXPECT_THAT(warnings(made_up::reality(seed, {0.5, 0.5}, {0.6, 0.0, 0.0})), IsEmpty()) << seed;  // an effect is no mistake in the data
    }
}

TEST(AuditRanges, NamesTheUnitThatBringsTheValuesBack) {
    const struct {
        double factor;
        const char* says;
    } cases[]{{60.0 / (2.0 * M_PI), "rpm taken for rad/s"},
              {1000.0, "a factor of 1000"},
              {0.001, "a factor of 1000"},
              {57.29578, "radians taken for degrees"},
              {-1.0, "the sign"}};
    for (const auto& one : cases) {
        Experiment e = plain();
        for (double& v : e.measurements[1].value) v *= one.factor;
        for (double& u : e.measurements[1].uncertainty) u *= std::abs(one.factor);
        EXPECT_THAT(warnings(e), ElementsAre(HasSubstr(one.says))) << one.factor;
    }
}

/// A campaign whose regimes lie far apart and hardly depend on its parameters.
std::shared_ptr<const Model> narrow() {
    CampaignTable t = made_up::table();
    for (CampaignTable::Row& row : t.rows) {
        row.regime = row.regime_level == 20.0 ? "20" : "50";
        for (double& v : row.outputs) v = (row.regime_level == 20.0 ? 10.0 : 30.0) + 0.02 * v;
    }
    return make_model(campaign::assemble(t), {}, {}, "made-up.toml");
}

TEST(AuditRanges, SaysThatNothingFitsWhenNothingDoes) {
    Experiment e = plain();
    for (Measurement& m : e.measurements)
        for (double& v : m.value) v = (m.regime == "20 rpm" ? 15.0 : 30.0) + 0.02 * v;  // half as much again, in one of them
    const auto items = audit_ranges(make_problem(narrow(), e));
    ASSERT_EQ(items.size(), 1u);
    EXPECT_THAT(items[0].text, HasSubstr("check scale, speed, fill and mass"));
}

TEST(AuditRanges, FindsAPictureFiledUnderAnotherRegime) {
    Experiment e = plain();
    for (Measurement& m : e.measurements)
        for (double& v : m.value) v = (m.regime == "20 rpm" ? 30.0 : 10.0) + 0.02 * v;  // the two swapped
    const auto items = audit_ranges(make_problem(narrow(), e));
    ASSERT_EQ(items.size(), 2u);
    EXPECT_THAT(items[0].text, HasSubstr("filed under the wrong regime, it fits 50 rpm"));
    EXPECT_THAT(items[1].text, HasSubstr("filed under the wrong regime, it fits 20 rpm"));
}

}  // namespace
}  // namespace pelletlab::diagnosis
