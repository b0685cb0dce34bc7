// The library of effects: what a model of a rig usually leaves out, and what `diagnose` looks for besides the parameters that are calibrated.
// An effect turns a case into the case with the effect, or measured values into those that an instrument with the effect would have given. Adding one:
// docs/how-to/add-an-effect.md.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/case.hpp"
#include "core/observables.hpp"

namespace pelletlab::experiments {

/// Amplitudes are in `unit`; 0 is «not there», `full` the end of the plausible range.
struct Effect {
    std::string id;            ///< of the design, «B1»: B boundary, C contact, P particle, E environment, O operation, M measurement, N numerical
    std::string name;          ///< in plan.toml and on the command line
    std::string title;         ///< for people
    std::string equation;      ///< what changes, a standing for the amplitude
    std::string source;        ///< key of docs/references.bib, or where the range comes from
    std::string effect_class;  ///< boundary, contact, particle, environment, operation, measurement, numerical
    std::string unit = "1";
    double full = 1.0;
    bool two_sided = false;
    std::vector<double> levels;                                ///< the only amplitudes besides 0 that make sense; empty: all
    std::vector<Rig> rigs;                                     ///< where it acts; empty: everywhere
    std::string test;                                          ///< the cheapest measurement in the laboratory that would show it
    std::function<void(Case&, double)> on_case;                ///< exactly one of these two is set
    std::function<void(Observables&, double)> on_observables;  ///< of an instrument: costs no simulation

    bool is_measurement() const { return static_cast<bool>(on_observables); }
};

/// All effects, in the order of their classes. Names are unique.
const std::vector<Effect>& effect_library();

/// Throws Error(bad_input) for an unknown name, with the nearest known one.
const Effect& effect_named(const std::string& name);

/// The case with the effect. Amplitude 0 and a rig where the effect does not act give the same case, bit for bit. Throws Error(bad_input) for an effect of the
/// measurement, an amplitude that is none of its levels, and a case that has something of the kind already (a second cohesion, a second vibration).
Case with_effect(const Effect& effect, Case c, double amplitude);

/// What an instrument with the effect would have given. Amplitude 0 gives the same values, bit for bit; so do observables that the effect does not know.
Observables with_effect(const Effect& effect, Observables observables, double amplitude);

/// «rolling_resistance=0.03» as effect and amplitude: «drum_tilt=1.5 deg» with the effect's unit, which may be left out. Throws Error(bad_input).
std::pair<const Effect*, double> parse_effect(const std::string& text);

}  // namespace pelletlab::experiments
