// Texts of the command line that become settings of the fit, and the text of all settings for a stage's key.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/triangle_mesh.hpp"
#include "shapegen/make_clump.hpp"

namespace pelletlab::apps {

const std::map<std::string, shapegen::FitMode>& fit_modes();
std::string name_of(shapegen::FitMode mode);

/// «1%» or «0.01»; `what` is named in the Error(bad_input) for anything else.
double share_of(std::string text, const std::string& what);

/// «rms=0.02mm», «inertia=1%», … into the criteria. Error(usage) for an unknown name, Error(bad_input) for a value that means nothing.
void add_criterion(const std::string& text, shapegen::StopCriteria& criteria);

/// «none», «own», or a number: so many times round the body's own axis (the axis of revolution, or z of its principal axes).
void set_symmetry(const std::string& text, shapegen::FitSettings& settings);

/// The axis that a given symmetry turns about, once the body is known.
void aim_symmetry(const TriangleMesh& body, shapegen::FitSettings& settings);

/// Everything that decides the result, in a fixed order.
std::string describe(const shapegen::ClumpSettings& settings);

}  // namespace pelletlab::apps
