// What all rigs of `pelletlab observe` share: options to numbers, the stage around a measurement, pictures.
#pragma once

#include <functional>
#include <optional>

#include "apps/observe_stage.hpp"
#include "core/observables.hpp"
#include "core/units.hpp"
#include "report/chart.hpp"

namespace pelletlab::apps {

double given(const std::string& text, Dimension dimension, double otherwise);

/// A number that a run of our own knows and a table does not. Throws Error(usage) when neither states it.
double needed(const std::string& text, Dimension dimension, const std::optional<double>& of_case, const char* option, const char* what);

/// The case of a run of our own, nothing for a table. Throws Error(usage) for a run of another rig.
const Case* case_of(const OpenedTrajectory& opened, Rig rig);

/// --from and --until; `begin` when there is no --from, the last frame when there is no --until.
TimeWindow window_of(const ObserveRequest& request, const FrameSource& frames, double begin);

using ObservedPictures = std::function<void(const Observables&, const std::filesystem::path& folder)>;

/// Measures unless the folder holds the result of the same file and options already; writes observables.json, profiles.csv and pictures together.
void finish(const ObserveRequest& request, const char* rig, const OpenedTrajectory& opened, const std::function<Observables()>& measure,
            const ObservedPictures& pictures);

/// Values that the run itself left beside its trajectory, in observables.json; nothing when there is no such file.
std::optional<Observables> observables_beside(const std::filesystem::path& trajectory);

/// `circle` [m], of a drum drawn round the origin; 0: none. Nothing is written when there is no such map.
void write_map(const Observables& observables, const char* map, double circle, const std::filesystem::path& file);
void write_chart(const std::optional<report::Chart>& chart, const std::filesystem::path& file);

}  // namespace pelletlab::apps
