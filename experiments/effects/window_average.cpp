// M2: image velocimetry averages over interrogation windows of width a: y_obs(s) = mean of y over |s' − s| ≤ a/2, as far as there is a bed (the window is cut
// at the surface, where nothing is seen). a from 0 to 14 mm, four pellet diameters. The surface velocity of the drum is the mean of depth_velocity over the
// first pellet diameter, so it changes by what that mean changes.
#include <algorithm>
#include <cmath>

#include "experiments/effects/parts.hpp"

namespace pelletlab::experiments::effects {

namespace {

/// Mean over the window, the profile taken as constant in its bins, those without a value left out.
std::vector<double> windowed(const Profile& p, double width) {
    std::vector<double> result = p.value;
    if (p.axis.size() < 2) return result;
    const double bin = std::abs(p.axis[1] - p.axis[0]), half = 0.5 * width;
    for (std::size_t i = 0; i < p.axis.size(); ++i) {
        if (std::isnan(p.value[i])) continue;
        double sum = 0.0, weight = 0.0;
        for (std::size_t j = 0; j < p.axis.size(); ++j) {
            if (std::isnan(p.value[j])) continue;
            const double low = std::max(p.axis[i] - half, p.axis[j] - 0.5 * bin), high = std::min(p.axis[i] + half, p.axis[j] + 0.5 * bin);
            if (high <= low) continue;
            sum += (high - low) * p.value[j];
            weight += high - low;
        }
        if (weight > 0.0) result[i] = sum / weight;
    }
    return result;
}

/// Mean of the bins within one pellet diameter of the surface: two bins of d/2.
double near_surface(const std::vector<double>& value) {
    return value.size() < 2 ? not_known : 0.5 * (value[0] + value[1]);
}

void average(Observables& o, double width) {
    for (Profile& p : o.profiles) {
        if (p.name != "depth_velocity" && p.name != "surface_velocity" && p.name != "front_depth_velocity" && p.name != "front_surface_velocity") continue;
        const auto smooth = windowed(p, width);
        const double change = near_surface(smooth) - near_surface(p.value);
        const std::string number = p.name == "depth_velocity" ? "surface_velocity" : p.name == "front_depth_velocity" ? "front_surface_velocity" : "";
        for (Observable& value : o.values)
            if (value.name == number && std::isfinite(change)) value.value += change;
        p.value = smooth;
    }
}

}  // namespace

Effect window_average() {
    return {"M2",
            "window_average",
            "velocities averaged over windows",
            "v_obs(s) = mean of v over |s' − s| ≤ a/2 within the bed",
            "windows of image velocimetry; range: four pellet diameters",
            "measurement",
            "mm",
            14.0,
            false,
            {},
            {},
            "evaluate the pictures with smaller windows",
            {},
            average};
}

}  // namespace pelletlab::experiments::effects
