// What writer and reader of clump files agree on.
#pragma once

#include <cstdint>
#include <string>

#include "core/clump_template.hpp"

namespace pelletlab::io::detail {

inline constexpr const char* clump_format_name = "pelletlab-clump";
inline constexpr std::int64_t clump_format_version = 1;
inline constexpr const char* not_known_text = "not known";  ///< stands for NaN

inline std::string mass_source_name(MassSource source) {
    switch (source) {
        case MassSource::target_mesh:
            return "target_mesh";
        case MassSource::union_of_spheres:
            return "union_of_spheres";
        case MassSource::density_matched_union:
            break;
    }
    return "density_matched_union";
}

}  // namespace pelletlab::io::detail
