// M1: the camera sees the layer behind the front plate and not the mean over the drum's length: v_obs = (1 − a) v + a v_front. The front layer is measured in
// every run («front_…»: two equivalent diameters behind the plate), so no simulation is needed. a from 0 to 1.
#include <algorithm>

#include "experiments/effects/parts.hpp"

namespace pelletlab::experiments::effects {

namespace {

constexpr const char* prefix = "front_";

void blend(Observables& o, double a) {
    for (Observable& value : o.values) {
        const auto front = std::find_if(o.values.begin(), o.values.end(), [&](const Observable& other) { return other.name == prefix + value.name; });
        if (front != o.values.end()) value.value = (1.0 - a) * value.value + a * front->value;
    }
    for (Profile& profile : o.profiles) {
        const auto front = std::find_if(o.profiles.begin(), o.profiles.end(), [&](const Profile& other) { return other.name == prefix + profile.name; });
        if (front == o.profiles.end() || front->axis != profile.axis) continue;
        for (std::size_t i = 0; i < profile.value.size(); ++i) profile.value[i] = (1.0 - a) * profile.value[i] + a * front->value[i];
    }
}

}  // namespace

Effect camera_layer() {
    return {"M1",
            "camera_layer",
            "the camera sees the layer at the end plate",
            "y_obs = (1 − a) y + a y_front, y_front: two pellet diameters behind the front plate",
            "end-wall layers of drums are slower; range of this project",
            "measurement",
            "1",
            1.0,
            false,
            {},
            {},
            "evaluate the simulation in the same layer: it costs nothing",
            {},
            blend};
}

}  // namespace pelletlab::experiments::effects
