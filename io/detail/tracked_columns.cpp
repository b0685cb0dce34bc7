#include "io/detail/tracked_columns.hpp"

#include <algorithm>

#include "core/units.hpp"

namespace pelletlab::io::detail {

namespace {

struct RoleNames {
    TrackedRole role;
    Dimension dimension;
    std::vector<std::string> names;  ///< the first one is the one that messages use
};

std::vector<std::string> vector_names(char component, const std::vector<std::string>& quantities, const std::vector<std::string>& short_forms) {
    std::vector<std::string> names;
    for (const std::string& form : short_forms) names.push_back(form + component);
    const std::string index(1, static_cast<char>('0' + (component - 'x')));
    for (const std::string& quantity : quantities)
        for (const std::string& name : {quantity + "_" + component, quantity + component, std::string(1, component) + "_" + quantity, quantity + "_" + index})
            names.push_back(name);
    return names;
}

const std::vector<RoleNames>& roles() {
    static const std::vector<RoleNames> table = [] {
        using R = TrackedRole;
        std::vector<RoleNames> all{
            {R::time, dimension::time, {"time", "t", "timestamp"}},
            {R::frame, dimension::none, {"frame", "frame_number", "frame_index", "image"}},
            {R::id, dimension::none, {"id", "particle", "particle_id", "particleid", "track", "track_id", "trackid", "pid", "label", "tracer", "body"}},
            {R::qw, dimension::none, {"qw", "q_w", "q0", "quaternion_w", "orientation_w", "quat_w"}},
            {R::qx, dimension::none, {"qx", "q_x", "q1", "quaternion_x", "orientation_x", "quat_x"}},
            {R::qy, dimension::none, {"qy", "q_y", "q2", "quaternion_y", "orientation_y", "quat_y"}},
            {R::qz, dimension::none, {"qz", "q_z", "q3", "quaternion_z", "orientation_z", "quat_z"}},
            {R::radius, dimension::length, {"radius", "r"}},
            {R::diameter, dimension::length, {"diameter", "dia", "d"}}};
        const std::array<R, 3> places{R::x, R::y, R::z}, velocities{R::vx, R::vy, R::vz}, spins{R::wx, R::wy, R::wz}, axes{R::axis_x, R::axis_y, R::axis_z};
        for (int k = 0; k < 3; ++k) {
            const auto component = static_cast<char>('x' + k);
            const auto i = static_cast<std::size_t>(k);
            all.push_back({places[i], dimension::length, vector_names(component, {"position", "pos", "centre", "center", "points", "p", "c"}, {""})});
            all.push_back({velocities[i], dimension::velocity, vector_names(component, {"velocity", "vel", "v"}, {"v"})});
            all.push_back({spins[i], dimension::rotation_speed, vector_names(component, {"spin", "omega", "angular_velocity", "w"}, {"w"})});
            all.push_back({axes[i], dimension::none, vector_names(component, {"axis", "direction", "n"}, {})});
        }
        return all;
    }();
    return table;
}

const RoleNames* find_role(const std::string& name) {
    for (const RoleNames& role : roles())
        if (std::find(role.names.begin(), role.names.end(), name) != role.names.end()) return &role;
    return nullptr;
}

/// «x_mm», «vx_m_per_s», «time_ms»: a known name with a unit behind it.
const RoleNames* role_with_unit(const std::string& name, std::string& unit) {
    for (std::size_t at = name.find('_'); at != std::string::npos; at = name.find('_', at + 1)) {
        const RoleNames* role = find_role(name.substr(0, at));
        if (role == nullptr || role->dimension == dimension::none) continue;
        std::string text = name.substr(at + 1);
        if (const std::size_t per = text.find("_per_"); per != std::string::npos) text.replace(per, 5, "/");
        try {
            unit_factor(text, role->dimension);
        } catch (const Error&) {
            continue;
        }
        unit = text;
        return role;
    }
    return nullptr;
}

std::string unit_from_settings(const RoleNames& role, const TrackedSettings& settings) {
    if (role.dimension == dimension::length) return settings.length_unit;
    if (role.dimension == dimension::time) return settings.time_unit;
    if (role.dimension == dimension::rotation_speed) return "rad/s";
    if (!settings.velocity_unit.empty() || settings.length_unit.empty() || settings.time_unit.empty()) return settings.velocity_unit;
    return settings.length_unit + "/" + settings.time_unit;
}

const char* option_for(const RoleNames& role) {
    if (role.dimension == dimension::length) return "--unit mm";
    return role.dimension == dimension::time ? "--time-unit s" : "--velocity-unit m/s";
}

double factor_of(const RoleNames& role, std::string unit, const TableColumn& column, const Place& place, const TrackedSettings& settings) {
    if (role.dimension == dimension::none) return 1.0;
    if (unit.empty()) unit = unit_from_settings(role, settings);
    if (unit.empty())
        throw bad_input("the column '" + column.text + "' states no unit",
                        "write it into the header, '" + column.text + " [" + usual_units(role.dimension).front() + "]', or give it with " + option_for(role),
                        place);
    try {
        return unit_factor(unit, role.dimension);
    } catch (const Error& error) {
        throw bad_input("the unit of the column '" + column.text + "': " + error.problem(), error.remedy(), place);
    }
}

void require(bool condition, const std::string& problem, const std::string& remedy, const Place& place) {
    if (!condition) throw bad_input(problem, remedy, place);
}

}  // namespace

TrackedColumns tracked_columns(const Table& table, const TrackedSettings& settings) {
    using R = TrackedRole;
    TrackedColumns found;
    for (std::size_t k = 0; k < table.columns().size(); ++k) {
        const TableColumn& column = table.columns()[k];
        std::string unit = column.unit;
        const RoleNames* role = find_role(column.name);
        if (role == nullptr && unit.empty()) role = role_with_unit(column.name, unit);
        if (role == nullptr) {
            found.ignored.push_back(column.text);
            continue;
        }
        TrackedColumns::Entry& entry = found.entries[static_cast<std::size_t>(role->role)];
        if (entry.column != TrackedColumns::npos)
            throw bad_input("the columns '" + table.columns()[entry.column].text + "' and '" + column.text + "' both mean " + role->names.front(),
                            "leave one of them out or rename it", table.header_place(k));
        entry = {k, factor_of(*role, unit, column, table.header_place(k), settings)};
    }
    const Place header = table.header_place(0);
    if (!found.has(R::time) && found.has(R::frame)) {
        require(settings.frame_rate > 0.0, "the table counts frames and nobody says how many there are in a second", "give --frame-rate \"1000 Hz\"", header);
        found.entries[static_cast<std::size_t>(R::time)] = {found.of(R::frame).column, 1.0 / settings.frame_rate};
    }
    require(found.has(R::time), "the table has no column of times", "name it: time [s]", header);
    require(found.has(R::x) + found.has(R::y) + found.has(R::z) >= 2, "the table has no columns of places",
            "name them: x [mm], y [mm], z [mm] (one of the three may lack)", header);
    require(!(found.has(R::radius) && found.has(R::diameter)), "the table has both radii and diameters", "leave one of them out", header);
    for (const auto& group : {std::array{R::vx, R::vy, R::vz}, std::array{R::wx, R::wy, R::wz}, std::array{R::axis_x, R::axis_y, R::axis_z}}) {
        const int have = found.has(group[0]) + found.has(group[1]) + found.has(group[2]);
        const bool as_places =
            group[0] == R::vx && found.has(R::vx) == found.has(R::x) && found.has(R::vy) == found.has(R::y) && found.has(R::vz) == found.has(R::z);
        if (have == 0 || have == 3 || as_places) continue;
        throw bad_input("a vector of the table has " + std::to_string(have) + " of its components (velocity, spin or axis)", "give all of them or none",
                        header);
    }
    const int parts = found.has(R::qw) + found.has(R::qx) + found.has(R::qy) + found.has(R::qz);
    require(parts == 0 || parts == 4, "the quaternion of the table lacks a component", "give qw, qx, qy and qz or none of them", header);
    require(parts == 0 || !found.has(R::axis_x), "the table has both quaternions and axes", "leave one of them out", header);
    return found;
}

}  // namespace pelletlab::io::detail
