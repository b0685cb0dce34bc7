// A diagnosis as one offline page: verdict, gap on the profiles, where, which, how far, what next, and what the data could see.
#pragma once

#include <string>

#include "core/diagnosis.hpp"

namespace pelletlab::report {

/// Self-contained HTML with inline SVG: no script, no network.
std::string diagnosis_html(const Diagnosis& diagnosis);

}  // namespace pelletlab::report
