#include "io/campaign_store.hpp"

#include <sqlite3.h>

#include <functional>
#include <nlohmann/json.hpp>

#include "core/error.hpp"

namespace pelletlab::io {

namespace {

constexpr int store_version = 1;
constexpr const char* state_names[] = {"planned", "running", "finished", "failed"};

RunState state_of(const std::string& name) {
    for (int i = 0; i < 4; ++i)
        if (name == state_names[i]) return static_cast<RunState>(i);
    throw bad_input("the campaign store holds a run in the unknown state '" + name + "'",
                    "it was changed by another program: restore it, or begin a new campaign");
}

}  // namespace

struct CampaignStore::Database {
    sqlite3* handle = nullptr;
    std::string file;

    ~Database() { sqlite3_close(handle); }

    [[noreturn]] void problem() const {
        throw bad_input("the campaign store cannot be used: " + std::string(sqlite3_errmsg(handle)),
                        "is the disk full, or the file no campaign.sqlite? Finished runs in it are safe", {file});
    }
    void execute(const char* text) const {
        if (sqlite3_exec(handle, text, nullptr, nullptr, nullptr) != SQLITE_OK) problem();
    }
};

namespace {

/// A prepared statement; values are bound in the order of the calls.
class Statement {
public:
    template <class Database>
    Statement(const Database& database, const char* text) : problem_([&database] { database.problem(); }) {
        if (sqlite3_prepare_v2(database.handle, text, -1, &statement_, nullptr) != SQLITE_OK) database.problem();
    }
    ~Statement() { sqlite3_finalize(statement_); }
    Statement(const Statement&) = delete;
    Statement& operator=(const Statement&) = delete;

