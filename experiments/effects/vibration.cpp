// E4: the building shakes the drum: walls swing vertically with the acceleration a g at 50 Hz, amplitude a g / (2 π f)². a from 0 to 0.3. Only the drum: tube
// and pile would never count as at rest.
#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "experiments/effects/parts.hpp"

namespace pelletlab::experiments::effects {

Effect vibration() {
    return {"E4",
            "vibration",
            "the drum is shaken",
            "walls swing vertically with a·g at 50 Hz",
            "accelerometer; range of this project",
            "environment",
            "1",
            0.3,
            false,
            {},
            {Rig::drum},
            "accelerometer; switch the neighbours off",
            [](Case& c, double a) {
                if (c.physics.vibration_frequency > 0.0) throw bad_input("the case vibrates already", "take this effect out, or the vibration out of the case");
                constexpr double frequency = 50.0, g = 9.81;
                const double omega = 2.0 * std::numbers::pi * frequency;
                c.physics.vibration_frequency = frequency;
                c.physics.vibration_amplitude = {0.0, 0.0, a * g / (omega * omega)};
            },
            {}};
}

}  // namespace pelletlab::experiments::effects
