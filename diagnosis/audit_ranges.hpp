// The part of the audit that compares with the campaign: values that no baseline run comes near, and mistakes that would bring them back.
#pragma once

#include "core/diagnosis.hpp"
#include "diagnosis/problem.hpp"

namespace pelletlab::diagnosis {

/// A measurement is described by its size r = y·m / m·m beside the mean m of the baseline runs. When r lies outside the runs' own sizes by more than their
/// range (in the logarithm, where all are positive) and three of its uncertainties, the item says so, and which single mistakes bring it back among them: a
/// factor of a unit (rpm for rad/s, mm for m, degrees for radians, …), the sign, or another regime of the campaign. Nothing is corrected.
std::vector<AuditItem> audit_ranges(const Problem& problem);

}  // namespace pelletlab::diagnosis
