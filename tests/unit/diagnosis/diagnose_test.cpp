#include "diagnosis/diagnose.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "diagnosis/plan.hpp"
#include "io/diagnosis_file.hpp"
#include "report/diagnosis_html.hpp"
#include "tests/unit/diagnosis/made_up_campaign.hpp"

namespace pelletlab::diagnosis {
namespace {

using made_up::reality;

/// One emulator and one set of thresholds for all tests: both are made without any test case.
struct House {
    std::shared_ptr<const Model> whole = make_model(campaign::assemble(made_up::table()), {"bend", "bump"}, {}, "test");
    std::shared_ptr<const Model> twins = make_model(campaign::assemble(made_up::table()), {"bend", "bump", "twin"}, {}, "test");
    Thresholds thresholds;
    House() {
        const Problem problem = make_problem(whole, reality(1, {0.5, 0.5}, Eigen::Vector3d::Zero()));
        thresholds = recalibrate(Attributor(problem), 60, 5);
    }
    static const House& get() {
        static const House house;
        return house;
    }
};

Judgement judge_case(const std::shared_ptr<const Model>& model, const Experiment& e) {
    const Problem problem = make_problem(model, e);
    return assess(Attributor(problem), House::get().thresholds, false).judgement;
}

Eigen::Vector2d some_phi(int i) {
    return inference::halton(static_cast<std::uint64_t>(i) + 500, 2) * 0.8 + Eigen::Vector2d::Constant(0.1);
}

TEST(Diagnose, ClaimsNoEffectWhereThereIsNone) {
    int alarms = 0, no_gap = 0;
    constexpr int n = 30;
    for (int i = 0; i < n; ++i) {
        const Judgement j = judge_case(House::get().whole, reality(1000 + static_cast<std::uint64_t>(i), some_phi(i), Eigen::Vector3d::Zero()));
        alarms += j.verdict == Verdict::effect || j.verdict == Verdict::effects ? 1 : 0;
        no_gap += j.verdict == Verdict::no_gap ? 1 : 0;
    }
    EXPECT_LE(alarms, 4);  // 5 % are allowed; five or more of 30 would then come up in 1.6 % of all tests
    EXPECT_GE(no_gap, n * 3 / 4);
}

TEST(Diagnose, NamesTheSingleEffectThatIsThere) {
    for (int effect = 0; effect < 2; ++effect) {
        int right = 0, wrong = 0;
        constexpr int n = 10;
        for (int i = 0; i < n; ++i) {
            Eigen::Vector3d theta = Eigen::Vector3d::Zero();
            theta[effect] = 0.6 + 0.03 * i;
            const Judgement j = judge_case(House::get().whole, reality(2000 + static_cast<std::uint64_t>(10 * effect + i), some_phi(i), theta));
            const bool named = j.verdict == Verdict::effect && j.named == std::vector<int>{effect};
            right += named ? 1 : 0;
            wrong += j.verdict == Verdict::effect && !named ? 1 : 0;
        }
        EXPECT_GE(right, 9) << "effect " << effect;
        EXPECT_EQ(wrong, 0) << "effect " << effect;
    }
}

TEST(Diagnose, SaysOutsideWhenNoEffectOfTheLibraryDoesIt) {
    int said = 0, wrong = 0;
    for (int i = 0; i < 8; ++i) {
        const auto sag = [](double x, double speed) { return -2.5 * std::exp(-std::pow((x + 0.4) / 0.15, 2)) * (1.0 + speed); };
        const Judgement j = judge_case(House::get().whole, reality(3000 + static_cast<std::uint64_t>(i), some_phi(i), Eigen::Vector3d::Zero(), sag));
        said += j.verdict == Verdict::outside_library ? 1 : 0;
        wrong += j.verdict == Verdict::effect || j.verdict == Verdict::effects ? 1 : 0;
    }
    EXPECT_GE(said, 7);
    EXPECT_EQ(wrong, 0);
}

TEST(Diagnose, FindsTheGroupsThatTheEffectShiftsAndNoneWithoutEffect) {
    const auto where = [](const Experiment& e) {
        const Problem problem = make_problem(House::get().whole, e);
        return assess(Attributor(problem), House::get().thresholds, false).where;
    };
    int by_explanation = 0, by_itself = 0, false_ones = 0, nulls_with_one = 0;
    constexpr int n = 10, nulls = 24;
    for (int i = 0; i < n; ++i) {  // the bump stands at x = 0.2: middle third, −0.2 to 0.2, and calibration can hardly touch it
        for (const DiagnosisWhere& w : where(reality(7000 + static_cast<std::uint64_t>(i), some_phi(i), {0.0, 0.9, 0.0}))) {
            if (w.region != "middle third" || w.regime != "20 rpm") continue;
            by_explanation += w.explained_discovery ? 1 : 0;
            by_itself += w.discovery ? 1 : 0;
            EXPECT_LE(w.explained_lower, w.explained);
            EXPECT_GE(w.explained_upper, w.explained);
        }
    }
    for (int i = 0; i < nulls; ++i) {
        int found = 0;
        for (const DiagnosisWhere& w : where(reality(7100 + static_cast<std::uint64_t>(i), some_phi(i), Eigen::Vector3d::Zero()))) {
            false_ones += w.explained_discovery ? 1 : 0;
            found += w.discovery ? 1 : 0;
        }
        nulls_with_one += found > 0 ? 1 : 0;
    }
    EXPECT_GE(by_explanation, 9);
    EXPECT_GE(by_itself, 7);
    EXPECT_LE(false_ones, 2);
    EXPECT_LE(nulls_with_one, 4);  // Benjamini–Hochberg at 5 %: five or more of 24 would come up in 0.6 % of all tests
}

TEST(Rehearsal, RunsOfTheCampaignAreJudgedByAnEmulatorThatNeverSawTheirPoint) {
    const Problem problem = make_problem(House::get().whole, reality(1, {0.5, 0.5}, Eigen::Vector3d::Zero()));
    const Attributor attributor(problem);
    const auto cases = left_out_cases(attributor, 20, 3), again = left_out_cases(attributor, 20, 3);
    ASSERT_EQ(cases.size(), 17u);  // 8 without and 9 with one effect; the campaign has no pairs
    int first = 0;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        EXPECT_TRUE(cases[i].is_run);
        EXPECT_EQ(cases[i].attribution.log_evidence, again[i].attribution.log_evidence);
        const auto& p = cases[i].attribution.probability;
        first += p[cases[i].truth] >= *std::max_element(p.begin(), p.end()) ? 1 : 0;
    }
    EXPECT_GE(first, 12);  // the label belongs to the run: guessing among five explanations would give 3 or 4
}

TEST(Rehearsal, ThresholdsAreTheQuantilesThatBoundTheErrors) {
    // 100 cases without and 100 with the effect whose probabilities p are right at T = 1: densities 2(1 − p) and 2p.
    const std::vector<Hypothesis> hypotheses{
        {{}, false, "parameters only", std::log(0.5)}, {{0}, false, "x", std::log(0.25)}, {{}, true, "none of these", std::log(0.25)}};
    std::vector<RehearsedCase> cases;
    for (int i = 0; i < 200; ++i) {
        const double u = (i / 2 + 0.5) / 100.0;
        RehearsedCase one;
        one.truth = static_cast<std::size_t>(i % 2);
        one.is_run = i < 80;
        const double p = one.truth == 0 ? 1.0 - std::sqrt(1.0 - u) : std::sqrt(u);
        one.attribution.log_evidence = {0.0, std::log(2.0 * p / (1.0 - p)), -60.0};
        one.attribution.adequacy.p = (i + 0.5) / 200.0;
        cases.push_back(one);
    }
    const Thresholds t = thresholds_from(cases, hypotheses, 1);
    EXPECT_DOUBLE_EQ(t.temperature, 1.0);
    EXPECT_EQ(t.cases, 200);
    EXPECT_EQ(t.runs, 80);
    EXPECT_NEAR(t.gap, 1.0 - std::sqrt(0.05), 0.01);  // 95 % of the cases without effect below
    EXPECT_DOUBLE_EQ(t.claim, 0.90);                  // already exceeded by 1 % only
    EXPECT_NEAR(t.null_false_alarm, 0.01, 1e-9);
    EXPECT_NEAR(t.adequacy, 0.0224, 1e-9);  // 0.02·199 = 3.98th order statistic of (i + ½)/200
    EXPECT_DOUBLE_EQ(t.open, 0.5);
}

TEST(Diagnose, GivesASetWhenTwoEffectsAreTwins) {
    const Problem problem = make_problem(House::get().twins, reality(1, {0.5, 0.5}, Eigen::Vector3d::Zero()));
    const DiagnosisPlan plan = make_plan(Attributor(problem), 2);
    EXPECT_LT(plan.separability[1][2], 16.0);  // the plan predicts it
    EXPECT_GT(plan.separability[0][1], 16.0);
    const Thresholds own = recalibrate(Attributor(problem), 60, 5);  // with twins in the library, sure probabilities are seldom right
    int sets = 0, wrong = 0;
    for (int i = 0; i < 6; ++i) {
        const Problem one = make_problem(House::get().twins, reality(4000 + static_cast<std::uint64_t>(i), some_phi(i), {0.0, 0.45, 0.0}));
        const Judgement j = assess(Attributor(one), own, false).judgement;
        sets += j.verdict == Verdict::set && std::find(j.named.begin(), j.named.end(), 1) != j.named.end() ? 1 : 0;
        wrong += j.verdict == Verdict::effect && j.named[0] != 1 ? 1 : 0;
    }
    EXPECT_GE(sets, 4);
    EXPECT_LE(wrong, 1);
}

TEST(Diagnose, DetectabilityAgreesWithProjectionInTheLinearCase) {
    const Problem problem = make_problem(House::get().whole, reality(1, {0.5, 0.5}, Eigen::Vector3d::Zero()));
    const Attributor attributor(problem);
    const Eigen::Vector2d phi(0.5, 0.5), theta(0.8, 0.0), none(0.0, 0.0);
    const inference::Whitener w(covariance(problem, problem.fitted, phi, theta));
    const Eigen::VectorXd f = predict(*problem.model, problem.fitted, phi, none);
    Eigen::MatrixXd j(f.size(), 2);
    for (int i = 0; i < 2; ++i) {
        Eigen::Vector2d moved = phi;
        moved[i] += 0.05;
        j.col(i) = w.whiten(predict(*problem.model, problem.fitted, moved, none) - f) / 0.05;
    }
    const Eigen::VectorXd s = w.whiten(predict(*problem.model, problem.fitted, phi, theta) - f);
    const double projected = (s - j * (j.transpose() * j).ldlt().solve(j.transpose() * s)).squaredNorm();
    EXPECT_NEAR(separation(attributor, phi, theta, 0), projected, 0.05 * projected);  // the formula is linear in φ, the emulator nearly
}

TEST(Diagnose, TheWholeReportIsReproducibleAndSurvivesItsFile) {
    Experiment e = reality(5000, {0.4, 0.6}, {0.8, 0.0, 0.0});
    e.settings.recalibration_cases = 0;
    e.candidates.push_back({"bend itself", 0.5, "", "", "bend", 0.05, {}});
    e.candidates.push_back({"surface again", 1.0, "surface", "20 rpm", "", 0.1, {}});
    const Problem problem = make_problem(House::get().whole, e);
    const Diagnosis a = diagnose(problem), b = diagnose(problem);
    EXPECT_EQ(io::diagnosis_text(a), io::diagnosis_text(b));
    EXPECT_EQ(a.verdict, Verdict::effect);
    EXPECT_EQ(a.named, std::vector<std::string>{"bend"});
    double total = 0.0;
    for (const auto& h : a.hypotheses) total += h.probability;
    EXPECT_NEAR(total, 1.0, 1e-12);
    EXPECT_GT(a.how_far.at(0).shrink, 0.5);
    for (const DiagnosisShrink& s : a.how_far) {  // chance is taken out of the interval as it is out of the value
        EXPECT_LT(s.lower, s.shrink) << s.data;
        EXPECT_GT(s.upper, s.shrink) << s.data;
    }
    EXPECT_LT(a.how_far.at(0).after, a.how_far.at(0).placebo);
    ASSERT_EQ(a.next.size(), 2u);
    for (const auto& n : a.next) EXPECT_GE(n.information, 0.0);
    const auto file = std::filesystem::path(testing::TempDir()) / "pelletlab-diagnosis.json";
    io::write_diagnosis(a, file);
    EXPECT_EQ(io::diagnosis_text(io::read_diagnosis(file)), io::diagnosis_text(a));
    const std::string page = report::diagnosis_html(a);
    EXPECT_NE(page.find("EFFECT"), std::string::npos);
    EXPECT_EQ(page.find("<script"), std::string::npos);
    EXPECT_EQ(page.find("src="), std::string::npos);  // nothing is loaded from anywhere
    EXPECT_EQ(page.find("nan"), std::string::npos);
    std::filesystem::remove(file);
}

TEST(Diagnose, CalibratedOnOneRegimeTheMissOfTheOtherIsAmbiguity) {
    // b acts on the fast regime only through speed; calibrating on the slow profile alone leaves a and b loose, and the joint fit is fine.
    Experiment e = reality(6000, {0.3, 0.9}, Eigen::Vector3d::Zero());
    e.measurements[0].role = MeasurementRole::calibration;
    const Problem problem = make_problem(House::get().whole, e);
    const Assessment a = assess(Attributor(problem), House::get().thresholds);
    EXPECT_FALSE(std::isnan(a.transfer_p));
    EXPECT_TRUE(a.judgement.verdict == Verdict::no_gap || a.judgement.verdict == Verdict::ambiguous_calibration);
}

}  // namespace
}  // namespace pelletlab::diagnosis
