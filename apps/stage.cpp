#include "apps/stage.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "io/files.hpp"

namespace pelletlab::apps {

namespace fs = std::filesystem;

namespace {
fs::path mark_of(const fs::path& folder) {
    return folder / "stage.json";
}

/// The mark of an older result; null when there is none or it cannot be read.
nlohmann::json read_mark(const fs::path& folder) {
    if (!fs::exists(mark_of(folder))) return nullptr;
    return nlohmann::json::parse(io::read_text(mark_of(folder)), nullptr, false);
}

/// Removes one file or folder directly in `folder`: a mark that was edited must not lead anywhere else.
void remove_result(const fs::path& folder, const std::string& name) {
    if (!name.empty() && name != "." && name != ".." && fs::path(name).filename() == name) fs::remove_all(folder / name);
}

}  // namespace

std::string StageKey::fingerprint() const {
    std::string text = build_version() + "\n" + build_git_hash() + "\n" + verb + "\n" + settings + "\n";
    for (const auto& [name, hash] : inputs) text += name + " " + hash + "\n";
    return io::sha256_of_text(text);
}

Provenance provenance_of(const StageKey& key, std::uint64_t seed) {
    Provenance provenance;
    provenance.version = build_version();
    provenance.git_hash = build_git_hash();
    provenance.verb = key.verb;
    provenance.seed = seed;
    provenance.input_hashes = key.inputs;
    return provenance;
}

bool stage_is_finished(const fs::path& folder, const StageKey& key) {
    const auto mark = read_mark(folder);
    if (!mark.is_object() || mark.value("fingerprint", std::string()) != key.fingerprint()) return false;
    for (const auto& file : mark.value("files", std::vector<std::string>()))
        if (!fs::exists(folder / file)) return false;
    return true;
}

StageFolder::StageFolder(fs::path folder, Leftovers leftovers)
    : folder_(std::move(folder)),
      unfinished_(folder_ / "unfinished.part"),
      is_new_(!fs::exists(folder_)),
      keeps_resume_folder_(leftovers == Leftovers::resume) {
    io::prepare_output_folder(folder_);
    if (keeps_resume_folder_)
        clear_but_resume_folder();
    else
        fs::remove_all(unfinished_);
    io::prepare_output_folder(unfinished_);
    io::prepare_output_folder(resume_folder());
}

StageFolder::~StageFolder() {
    std::error_code ignored;
    if (keeps_resume_folder_) {
        clear_but_resume_folder();
        return;
    }
    fs::remove_all(unfinished_, ignored);
    if (is_new_) fs::remove(folder_, ignored);  // succeeds for an empty folder only
}

void StageFolder::clear_but_resume_folder() {
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(unfinished_, ignored))
        if (entry.path() != resume_folder()) fs::remove_all(entry.path(), ignored);
}

void StageFolder::finish(const StageKey& key) {
    std::vector<std::string> files;
    for (const auto& entry : fs::directory_iterator(unfinished_))
        if (entry.path() != resume_folder()) files.push_back(entry.path().filename().string());
    std::sort(files.begin(), files.end());
    nlohmann::json mark;
    mark["fingerprint"] = key.fingerprint();
    mark["version"] = build_version();
    mark["git_hash"] = build_git_hash();
    mark["verb"] = key.verb;
    mark["inputs"] = key.inputs;
    mark["files"] = files;

    const auto older = read_mark(folder_);
    fs::remove(mark_of(folder_));
    if (older.is_object())
        for (const auto& file : older.value("files", std::vector<std::string>())) remove_result(folder_, file);
    for (const std::string& file : files) {
        remove_result(folder_, file);
        fs::rename(unfinished_ / file, folder_ / file);
    }
    io::write_text(mark_of(folder_), mark.dump(2) + "\n");
    keeps_resume_folder_ = false;
}

}  // namespace pelletlab::apps
