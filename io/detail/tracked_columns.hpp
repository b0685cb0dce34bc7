// Which column of a table of tracked particles means what, and in which unit.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "io/detail/table.hpp"
#include "io/tracked_particles.hpp"

namespace pelletlab::io::detail {

enum class TrackedRole { time, frame, id, x, y, z, vx, vy, vz, wx, wy, wz, qw, qx, qy, qz, axis_x, axis_y, axis_z, radius, diameter, count };

/// For each role the table's column (npos: none) and the factor to SI.
struct TrackedColumns {
    static constexpr std::size_t npos = static_cast<std::size_t>(-1);
    struct Entry {
        std::size_t column = npos;
        double factor = 1.0;
    };
    std::array<Entry, static_cast<std::size_t>(TrackedRole::count)> entries;
    std::vector<std::string> ignored;

    const Entry& of(TrackedRole role) const { return entries[static_cast<std::size_t>(role)]; }
    bool has(TrackedRole role) const { return of(role).column != npos; }
    bool has_all(std::initializer_list<TrackedRole> roles) const {
        for (const TrackedRole role : roles)
            if (!has(role)) return false;
        return true;
    }
    /// Value of the present row in SI units; NaN where the cell is empty.
    double value(const Table& table, TrackedRole role) const { return table.number(of(role).column) * of(role).factor; }
};

/// Throws Error(bad_input) when time or two of the coordinates have no column, when two columns mean the same, or for a missing or wrong unit.
TrackedColumns tracked_columns(const Table& table, const TrackedSettings& settings);

}  // namespace pelletlab::io::detail
