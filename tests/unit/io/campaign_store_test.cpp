#include "io/campaign_store.hpp"

#include <gtest/gtest.h>

#include <unistd.h>
#include <filesystem>
#include <fstream>

#include "core/error.hpp"
#include "io/campaign_plan_file.hpp"
#include "io/files.hpp"
#include "tests/unit/io/support.hpp"

namespace pelletlab::io {
namespace {

namespace fs = std::filesystem;

std::vector<StoredRun> design(int n) {
    std::vector<StoredRun> runs;
    for (int i = 1; i <= n; ++i) {
        StoredRun run;
        run.number = i;
        run.key = "key" + std::to_string(i);
        run.rig = "pile";
        run.parameters = {0.1 * i, 1.0 / 3.0};
        run.seed = 1000000ULL + static_cast<std::uint64_t>(i);
        runs.push_back(run);
    }
    return runs;
}

class Store : public testing::Test {
protected:
    fs::path folder = fs::temp_directory_path() / ("pelletlab-store-" + std::to_string(::getpid()));
    void SetUp() override { fs::create_directories(folder); }
    void TearDown() override { fs::remove_all(folder); }
    fs::path file() const { return folder / "campaign.sqlite"; }
};

TEST_F(Store, ARunIsTakenOnceAndKeepsItsResult) {
    CampaignStore one(file()), other(file());  // two processes' views
    one.set_design(design(3));
    StoredRun a, b, c, d;
    ASSERT_TRUE(one.claim("w1", a));
    ASSERT_TRUE(other.claim("w2", b));
    EXPECT_EQ(a.number, 1);
    EXPECT_EQ(b.number, 2);
    EXPECT_EQ(a.parameters, design(3)[0].parameters);  // to the last bit
    EXPECT_EQ(a.seed, 1000001u);
    one.finish(a.key, 2.5, "{\"x\": 1}");
    other.fail(b.key, 1.0, "exploded");
    ASSERT_TRUE(one.claim("w1", c));
    EXPECT_FALSE(other.claim("w2", d));
    EXPECT_EQ(one.counts(), (std::vector<int>{0, 1, 1, 1}));
    EXPECT_EQ(other.runs()[0].observables, "{\"x\": 1}");
    EXPECT_EQ(other.runs()[1].message, "exploded");
}

TEST_F(Store, RunsOfTheDeadAndFailedOnesComeBackFinishedOnesNever) {
    CampaignStore store(file());
    store.set_design(design(3));
    StoredRun run;
    store.claim("dead", run);
    store.claim("dead", run);
    store.finish("key1", 1.0, "done");
    EXPECT_EQ(store.busy_workers(), std::vector<std::string>{"dead"});
    store.release_runs_of("dead");
    EXPECT_EQ(store.counts(), (std::vector<int>{2, 0, 1, 0}));
    store.claim("w", run);
    store.fail(run.key, 0.1, "no");
    EXPECT_EQ(store.retry_failed(), 1);
    EXPECT_EQ(store.counts(), (std::vector<int>{2, 0, 1, 0}));
    // Another design that shares a run keeps that run's result and lists only its own.
    auto changed = design(2);
    changed[1].key = "another";
    store.set_design(changed);
    EXPECT_EQ(store.counts(), (std::vector<int>{1, 0, 1, 0}));
    EXPECT_EQ(store.runs()[0].observables, "done");
}

TEST_F(Store, RefusesWhatIsNoStore) {
    std::ofstream(file()) << "this is a letter, and long enough to be looked at as a database: ........................................................";
    EXPECT_THROW(CampaignStore{file()}, Error);
    EXPECT_THROW(CampaignStore{folder / "nowhere" / "campaign.sqlite"}, Error);
}

void refuses(const fs::path& folder, const std::string& text, const std::string& place, const std::string& words) {
    write_text(folder / "plan.toml", text);
    try {
        read_campaign_plan(folder / "plan.toml");
        FAIL() << text;
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("plan.toml" + place), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
}

constexpr const char* good_plan =
    "name = \"p\"\n[[rig]]\nname = \"pile\"\ncase = \"pile.toml\"\n[[parameter]]\nname = \"mu\"\nkeys = [\"a.b\"]\nrange = [0.1, 1.0]\n"
    "[[observable]]\nname = \"pile_height\"\ntolerance = 1.0\n";

TEST_F(Store, PlansAreReadStrictly) {
    write_text(folder / "plan.toml", good_plan);
    const CampaignPlan plan = read_campaign_plan(folder / "plan.toml");
    EXPECT_EQ(plan.rigs[0].case_file, "pile.toml");
    EXPECT_EQ(plan.parameter_keys[0], std::vector<std::string>{"a.b"});
    refuses(folder, std::string(good_plan) + "tolerances = 1\n", ":12", "tolerances");
    refuses(folder, std::string(good_plan) + "[[parameter]]\nname = \"mu\"\nkeys = [\"c\"]\nrange = [0, 1]\n", ":13", "twice");
    refuses(folder, std::string(good_plan) + "[[effect]]\nname = \"e\"\nkeys = [\"c\"]\nbaseline = 1.0\nfull = 1.0\n", ":16", "baseline");
    refuses(folder, "name = \"p\"\n", "", "[[rig]]");
}

}  // namespace
}  // namespace pelletlab::io
