// observables.json; NaN is written as null.
#pragma once

#include <filesystem>

#include "core/observables.hpp"

namespace pelletlab::io {

void write_observables(const Observables& observables, const std::filesystem::path& file);
Observables read_observables(const std::filesystem::path& file);

}  // namespace pelletlab::io
