// B1: the end plates are of another material, or worn, than the shell: μ(end) = μ(shell) (1 + a). What it does to a bed of flowing depth h in a drum of length
// W is the heap's balance tan β ≈ μ_i + K μ_end h / W. a in [−0.5, 0.5]; range: glass or steel against plastics.
#include "experiments/effects/parts.hpp"

namespace pelletlab::experiments::effects {

ContactParameters contact_with_wall(const Case& c, const std::string& wall, const std::string& material) {
    const auto own = c.contacts.find("pellet-" + wall);
    return own != c.contacts.end() ? own->second : c.contacts.at("pellet-" + material);
}

Effect end_plate_friction() {
    return {"B1",
            "end_plate_friction",
            "end plates rougher than the shell",
            "sliding friction with the end plates (1 + a), shell unchanged",
            "Taberlet et al. 2003, heaps between rough walls",
            "boundary",
            "1",
            0.5,
            true,
            {},
            {Rig::drum},
            "tilt a pellet on the plate and on the shell",
            [](Case& c, double a) {
                for (const char* plate : {"front", "back"}) {
                    ContactParameters row = contact_with_wall(c, plate, c.drum.material);
                    row.sliding_friction *= 1.0 + a;
                    c.contacts["pellet-" + std::string(plate)] = row;
                }
            },
            {}};
}

}  // namespace pelletlab::experiments::effects
