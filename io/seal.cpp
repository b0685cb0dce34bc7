#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <system_error>

#include "core/error.hpp"
#include "io/detail/seal.hpp"

namespace pelletlab::io::detail {

namespace {

namespace fs = std::filesystem;

struct Seal {
    std::array<char, 8> magic{'P', 'L', 'A', 'B', 'S', 'E', 'A', 'L'};
    std::uint64_t length = 0, checksum = 0;
    bool operator==(const Seal&) const = default;
};
static_assert(sizeof(Seal) == 24);

/// The seal that belongs behind the first `length` bytes of the stream.
Seal seal_of(std::ifstream& stream, std::uint64_t length, const fs::path& file) {
    Seal seal;
    seal.length = length;
    uLong sum = crc32_z(0, nullptr, 0);
    std::array<char, 1 << 16> buffer{};
    for (std::uint64_t left = length; left > 0;) {
        const auto wanted = static_cast<std::size_t>(std::min<std::uint64_t>(left, buffer.size()));
        if (!stream.read(buffer.data(), static_cast<std::streamsize>(wanted)))
            throw bad_input("the file cannot be read to its end", "check the disk", {file.string()});
        sum = crc32_z(sum, reinterpret_cast<const Bytef*>(buffer.data()), wanted);
        left -= wanted;
    }
    seal.checksum = sum;
    return seal;
}

}  // namespace

void seal_file(const fs::path& file) {
    Seal seal;
    {
        std::ifstream stream(file, std::ios::binary);
        seal = seal_of(stream, fs::file_size(file), file);
    }
    std::ofstream stream(file, std::ios::binary | std::ios::app);
    stream.write(reinterpret_cast<const char*>(&seal), sizeof seal);
    stream.close();
    if (!stream) throw bad_input("the file cannot be written to its end", "check the space on the disk", {file.string()});
}

void check_seal(const fs::path& file) {
    std::error_code failure;
    const std::uintmax_t size = fs::file_size(file, failure);
    std::ifstream stream(file, std::ios::binary);
    if (failure || !stream) throw bad_input("the file cannot be read", "check the name and the permissions", {file.string()});
    Seal found, expected;
    if (size >= sizeof found) {
        expected = seal_of(stream, size - sizeof found, file);
        stream.read(reinterpret_cast<char*>(&found), sizeof found);
    }
    if (size < sizeof found || !stream || found != expected)
        throw bad_input("the file is damaged or cut short: its seal is missing or does not fit", "make it again", {file.string()});
}

}  // namespace pelletlab::io::detail
