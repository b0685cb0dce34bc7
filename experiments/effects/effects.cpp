#include "experiments/effects/effects.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <tuple>

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/units.hpp"
#include "experiments/effects/parts.hpp"

namespace pelletlab::experiments {

namespace {

std::vector<Effect> collect() {
    using namespace effects;
    std::vector<Effect> all{end_plate_friction(), axis_tilt(),     weld_bead(),    velocity_dependent_restitution(),
                            vibration(),          edge_rounding(), camera_layer(), window_average()};
    for (const auto& some : {operating_effects(), cohesion_effects(), camera_geometry_effects()}) all.insert(all.end(), some.begin(), some.end());
    const std::string order = "BCPEOMN";
    std::stable_sort(all.begin(), all.end(), [&](const Effect& a, const Effect& b) {
        const auto rank = [&](const Effect& e) { return std::tuple(order.find(e.id[0]), e.id.size(), e.id); };
        return rank(a) < rank(b);
    });
    return all;
}

void check_level(const Effect& effect, double amplitude) {
    if (!std::isfinite(amplitude)) throw bad_input("the amplitude of '" + effect.name + "' is not a number", "give a number in " + effect.unit);
    if (effect.levels.empty()) return;
    const bool known = std::any_of(effect.levels.begin(), effect.levels.end(), [&](double l) { return std::abs(l - amplitude) <= 1e-9 * std::abs(l); });
    if (known) return;
    std::string levels;
    for (const double l : effect.levels) levels += (levels.empty() ? "" : ", ") + fmt::format("{:.6g}", l);
    throw bad_input("'" + effect.name + "' cannot have the amplitude " + fmt::format("{:.6g}", amplitude), "it has these: " + levels);
}

}  // namespace

const std::vector<Effect>& effect_library() {
    static const std::vector<Effect> library = collect();
    return library;
}

const Effect& effect_named(const std::string& name) {
    std::vector<std::string> names;
    for (const Effect& e : effect_library()) {
        if (e.name == name) return e;
        names.push_back(e.name);
    }
    const std::string guess = closest_word(name.substr(0, 40), names);
    throw bad_input("the library has no effect '" + name.substr(0, 40) + "'",
                    (guess.empty() ? "" : "did you mean '" + guess + "'? ") + std::string("all are listed by: pelletlab diagnose effects"));
}

Case with_effect(const Effect& effect, Case c, double amplitude) {
    if (effect.is_measurement())
        throw bad_input("'" + effect.name + "' is an effect of the measurement: it changes no run", "a campaign applies it to what was measured");
    if (amplitude == 0.0) return c;
    check_level(effect, amplitude);
    if (!effect.rigs.empty() && std::find(effect.rigs.begin(), effect.rigs.end(), c.rig) == effect.rigs.end()) return c;
    effect.on_case(c, amplitude);
    return c;
}

Observables with_effect(const Effect& effect, Observables observables, double amplitude) {
    if (!effect.is_measurement()) throw bad_input("'" + effect.name + "' changes the run, not what is measured in it", "apply it to the case");
    if (amplitude == 0.0) return observables;
    check_level(effect, amplitude);
    effect.on_observables(observables, amplitude);
    return observables;
}

std::pair<const Effect*, double> parse_effect(const std::string& text) {
    const auto equals = text.find('=');
    if (equals == std::string::npos) throw bad_input("'" + text + "' names no amplitude", "write name=amplitude, as in rolling_resistance=0.03");
    const Effect& effect = effect_named(text.substr(0, equals));
    std::string number = text.substr(equals + 1);
    const auto last = number.find_last_not_of(' ');
    number.erase(last == std::string::npos ? 0 : last + 1);
    number.erase(0, std::min(number.find_first_not_of(' '), number.size()));
    double value = 0.0;
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
    if (error == std::errc() && end == number.data() + number.size()) return {&effect, value};
    if (effect.unit == "1")
        throw bad_input("the amplitude of '" + effect.name + "' is a plain number, not '" + number + "'",
                        "write for instance " + effect.name + "=" + fmt::format("{:.6g}", effect.full));
    const Dimension dimension = unit_dimension(effect.unit);
    return {&effect, parse_quantity(number, dimension) / unit_factor(effect.unit, dimension)};
}

}  // namespace pelletlab::experiments
