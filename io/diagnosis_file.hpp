// diagnosis.json: the answers of a diagnosis, written and read without loss.
#pragma once

#include <filesystem>

#include "core/diagnosis.hpp"

namespace pelletlab::io {

std::string diagnosis_text(const Diagnosis& diagnosis);
void write_diagnosis(const Diagnosis& diagnosis, const std::filesystem::path& file);
/// Throws Error(bad_input) for a file that is no diagnosis or of another version.
Diagnosis read_diagnosis(const std::filesystem::path& file);

}  // namespace pelletlab::io
