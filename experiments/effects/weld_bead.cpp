// B5: a weld or a seam along the shell, as a bar 2 mm wide that turns with the drum; at the top while the pellets are filled in. Height 0 to 1.5 mm, half a
// pellet.
#include "core/error.hpp"
#include "experiments/effects/parts.hpp"

namespace pelletlab::experiments::effects {

Effect weld_bead() {
    return {"B5",
            "weld_bead",
            "a weld along the shell",
            "a bar of height a and width 2 mm over the drum's length, turning with it",
            "range of this project: up to half a pellet",
            "boundary",
            "mm",
            1.5,
            false,
            {},
            {Rig::drum},
            "look; a signal at the drum's own frequency",
            [](Case& c, double a) {
                if (c.walls.contains("weld_bead")) throw bad_input("the case has a wall «weld_bead» already", "the effect adds one: rename yours");
                constexpr double width = 2e-3, milli = 1e-3;
                const double height = a * milli;
                ExtraWall bar;
                bar.shape = "box";
                bar.size = {width, c.drum.length, height};
                // Its upper side lies on the chord of that width, so the bar stands out by its full height where the shell is nearest.
                bar.point = {0.0, 0.0, 0.5 * c.drum.diameter - 0.5 * height};
                bar.material = c.drum.material;
                bar.turns = true;
                c.walls["weld_bead"] = bar;
            },
            {}};
}

}  // namespace pelletlab::experiments::effects
