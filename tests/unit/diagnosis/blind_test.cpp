#include "diagnosis/blind.hpp"

#include <gtest/gtest.h>

#include <set>

#include "tests/unit/diagnosis/made_up_campaign.hpp"

namespace pelletlab::diagnosis {
namespace {

TEST(Blind, CasesAreReproducibleDisjointAndNeverTrainTheirOwnPoint) {
    const Campaign c = campaign::assemble(made_up::table());
    const BlindCounts few{4, 4, 0, 2, 2};
    const auto first = draw_blind_cases(c, few, 11, {}), again = draw_blind_cases(c, few, 11, {});
    ASSERT_EQ(first.size(), again.size());
    std::vector<int> taken;
    for (std::size_t i = 0; i < first.size(); ++i) {
        EXPECT_EQ(first[i].label.configuration, again[i].label.configuration);
        taken.push_back(first[i].label.configuration);
    }
    EXPECT_EQ(std::set<int>(taken.begin(), taken.end()).size(), taken.size());
    for (const BlindCase& one : draw_blind_cases(c, few, 12, taken)) EXPECT_EQ(std::count(taken.begin(), taken.end(), one.label.configuration), 0);
    for (const BlindCase& one : first) {
        const Campaign rest = campaign::without_points(c, one.exclude, "test");
        for (Eigen::Index i = 0; i < rest.parameter.rows(); ++i)
            EXPECT_NE((rest.parameter.row(i) - c.parameter.row(one.label.configuration)).norm(), 0.0) << "a neighbour of the case is trained on";
        const auto& library = one.library;
        const bool known = one.label.effects.empty() || std::find(library.begin(), library.end(), one.label.effects[0]) != library.end();
        EXPECT_EQ(known, one.label.kind != "outside");
    }
}

TEST(Blind, ScoresARightAndAWrongSet) {
    std::vector<BlindLabel> labels(3);
    labels[0] = {"a", "null", 0, {}, {}, 0.0, 0.0, {}, {}};
    labels[1] = {"b", "single", 1, {"x"}, {0.5}, 30.0, 20.0, {"g1"}, {"g2"}};
    labels[2] = {"c", "outside", 2, {"x"}, {0.9}, 50.0, 40.0, {"g1"}, {"g2"}};
    std::vector<BlindVerdict> right(3), wrong(3);
    const auto fill = [](BlindVerdict& v, const char* id, const char* verdict, const std::vector<std::string>& found, const std::map<std::string, double>& p,
                         const char* first) {
        v.id = id;
        v.verdict = verdict;
        v.discoveries = found;
        v.inclusion = p;
        v.credible_set = {first};
    };
    fill(right[0], "a", "NO-GAP", {}, {{"x", 0.01}, {"y", 0.01}}, "parameters only");
    fill(right[1], "b", "EFFECT", {"g1"}, {{"x", 0.99}, {"y", 0.01}}, "x");
    fill(right[2], "c", "OUTSIDE-LIBRARY", {"g1"}, {{"y", 0.1}}, "none of these");
    right[1].named = {"x"};
    right[1].rules = {{"sign table", {"y", "x"}}};
    wrong = right;
    wrong[0].verdict = "EFFECT";
    wrong[1].inclusion = {{"x", 0.1}, {"y", 0.9}};
    wrong[1].discoveries = {"g2"};
    wrong[2].verdict = "EFFECT";
    const auto find = [](const BlindScore& s, const std::string& start) {
        for (const auto& row : s.rows)
            if (row.quantity.starts_with(start)) return row.reached;
        ADD_FAILURE() << start;
        return false;
    };
    const BlindScore good = score_blind(labels, right), bad = score_blind(labels, wrong);
    for (const char* row : {"false alarm", "single effect ranked first, bar", "outside the library (λ ≥ 36): said so", "outside the library (λ ≥ 36): a wrong",
                            "group with the largest", "false discoveries", "calibration of P"}) {
        EXPECT_TRUE(find(good, row)) << row;
        EXPECT_FALSE(find(bad, row)) << row;
    }
    EXPECT_EQ(good.rules_all[0].second.hits, 1);
    EXPECT_EQ(good.rules_all[1].second.hits, 0);  // the sign table put y first
    right.pop_back();
    EXPECT_THROW(score_blind(labels, right), Error);
}

}  // namespace
}  // namespace pelletlab::diagnosis
