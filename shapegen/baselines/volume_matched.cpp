#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "shapegen/baselines/baselines.hpp"
#include "shapegen/union_properties.hpp"

namespace pelletlab::shapegen::baselines {

namespace {

// All radii changed by that much; spheres that vanish are left out.
std::vector<Sphere> offset(std::span<const Sphere> spheres, double by) {
    std::vector<Sphere> result;
    for (const Sphere& s : spheres)
        if (s.radius + by > 0.0) result.push_back({s.centre, s.radius + by});
    return result;
}

}  // namespace

std::vector<Sphere> volume_matched(std::span<const Sphere> spheres, double volume) {
    if (spheres.empty()) throw bad_input("there are no spheres to match", "give at least one");
    if (!(volume > 0.0) || !std::isfinite(volume)) throw bad_input("the volume to match is not positive", "give the volume of the body");
    // In lengths of the body, so that the moments see numbers of order one. The volume grows with the offset: a bracket, then the secant kept inside it.
    const double length = std::cbrt(volume);
    std::vector<Sphere> unit;
    double largest = 0.0;
    for (const Sphere& s : spheres) {
        unit.push_back({s.centre / length, s.radius / length});
        largest = std::max(largest, s.radius / length);
    }
    const auto excess = [&](double by) {
        const std::vector<Sphere> changed = offset(unit, by);
        return changed.empty() ? -1.0 : union_volume(changed) - 1.0;
    };
    double low = -largest, high = 1.0, at_low = -1.0, at_high = excess(high);
    double by = 0.0, at = excess(by);
    for (int round = 0; round < 100 && std::abs(at) > 1e-13; ++round) {
        (at < 0.0 ? low : high) = by;
        (at < 0.0 ? at_low : at_high) = at;
        const double secant = low + (high - low) * (-at_low) / (at_high - at_low), middle = 0.5 * (low + high);
        by = round % 3 == 2 ? middle : secant;
        if (!(by > low && by < high)) break;
        at = excess(by);
    }
    std::vector<Sphere> matched = offset(unit, by);
    for (Sphere& s : matched) {
        s.centre *= length;
        s.radius *= length;
    }
    return matched;
}

}  // namespace pelletlab::shapegen::baselines
