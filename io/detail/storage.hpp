// Arrays and texts in one HDF5 file. The library itself is included in storage_hdf5.cpp alone; use it from one thread at a time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace pelletlab::io::detail {

/// Paths are «/walls/0/vertices»; groups on the way are made as needed. Arrays are chunked, shuffled, deflated and carry a checksum.
/// Every failure is an Error(bad_input) with the file's name, the path and HDF5's own reason.
class Storage {
public:
    static Storage create(const std::filesystem::path& file);
    static Storage open(const std::filesystem::path& file);
    Storage(Storage&&) noexcept;
    Storage& operator=(Storage&&) noexcept;
    ~Storage();

    bool has(const std::string& path) const;

    void write_text(const std::string& path, const std::string& text);
    std::string text(const std::string& path) const;

    /// Rows of `columns` numbers each; `unit` becomes an attribute of the array. An array without rows is not stored and reads back as empty.
    void write(const std::string& path, std::span<const double> values, std::size_t columns, const char* unit);
    void write(const std::string& path, std::span<const std::uint32_t> values, std::size_t columns);
    void write(const std::string& path, std::uint64_t value);
    std::vector<double> numbers(const std::string& path, std::size_t columns) const;
    std::vector<std::uint32_t> indices(const std::string& path, std::size_t columns) const;
    std::uint64_t whole(const std::string& path) const;

    /// An array that grows by one row at a time; a row has this shape, {} for a single number, {bodies, 3} for a vector a body.
    void create_rows(const std::string& path, const std::vector<std::size_t>& row_shape, const char* unit);
    void append_row(const std::string& path, std::span<const double> row);
    std::size_t row_count(const std::string& path, const std::vector<std::size_t>& row_shape) const;
    void read_row(const std::string& path, std::size_t index, std::span<double> row) const;

    /// Writes everything out, closes the file and seals it (seal.hpp): open() refuses a file that is not whole. The destructor closes without a word about
    /// failures, and without the seal.
    void close();

private:
    struct Open;
    explicit Storage(std::unique_ptr<Open> open);
    std::unique_ptr<Open> open_;
};

}  // namespace pelletlab::io::detail
