#include "apps/stage.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

#include "io/files.hpp"

namespace pelletlab::apps {

namespace fs = std::filesystem;

namespace {
fs::path mark_of(const fs::path& folder) {
    return folder / "stage.json";
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
    if (!fs::exists(mark_of(folder))) return false;
    const auto mark = nlohmann::json::parse(io::read_text(mark_of(folder)), nullptr, false);
    if (!mark.is_object() || mark.value("fingerprint", std::string()) != key.fingerprint()) return false;
    for (const auto& file : mark.value("files", std::vector<std::string>()))
        if (!fs::exists(folder / file)) return false;
    return true;
}

void begin_stage(const fs::path& folder) {
    io::prepare_output_folder(folder);
    fs::remove(mark_of(folder));
    std::vector<fs::path> leftovers;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_regular_file() && entry.path().extension() == ".part") leftovers.push_back(entry.path());
    for (const fs::path& file : leftovers) fs::remove(file);
}

void mark_stage_finished(const fs::path& folder, const StageKey& key) {
    nlohmann::json mark;
    mark["fingerprint"] = key.fingerprint();
    mark["version"] = build_version();
    mark["git_hash"] = build_git_hash();
    mark["verb"] = key.verb;
    mark["inputs"] = key.inputs;
    std::vector<std::string> files;
    for (const auto& entry : fs::directory_iterator(folder))
        if (entry.is_regular_file() && entry.path() != mark_of(folder)) files.push_back(entry.path().filename().string());
    std::sort(files.begin(), files.end());
    mark["files"] = files;
    io::write_text(mark_of(folder), mark.dump(2) + "\n");
}

}  // namespace pelletlab::apps
