#include "apps/shape_settings.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/error.hpp"
#include "core/units.hpp"
#include "meshes/mass_properties.hpp"

namespace pelletlab::apps {

namespace {

using shapegen::StopCriteria;

struct Criterion {
    std::string name;
    double StopCriteria::*value;
    bool is_length;
};

const std::vector<Criterion>& criteria_table() {
    static const std::vector<Criterion> table{{"volume", &StopCriteria::volume_error, false},
                                              {"difference", &StopCriteria::symmetric_difference, false},
                                              {"inertia", &StopCriteria::inertia_error, false},
                                              {"mean", &StopCriteria::mean, true},
                                              {"rms", &StopCriteria::rms, true},
                                              {"max", &StopCriteria::max, true},
                                              {"edge", &StopCriteria::edge_radius, true}};
    return table;
}

}  // namespace

double share_of(std::string text, const std::string& what) {
    const bool percent = !text.empty() && text.back() == '%';
    if (percent) text.pop_back();
    std::size_t used = 0;
    double value = std::numeric_limits<double>::quiet_NaN();
    try {
        value = std::stod(text, &used);
    } catch (const std::exception&) {
        used = 0;
    }
    while (used < text.size() && text[used] == ' ') ++used;
    if (used == 0 || used != text.size() || !std::isfinite(value)) throw bad_input("'" + text.substr(0, 40) + "' is no share for " + what, "write 1% or 0.01");
    return percent ? 0.01 * value : value;
}

const std::map<std::string, shapegen::FitMode>& fit_modes() {
    static const std::map<std::string, shapegen::FitMode> modes{{"mean", shapegen::FitMode::mean},
                                                                {"minimax", shapegen::FitMode::minimax},
                                                                {"inside", shapegen::FitMode::inside},
                                                                {"outside", shapegen::FitMode::outside},
                                                                {"flat", shapegen::FitMode::flat}};
    return modes;
}

std::string name_of(shapegen::FitMode mode) {
    for (const auto& [name, value] : fit_modes())
        if (value == mode) return name;
    return "";
}

void add_criterion(const std::string& text, StopCriteria& criteria) {
    const std::size_t equal = text.find('=');
    const std::string name = text.substr(0, equal);
    std::string list;
    std::vector<std::string> names;
    for (const Criterion& criterion : criteria_table()) {
        names.push_back(criterion.name);
        list += (list.empty() ? "" : ", ") + criterion.name;
        if (criterion.name != name || equal == std::string::npos) continue;
        const std::string value = text.substr(equal + 1);
        const double wanted = criterion.is_length ? parse_quantity(value, dimension::length) : share_of(value, name);
        if (!(wanted > 0.0))
            throw bad_input("the criterion " + name.substr(0, 40) + " = " + value.substr(0, 40) + " is not positive",
                            "give what is good enough, like 0.02mm or 1%");
        criteria.*criterion.value = wanted;
        return;
    }
    const std::string guess = closest_word(name.substr(0, 40), names);
    throw usage_error("'" + text.substr(0, 60) + "' is no criterion", (guess.empty() || guess == name ? "" : "did you mean '" + guess + "'? ") +
                                                                          ("write name=value with one of " + list + ", for instance rms=0.02mm"));
}

void set_symmetry(const std::string& text, shapegen::FitSettings& settings) {
    if (text == "none") {
        settings.symmetry_choice = shapegen::SymmetryChoice::none;
    } else if (text == "own") {
        settings.symmetry_choice = shapegen::SymmetryChoice::own;
    } else if (!text.empty() && text.size() <= 3 && text.find_first_not_of("0123456789") == std::string::npos && std::stoi(text) >= 2) {
        settings.symmetry_choice = shapegen::SymmetryChoice::given;
        settings.symmetry.fold = static_cast<std::uint32_t>(std::stoi(text));
    } else {
        throw usage_error("'" + text.substr(0, 40) + "' is no symmetry", "write none, own, or how many times round the axis: 8");
    }
}

void aim_symmetry(const TriangleMesh& body, shapegen::FitSettings& settings) {
    if (settings.symmetry_choice == shapegen::SymmetryChoice::given) settings.symmetry.axis = meshes::mass_properties(body, 1.0).principal_axes * Vec3::UnitZ();
}

std::string describe(const shapegen::ClumpSettings& s) {
    const shapegen::FitSettings& f = s.fit;
    std::string text = fmt::format("mode {} n {} min_radius {:.17g} poke_out {:.17g} most_contacts {} press {:.17g} symmetry {} {} effort {:.17g} seed {}",
                                   static_cast<int>(f.mode), f.sphere_count, f.min_radius, f.poke_out, f.most_contacts, f.press,
                                   static_cast<int>(f.symmetry_choice), f.symmetry.fold, f.effort, f.seed);
    for (const Criterion& criterion : criteria_table()) text += fmt::format(" {} {:.17g}", criterion.name, s.stop.*criterion.value);
    return text + fmt::format(" most_spheres {} most_cost {:.17g} density {:.17g} mass {}", s.stop.most_spheres, s.most_cost, s.density,
                              static_cast<int>(s.mass_source));
}

}  // namespace pelletlab::apps
