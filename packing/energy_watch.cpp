#include "packing/energy_watch.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/error.hpp"
#include "solver/time_step.hpp"

namespace pelletlab::packing {

namespace {

double kinetic(const solver::EnergyReport& e) {
    return e.kinetic_translation + e.kinetic_rotation;
}

/// «time 0.5 s, step 50000; the step is 32 % of the limit that holds at these overlaps».
std::string where(const solver::Simulation& s, double overlap_ratio) {
    const solver::TimeStepAdvice advice = solver::advise_time_step(s.definition());
    const double step = s.definition().time_step;
    std::ostringstream text;
    text << ", time " << s.time() << " s, step " << s.step_count() << "; overlaps reach " << overlap_ratio << " of a sphere's radius, where the time step of "
         << step << " s is " << 100.0 * step / advice.limit_at(overlap_ratio) << " % of the limit";
    return text.str();
}

}  // namespace

EnergyWatch::EnergyWatch(const solver::Simulation& s) {
    const solver::EnergyReport e = s.energy();
    start_ = kinetic(e) + e.gravity - e.input();
    most_kinetic_ = kinetic(e);
    for (const std::uint32_t index : s.bodies().template_index) {
        const MassProperties& m = s.definition().templates[index].mass_properties;
        slack_ += m.mass * s.definition().gravity.norm() * equivalent_diameter(m.volume);
    }
}

void EnergyWatch::look(const solver::Simulation& s, double overlap_ratio) {
    if (overlap_ratio >= 1.0)
        throw numerical_failure("spheres have passed through each other or through a wall" + where(s, overlap_ratio),
                                "use a smaller time.step, a stiffer material (shear_modulus), or gentler insertion");
    const solver::EnergyReport e = s.energy();
    const double gained = kinetic(e) + e.gravity - e.input() - start_;
    if (gained > most_kinetic_ + slack_) {
        std::ostringstream text;
        text << "the pellets have gained " << gained << " J that nothing put in: the contacts are unstable" << where(s, overlap_ratio);
        throw numerical_failure(text.str(), "use a smaller time.step");
    }
    // What was gained does not count: a run that explodes slowly must not raise its own allowance.
    most_kinetic_ = std::max(most_kinetic_, kinetic(e) - std::max(0.0, gained));
}

}  // namespace pelletlab::packing
