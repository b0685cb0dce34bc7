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

/// Called last, when every file of the stage is in place: writes <folder>/stage.json.
void mark_stage_finished(const std::filesystem::path& folder, const StageKey& key);

/// Called first: removes the mark and leftovers (*.part) of an earlier, interrupted attempt.
void begin_stage(const std::filesystem::path& folder);

}  // namespace pelletlab::apps
