// Files written whole or not at all, and their hashes.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace pelletlab::io {

/// Calls write(temporary) and renames the temporary file to `file`; on any failure the temporary is removed and an older `file` stays.
void write_atomically(const std::filesystem::path& file, const std::function<void(const std::filesystem::path& temporary)>& write);
void write_text(const std::filesystem::path& file, std::string_view text);
std::string read_text(const std::filesystem::path& file);

/// Returns once the file's content is on the disk and not only in the system's memory (fsync).
void bring_to_disk(const std::filesystem::path& file);

/// Makes the folder (and its parents) and proves that it can be written; Error(bad_input) otherwise.
void prepare_output_folder(const std::filesystem::path& folder);

/// SHA-256 in hexadecimal (OpenSSL).
std::string sha256_of_text(std::string_view text);
std::string sha256_of_file(const std::filesystem::path& file);

}  // namespace pelletlab::io
