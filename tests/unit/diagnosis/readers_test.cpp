#include <gtest/gtest.h>

#include <fstream>

#include "campaign/assemble.hpp"
#include "core/error.hpp"
#include "diagnosis/diagnose.hpp"
#include "io/campaign_file.hpp"
#include "io/csv_table.hpp"
#include "io/files.hpp"
#include "tests/unit/diagnosis/made_up_campaign.hpp"

namespace pelletlab {
namespace {

namespace fs = std::filesystem;

const fs::path example = fs::path(PELLETLAB_SOURCE_DIR) / "examples/diagnosis";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

/// The example's folder copied, with one change in one of its files.
class Changed {
public:
    Changed(const std::string& file, const std::string& from, const std::string& to) : folder_(fs::path(testing::TempDir()) / "pelletlab-readers") {
        fs::remove_all(folder_);
        fs::copy(example, folder_);
        if (!file.empty()) io::write_text(folder_ / file, replaced(io::read_text(folder_ / file), from, to));
    }
    ~Changed() { fs::remove_all(folder_); }
    diagnosis::Problem problem() const {
        const Experiment e = io::read_experiment(folder_ / "experiment.toml");
        const Campaign c = campaign::assemble(io::read_campaign(e.campaign_file));
        auto model = std::make_shared<diagnosis::Model>();  // no emulator: joining needs none
        model->campaign = c;
        for (std::size_t k = 0; k < c.description.effects.size(); ++k) model->library.push_back(static_cast<int>(k));
        return diagnosis::make_problem(model, e);
    }
    /// The message must hold the words, and name a file.
    void refuses(const std::string& words) const {
        try {
            problem();
            ADD_FAILURE() << "accepted; expected: " << words;
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
            EXPECT_EQ(error.kind(), ErrorKind::bad_input);
            EXPECT_FALSE(error.remedy().empty());
            EXPECT_FALSE(error.place().file.empty());
        }
    }

private:
    fs::path folder_;
};

TEST(Readers, TheExampleIsRead) {
    const auto p = Changed("", "", "").problem();
    EXPECT_EQ(p.fitted.points.size(), 19u);
    EXPECT_EQ(p.held_out.points.size(), 9u);
    EXPECT_EQ(p.fitted.groups.size(), 7u);
    EXPECT_EQ(p.notes.size(), 1u);  // 35 rpm is interpolated
    // 35 rpm lies in the middle of two regimes: half of each
    EXPECT_NEAR(p.held_out.from_outputs.row(0).sum(), 1.0, 1e-12);
    EXPECT_NEAR(p.held_out.from_outputs.row(0).maxCoeff(), 0.5, 1e-12);
}

TEST(Readers, EveryMistakeHasItsMessage) {
    Changed("experiment.toml", "uncertainty = 0.2           #", "repeats_ = 2 #").refuses("no uncertainty");
    Changed("experiment.toml", "unit = \"mm\"", "unit = \"rpm\"").refuses("another quantity");
    Changed("experiment.toml", "unit = \"mm\"", "unit = \"milimeter\"").refuses("unknown unit");
    Changed("experiment.toml", "regime = \"20 rpm\"", "regime = \"5 rpm\"").refuses("outside the campaign's regimes");
    Changed("experiment.toml", "observable = \"surface\"", "observable = \"surfaces\"").refuses("no observable 'surfaces'");
    Changed("experiment.toml", "measured_50rpm.csv", "measured_20rpm.csv").refuses("same data");
    Changed("experiment.toml", "measured_35rpm.csv", "measured_20rpm.csv").refuses("once fitted and once held out");
    Changed("experiment.toml", "seed = 1", "sead = 1").refuses("did you mean 'seed'");
    Changed("experiment.toml", "measures = \"fill\"", "measures_ = \"fill\"").refuses("neither a direct measurement");
    Changed("measured_20rpm.csv", "-0.45", "-0.75").refuses("does not ascend");
    Changed("measured_20rpm.csv", "-0.45,", "-0.45,x").refuses("is no number");
    Changed("campaign.toml", "\"runs.csv\"", "\"run.csv\"").refuses("does not exist");
    Changed("campaign.toml", "columns = \"z(*)\"", "columns = \"y(*)\"").refuses("finds 0 columns");
    Changed("campaign.toml", "column = \"fill_error\"", "column = \"fill_eror\"").refuses("did you mean 'fill_error'");
    Changed("campaign.toml", "tolerance = 1.0", "tolerance = 0.0").refuses("must be positive");
    Changed("campaign.toml", "full = 0.4", "full = 0.0").refuses("equals the baseline");
    Changed("campaign.toml", "good = [\"complete\"]", "good = [\"steady\"]").refuses("failed, unsteady or incomplete");
}

TEST(Readers, FewerDataThanParametersAreRefused) {
    const auto model = std::make_shared<diagnosis::Model>();
    model->campaign = campaign::assemble(diagnosis::made_up::table());
    Experiment e = diagnosis::made_up::reality(1, {0.5, 0.5}, Eigen::Vector3d::Zero());
    e.measurements.pop_back();
    e.measurements[0].axis.resize(2);
    e.measurements[0].value.resize(2);
    e.measurements[0].uncertainty.resize(2);
    EXPECT_THROW(diagnosis::make_problem(model, e), Error);
    e.parameters.push_back({"b", 0.5, 0.5, true, {}});
    EXPECT_NO_THROW(diagnosis::make_problem(model, e));
}

TEST(Readers, TooManyFailedRunsAreAnErrorAndFewAreCounted) {
    CampaignTable t = diagnosis::made_up::table();
    t.rows[0].failed = true;
    const Campaign c = campaign::assemble(t);
    EXPECT_EQ(c.blocks[0].name, "baseline");
    EXPECT_EQ(c.blocks[0].failed, 1);
    EXPECT_EQ(c.output.rows(), 59);
    for (std::size_t i = 0; i < 4; ++i) t.rows[i].failed = true;
    EXPECT_THROW(campaign::assemble(t), Error);
}

TEST(Csv, ReadsWhatPeopleWriteAndSaysWhereItDoesNot) {
    const io::CsvTable t = io::parse_csv("\xEF\xBB\xBF# note\r\na; \"b c\" ;d\r\n1;2,5;\r\n\r\n-3e2; 4 ;nan\r\n", "t.csv");
    ASSERT_EQ(t.columns, (std::vector<std::string>{"a", "b c", "d"}));
    EXPECT_EQ(t.lines, (std::vector<int>{3, 5}));
    EXPECT_EQ(t.number(1, 0), -300.0);
    EXPECT_TRUE(std::isnan(t.number(0, 2)) && std::isnan(t.number(1, 2)));
    try {
        t.number(0, 1);  // a decimal comma
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.place().line, 3);
        EXPECT_EQ(error.place().column, 3);
    }
    EXPECT_THROW(io::parse_csv("a,b\n1\n", "t.csv"), Error);
    EXPECT_THROW(io::parse_csv("a,a\n1,2\n", "t.csv"), Error);
    EXPECT_THROW(io::parse_csv("a,b\n", "t.csv"), Error);
}

TEST(Amplitude, ScalesInvert) {
    const CampaignEffect root{"r", "", "r", "1", 0.0, 0.4, true, false, ""}, linear{"d", "", "d", "mm", 1.1, 1.5, false, true, ""};
    for (const double v : {0.0, 0.01, 0.1, 0.4}) EXPECT_NEAR(campaign::value_of_amplitude(root, campaign::scaled_amplitude(root, v)), v, 1e-15);
    EXPECT_EQ(campaign::scaled_amplitude(root, 0.0), 0.0);
    EXPECT_EQ(campaign::scaled_amplitude(linear, 1.1), 0.0);
    EXPECT_NEAR(campaign::scaled_amplitude(linear, 0.9), -0.5, 1e-15);
}

}  // namespace
}  // namespace pelletlab