    Statement& bind(const std::string& text) {
        sqlite3_bind_text(statement_, ++bound_, text.data(), static_cast<int>(text.size()), SQLITE_TRANSIENT);
        return *this;
    }
    Statement& bind(double value) {
        sqlite3_bind_double(statement_, ++bound_, value);
        return *this;
    }
    Statement& bind(std::int64_t value) {
        sqlite3_bind_int64(statement_, ++bound_, value);
        return *this;
    }
    /// True while there is a row.
    bool step() {
        const int code = sqlite3_step(statement_);
        if (code != SQLITE_ROW && code != SQLITE_DONE) problem_();
        return code == SQLITE_ROW;
    }
    std::string text(int column) const {
        const auto* at = reinterpret_cast<const char*>(sqlite3_column_text(statement_, column));
        return at == nullptr ? std::string() : std::string(at, static_cast<std::size_t>(sqlite3_column_bytes(statement_, column)));
    }
    double number(int column) const { return sqlite3_column_double(statement_, column); }
    std::int64_t whole(int column) const { return sqlite3_column_int64(statement_, column); }

private:
    sqlite3_stmt* statement_ = nullptr;
    int bound_ = 0;
    std::function<void()> problem_;
};

/// Everything or nothing, alone with the file.
template <class Database, class Work>
void transaction(const Database& database, const Work& work) {
    database.execute("BEGIN IMMEDIATE");
    try {
        work();
        database.execute("COMMIT");
    } catch (...) {
        sqlite3_exec(database.handle, "ROLLBACK", nullptr, nullptr, nullptr);
        throw;
    }
}

constexpr const char* columns = "number, key, rig, parameters, effects, seed, state, worker, seconds, message, observables";

StoredRun run_of(const Statement& s) {
    StoredRun run;
    run.number = static_cast<int>(s.whole(0));
    run.key = s.text(1);
    run.rig = s.text(2);
    run.parameters = nlohmann::json::parse(s.text(3)).get<std::vector<double>>();
    run.effects = nlohmann::json::parse(s.text(4)).get<std::vector<double>>();
    run.seed = static_cast<std::uint64_t>(s.whole(5));
    run.state = state_of(s.text(6));
    run.worker = s.text(7);
    run.seconds = s.number(8);
    run.message = s.text(9);
    run.observables = s.text(10);
    return run;
}

}  // namespace

CampaignStore::CampaignStore(const std::filesystem::path& file) : database_(std::make_unique<Database>()) {
    database_->file = file.string();
    if (sqlite3_open(file.c_str(), &database_->handle) != SQLITE_OK) database_->problem();
    sqlite3_busy_timeout(database_->handle, 60000);
    database_->execute("PRAGMA journal_mode = WAL; PRAGMA synchronous = NORMAL;");
    std::int64_t version = 0;
    {
        Statement found(*database_, "PRAGMA user_version");
        if (found.step()) version = found.whole(0);
    }
    if (version == 0) {
        transaction(*database_, [&] {
            database_->execute(
                "CREATE TABLE IF NOT EXISTS run (key TEXT PRIMARY KEY, number INTEGER NOT NULL, listed INTEGER NOT NULL, rig TEXT NOT NULL, parameters TEXT "
                "NOT NULL, effects TEXT NOT NULL,"
                " seed INTEGER NOT NULL, state TEXT NOT NULL, worker TEXT NOT NULL DEFAULT '', seconds REAL NOT NULL DEFAULT 0, message TEXT NOT NULL DEFAULT "
                "'', observables TEXT NOT NULL DEFAULT '');"
                "PRAGMA user_version = 1;");
        });
    } else if (version != store_version) {
        throw bad_input("the campaign store is of version " + std::to_string(version) + ", this program reads version " + std::to_string(store_version),
                        "go on with the program that made it, or begin a new campaign in another folder", {file.string()});
    }
}

CampaignStore::~CampaignStore() = default;

void CampaignStore::set_design(const std::vector<StoredRun>& runs) {
    transaction(*database_, [&] {
        database_->execute("UPDATE run SET listed = 0");
        for (const StoredRun& run : runs) {
            Statement insert(*database_,
                             "INSERT INTO run (key, number, listed, rig, parameters, effects, seed, state) VALUES (?, ?, 1, ?, ?, ?, ?, 'planned')"
                             " ON CONFLICT (key) DO UPDATE SET listed = 1, number = excluded.number");
            insert.bind(run.key)
                .bind(std::int64_t{run.number})
                .bind(run.rig)
                .bind(nlohmann::json(run.parameters).dump())
                .bind(nlohmann::json(run.effects).dump());
            insert.bind(static_cast<std::int64_t>(run.seed)).step();
        }
    });
}

std::vector<StoredRun> CampaignStore::runs() const {
    std::vector<StoredRun> list;
    Statement select(*database_, (std::string("SELECT ") + columns + " FROM run WHERE listed = 1 ORDER BY number").c_str());
    while (select.step()) list.push_back(run_of(select));
    return list;
}

std::vector<int> CampaignStore::counts() const {
    std::vector<int> counts(4, 0);
    Statement select(*database_, "SELECT state, COUNT(*) FROM run WHERE listed = 1 GROUP BY state");
    while (select.step()) counts[static_cast<std::size_t>(state_of(select.text(0)))] = static_cast<int>(select.whole(1));
    return counts;
}

bool CampaignStore::claim(const std::string& worker, StoredRun& run) {
    bool found = false;
    transaction(*database_, [&] {
        {
            Statement select(*database_,
                             (std::string("SELECT ") + columns + " FROM run WHERE listed = 1 AND state = 'planned' ORDER BY number LIMIT 1").c_str());
            found = select.step();
            if (found) run = run_of(select);
        }
        if (!found) return;
        run.state = RunState::running;
        run.worker = worker;
        Statement take(*database_, "UPDATE run SET state = 'running', worker = ? WHERE key = ?");
        take.bind(worker).bind(run.key).step();
    });
    return found;
}

void CampaignStore::finish(const std::string& key, double seconds, const std::string& text) {
    Statement update(*database_, "UPDATE run SET state = 'finished', seconds = ?, observables = ?, message = '' WHERE key = ?");
    update.bind(seconds).bind(text).bind(key).step();
}

void CampaignStore::fail(const std::string& key, double seconds, const std::string& message) {
    Statement update(*database_, "UPDATE run SET state = 'failed', seconds = ?, message = ? WHERE key = ?");
    update.bind(seconds).bind(message).bind(key).step();
}

void CampaignStore::release(const std::string& key) {
    Statement update(*database_, "UPDATE run SET state = 'planned', worker = '' WHERE key = ? AND state = 'running'");
    update.bind(key).step();
}

std::vector<std::string> CampaignStore::busy_workers() const {
    std::vector<std::string> workers;
    Statement select(*database_, "SELECT DISTINCT worker FROM run WHERE state = 'running'");
    while (select.step()) workers.push_back(select.text(0));
    return workers;
}

void CampaignStore::release_runs_of(const std::string& worker) {
    Statement update(*database_, "UPDATE run SET state = 'planned', worker = '' WHERE worker = ? AND state = 'running'");
    update.bind(worker).step();
}

int CampaignStore::retry_failed() {
    Statement update(*database_, "UPDATE run SET state = 'planned', worker = '', message = '' WHERE state = 'failed' AND listed = 1");
    update.step();
    return sqlite3_changes(database_->handle);
}

}  // namespace pelletlab::io
