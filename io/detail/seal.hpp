// A seal at the end of a binary file: 24 bytes with the length of all before them and its checksum. A library that trusts a damaged file can run in circles;
// a sealed file is known to be whole, in one pass, before any library looks into it.
#pragma once

#include <filesystem>

namespace pelletlab::io::detail {

/// Appends «PLABSEAL», the length (64 bit) and the CRC-32 (in 64 bit) of the file, little-endian. HDF5 ignores what lies behind its end.
void seal_file(const std::filesystem::path& file);

/// Throws Error(bad_input) when the seal is missing or does not fit.
void check_seal(const std::filesystem::path& file);

}  // namespace pelletlab::io::detail
