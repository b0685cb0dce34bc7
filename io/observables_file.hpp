// observables.json; NaN is written as null.
#pragma once

#include <filesystem>
#include <string>

#include "core/observables.hpp"

namespace pelletlab::io {

/// Numbers read back to the same bits. Throws Error(numerical) for an infinite value: JSON has no word for it, and no operator should make one.
void write_observables(const Observables& observables, const std::filesystem::path& file);
std::string observables_text(const Observables& observables);

/// Throws Error(bad_input) for a file that is not ours, is cut short, lacks a member or has one too many.
Observables read_observables(const std::filesystem::path& file);
Observables parse_observables(const std::string& text, const std::string& file_name);

}  // namespace pelletlab::io
