// Checks between the keys of a case, as far as they need no mesh; and the materials and contacts that a case may leave out.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/case.hpp"
#include "core/error.hpp"

namespace pelletlab::io::detail {

/// Where each key and table of a case was written: «tube.diameter», «materials.glass».
class CasePlaces {
public:
    explicit CasePlaces(std::string file) : file_(std::move(file)) {}

    void set(const std::string& path, const Place& place) { places_[path] = place; }
    bool has(const std::string& path) const { return places_.contains(path); }
    /// Place of the first of these that was written; else the file alone.
    Place of(const std::vector<std::string>& paths) const;

private:
    std::string file_;
    std::map<std::string, Place> places_;
};

/// Puts in the study's pellet and vessel and their contacts where the rig refers to them and the case does not define them.
void add_default_materials(Case& c);

/// Throws Error(bad_input) for the first contradiction, at the place of the key that causes it.
void check_case(const Case& c, const CasePlaces& places);

}  // namespace pelletlab::io::detail
