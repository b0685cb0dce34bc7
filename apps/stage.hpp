// A stage of the chain: an output folder that is made whole or not at all, and left alone when its inputs have not changed.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "core/provenance.hpp"

namespace pelletlab::apps {

/// Fingerprint of everything that decides a stage's result: program version, verb, settings text and the hashes of the input files.
struct StageKey {
    std::string verb;
    std::string settings;                       ///< resolved case, or options in a fixed order
    std::map<std::string, std::string> inputs;  ///< name → SHA-256
    std::string fingerprint() const;
};

Provenance provenance_of(const StageKey& key, std::uint64_t seed);

/// True when `folder` holds the finished result of this very key.
bool stage_is_finished(const std::filesystem::path& folder, const StageKey& key);

/// The output folder of a stage while it works: files are made in <folder>/unfinished.part and move into the folder together at the end, so an interrupted or
/// failed stage leaves the folder as it was, an older result included.
class StageFolder {
public:
    /// Makes the folder and clears what a killed run left in it; Error(bad_input) when it cannot be written.
    explicit StageFolder(std::filesystem::path folder);
    ~StageFolder();  ///< without finish(): removes everything unfinished, and the folder if it was made for this
    StageFolder(const StageFolder&) = delete;
    StageFolder& operator=(const StageFolder&) = delete;

    const std::filesystem::path& unfinished() const { return unfinished_; }

    /// Replaces the older result by the new one and writes <folder>/stage.json. Files that no stage made are left alone.
    void finish(const StageKey& key);

private:
    std::filesystem::path folder_, unfinished_;
    bool is_new_;
};

}  // namespace pelletlab::apps
