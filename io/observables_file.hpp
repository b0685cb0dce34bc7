// observables.json; NaN is written as null.
#pragma once

#include <filesystem>
#include <string>

#include "core/observables.hpp"

namespace pelletlab::io {

/// Numbers read back to the same bits. Throws Error(numerical) for an infinite value: JSON has no word for it, and no operator should make one.
void write_observables(const Observables& observables, const std::filesystem::path& file);
std::string observables_text(const Observables& observables);

/// All profiles as one CSV table: profile, unit, axis_name, axis_unit, axis, value, standard_error; empty cells for what is not known.
void write_profiles(const Observables& observables, const std::filesystem::path& file);

/// Throws Error(bad_input) for a file that is not ours, is cut short, lacks a member or has one too many.
Observables read_observables(const std::filesystem::path& file);
Observables parse_observables(const std::string& text, const std::string& file_name);

}  // namespace pelletlab::io
