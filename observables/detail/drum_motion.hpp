// What a drum's pellets do one by one, and what the camera sees of them, as observables. Definitions in docs/observables.md.
#pragma once

#include <vector>

#include "core/observables.hpp"
#include "observables/detail/drum_analysis.hpp"

namespace pelletlab::observables::detail {

/// A window of a drum, ready analysed, and the part of it that is measured.
struct DrumWindow {
    const FrameSource& trajectory;
    const std::vector<std::size_t>& frames;
    const Analysis& analysis;
    ViewFilter filter;
};

/// Depth of the active layer at mid-chord, its share of the bed's thickness there, and the speed extrapolated to the surface.
void add_active_layer(Observables& result, const Analysis& analysis);
/// Speed distribution with quantiles; granular temperature of the bed, of its active layer, and as a map.
void add_speeds(Observables& result, const DrumWindow& window);
/// Share of pellets in the active layer, residence times, time of circulation.
void add_circulation(Observables& result, const DrumWindow& window);
/// Lacey index against time for three ways to label the pellets of the first frame.
void add_mixing(Observables& result, const DrumWindow& window);
/// Maps of the camera and the speed distribution over its cells.
void add_camera(Observables& result, const DrumWindow& window);
/// Torque of the bed's weight about the axis, and its power; nothing when the pellets' mass is not known.
void add_weight_torque(Observables& result, const DrumWindow& window);

}  // namespace pelletlab::observables::detail
