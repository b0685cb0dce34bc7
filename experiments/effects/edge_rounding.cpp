// P1: the rims of the pellets are worn. A clump cannot be rounded by a formula, so the effect takes its clump from a family of fits with as many spheres, made
// by
//   pelletlab shape family --body cylinder --rim-radius 0mm,0.1mm,0.2mm,0.3mm,0.4mm -n 16 -o pellets
// beside the clump of the case: rim-0.2mm.clump.toml. The volume falls with the rims, as that of worn pellets does.
#include <fmt/format.h>

#include <filesystem>

#include "experiments/effects/parts.hpp"

namespace pelletlab::experiments::effects {

Effect edge_rounding() {
    return {"P1",
            "edge_rounding",
            "worn rims",
            "rims with the radius a: clump «rim-<a>mm.clump.toml» of a family beside that of the case",
            "range of this project: r/d up to 0.13",
            "particle",
            "mm",
            0.4,
            false,
            {0.1, 0.2, 0.3, 0.4},
            {},
            "photograph of 50 pellets against a light",
            [](Case& c, double a) {
                c.pellet.clump_file = (std::filesystem::path(c.pellet.clump_file).parent_path() / fmt::format("rim-{:.3g}mm.clump.toml", a)).string();
            },
            {}};
}

}  // namespace pelletlab::experiments::effects
