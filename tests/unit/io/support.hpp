// What the tests of io/ share: a folder that vanishes, the error of a call, bits of doubles.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include "core/error.hpp"
#include "core/vec.hpp"

namespace pelletlab::test {

class TemporaryFolder {
public:
    TemporaryFolder() {
        static std::atomic<int> count{0};
        path_ = std::filesystem::temp_directory_path() / ("pelletlab-io-" + std::to_string(getpid()) + "-" + std::to_string(count++));
        std::filesystem::create_directories(path_);
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
    const std::filesystem::path& path() const { return path_; }
    std::size_t entries() const {
        const std::filesystem::directory_iterator begin(path_), end;
        return static_cast<std::size_t>(std::distance(begin, end));
    }

private:
    std::filesystem::path path_;
};

/// The Error that the call throws; fails the test when it throws none.
template <class Call>
Error error_of(const Call& call) {
    try {
        call();
    } catch (const Error& error) {
        return error;
    }
    ADD_FAILURE() << "no Error was thrown";
    return Error(ErrorKind::usage, "no error");
}

inline std::uint64_t bits(double value) {
    return std::bit_cast<std::uint64_t>(value);
}

inline bool same_bits(const Vec3& a, const Vec3& b) {
    return bits(a[0]) == bits(b[0]) && bits(a[1]) == bits(b[1]) && bits(a[2]) == bits(b[2]);
}
inline bool same_bits(const Quat& a, const Quat& b) {
    return bits(a.w()) == bits(b.w()) && bits(a.x()) == bits(b.x()) && bits(a.y()) == bits(b.y()) && bits(a.z()) == bits(b.z());
}

inline void put(const std::filesystem::path& file, const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
}

}  // namespace pelletlab::test
