#include "packing/wall_motions.hpp"

namespace pelletlab::packing {

void change_motions(solver::Simulation& simulation, const std::function<bool(const std::string& wall)>& chosen,
                    const std::function<void(solver::WallMotion&)>& change) {
    const auto& walls = simulation.definition().walls;
    for (std::size_t k = 0; k < walls.size(); ++k) {
        if (!chosen(walls[k].name)) continue;
        solver::WallMotion motion = walls[k].motion;
        change(motion);
        simulation.set_wall_motion(k, motion);
    }
}

}  // namespace pelletlab::packing
