// Where a result comes from: written into every file that PelletLab makes. Holds no clock time, so equal work gives equal files.
#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace pelletlab {

struct Provenance {
    std::string tool = "pelletlab";
    std::string version;   ///< of PelletLab
    std::string git_hash;  ///< with «-dirty» when the tree had changes
    std::string verb;      ///< «shape», «fill», …
    std::uint64_t seed = 0;
    std::map<std::string, std::string> input_hashes;  ///< file name → SHA-256
};

/// Version and git hash of this build (filled in by CMake).
std::string build_version();
std::string build_git_hash();

}  // namespace pelletlab
