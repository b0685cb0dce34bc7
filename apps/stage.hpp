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
/// failed stage leaves the folder as it was, an older result included. What a stage needs to go on later it puts into resume_folder().
class StageFolder {
public:
    enum class Leftovers { remove, resume };
    /// Makes the folder and clears what a killed run left in it, but for the resume folder when the stage goes on from there; Error(bad_input) when it cannot
    /// be written.
    explicit StageFolder(std::filesystem::path folder, Leftovers leftovers = Leftovers::remove);
    ~StageFolder();  ///< without finish(): removes everything unfinished (see keep_resume_folder), and the folder if it was made for this
    StageFolder(const StageFolder&) = delete;
    StageFolder& operator=(const StageFolder&) = delete;

    const std::filesystem::path& unfinished() const { return unfinished_; }
    /// <folder>/unfinished.part/resume
    std::filesystem::path resume_folder() const { return resume_folder_of(folder_); }
    static std::filesystem::path resume_folder_of(const std::filesystem::path& folder) { return folder / "unfinished.part" / "resume"; }
    /// From now on the resume folder survives a stage that ends without finish().
    void keep_resume_folder() { keeps_resume_folder_ = true; }

    /// Replaces the older result by the new one and writes <folder>/stage.json. Files that no stage made are left alone.
    void finish(const StageKey& key);

private:
    void clear_but_resume_folder();
    std::filesystem::path folder_, unfinished_;
    bool is_new_, keeps_resume_folder_;
};

}  // namespace pelletlab::apps
