// A value, a profile or a map of a result by its name; a test that asks for one that is not there fails with that name.
#pragma once

#include <stdexcept>
#include <string>

#include "core/observables.hpp"

namespace pelletlab {

inline const Observable& find(const Observables& observables, const std::string& name) {
    for (const Observable& o : observables.values)
        if (o.name == name) return o;
    throw std::runtime_error("no observable " + name);
}

inline const Profile& profile_of(const Observables& observables, const std::string& name) {
    for (const Profile& profile : observables.profiles)
        if (profile.name == name) return profile;
    throw std::runtime_error("no profile " + name);
}

inline const FieldMap& map_of(const Observables& observables, const std::string& name) {
    for (const FieldMap& map : observables.maps)
        if (map.name == name) return map;
    throw std::runtime_error("no map " + name);
}

}  // namespace pelletlab
