#include <hdf5.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <utility>

#include "core/error.hpp"
#include "io/detail/storage.hpp"

namespace pelletlab::io::detail {

namespace {

constexpr unsigned deflate_level = 2;                      // level 1 to 3 differ little in size, and higher ones only cost time
constexpr std::size_t chunk_bytes = std::size_t{1} << 18;  // of growing arrays
constexpr hsize_t most_elements = hsize_t{1} << 33;        // a count beyond this is damage, not data

/// HDF5 prints its error stack to stderr unless told not to; libraries never print.
class QuietErrors {
public:
    QuietErrors() {
        H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
        H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    }
    ~QuietErrors() { H5Eset_auto2(H5E_DEFAULT, function_, data_); }
    QuietErrors(const QuietErrors&) = delete;
    QuietErrors& operator=(const QuietErrors&) = delete;

private:
    H5E_auto2_t function_ = nullptr;
    void* data_ = nullptr;
};

/// Owns one HDF5 identifier.
class Handle {
public:
    using Closer = herr_t (*)(hid_t);
    Handle() = default;
    Handle(hid_t id, Closer closer) : id_(id), closer_(closer) {}
    Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), closer_(other.closer_) {}
    Handle& operator=(Handle&& other) noexcept {
        std::swap(id_, other.id_);
        std::swap(closer_, other.closer_);
        return *this;
    }
    ~Handle() { close(); }

    hid_t id() const { return id_; }
    bool valid() const { return id_ >= 0; }
    bool close() {
        if (id_ < 0) return true;
        const QuietErrors quiet;
        return closer_(std::exchange(id_, -1)) >= 0;
    }

private:
    hid_t id_ = -1;
    Closer closer_ = nullptr;
};

/// HDF5's innermost word on what went wrong.
std::string reason() {
    std::string text;
    const auto take_first = [](unsigned, const H5E_error2_t* error, void* data) -> herr_t {
        auto& words = *static_cast<std::string*>(data);
        if (words.empty() && error->desc != nullptr) words = error->desc;
        return 0;
    };
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take_first, &text);
    return text.empty() ? "unknown reason" : text;
}

template <class T>
hid_t memory_type();
template <>
hid_t memory_type<double>() {
    return H5T_NATIVE_DOUBLE;
}
template <>
hid_t memory_type<std::uint32_t>() {
    return H5T_NATIVE_UINT32;
}
template <class T>
hid_t file_type();
template <>
hid_t file_type<double>() {
    return H5T_IEEE_F64LE;
}
template <>
hid_t file_type<std::uint32_t>() {
    return H5T_STD_U32LE;
}

constexpr int any_rank = -1;

/// One row of a growing array, and the memory that it is copied to or from.
struct Selection {
    std::vector<hsize_t> start, count;
    std::size_t elements = 1;
    Handle memory;

    Handle in(const Handle& set) const {
        Handle space(H5Dget_space(set.id()), H5Sclose);
        H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr);
        return space;
    }
};

}  // namespace

struct Storage::Open {
    std::string name;
    Handle file;
    mutable std::map<std::string, Handle> rows;  // growing arrays stay open: closing one would write its unfinished chunk

    Error failure(const std::string& what, const std::string& path) const {
        return bad_input(what + (path.empty() ? "" : " '" + path + "'") + ": " + reason(), "check the disk; a damaged file must be made again", {name});
    }
    Error unexpected(const std::string& path, const std::string& what) const {
        return bad_input("the entry '" + path + "' " + what, "the file is damaged or of another version: make it again", {name});
    }

    Handle create(const std::string& path, hid_t type, const Handle& space, const Handle& properties, hid_t access = H5P_DEFAULT) const {
        const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
        H5Pset_create_intermediate_group(links.id(), 1);
        Handle set(H5Dcreate2(file.id(), path.c_str(), type, space.id(), links.id(), properties.valid() ? properties.id() : H5P_DEFAULT, access), H5Dclose);
        if (!set.valid()) throw failure("cannot write", path);
        return set;
    }

    Handle open(const std::string& path) const {
        Handle set(H5Dopen2(file.id(), path.c_str(), H5P_DEFAULT), H5Dclose);
        if (!set.valid()) throw unexpected(path, "is missing");
        return set;
    }

    /// Sizes of an array that must hold numbers of this class and have this many dimensions (any_rank: at least one).
    std::vector<hsize_t> shape(const Handle& set, const std::string& path, int rank, H5T_class_t number_class) const {
        const Handle type(H5Dget_type(set.id()), H5Tclose);
        const Handle space(H5Dget_space(set.id()), H5Sclose);
        const int found_rank = H5Sget_simple_extent_ndims(space.id());
        if (H5Tget_class(type.id()) != number_class || found_rank < (rank == any_rank ? 1 : 0) || (rank != any_rank && found_rank != rank))
            throw unexpected(path, "has an unexpected type or shape");
        std::vector<hsize_t> sizes(static_cast<std::size_t>(found_rank));
        H5Sget_simple_extent_dims(space.id(), sizes.data(), nullptr);
        hsize_t elements = 1;
        for (const hsize_t size : sizes) {
            if (size > most_elements || elements > most_elements / std::max<hsize_t>(size, 1)) throw unexpected(path, "is impossibly large");
            elements *= size;
        }
        return sizes;
    }

    /// HDF5 trusts a damaged description of a dataset and reads past its buffers; so what we have written is checked before anything is read:
    /// our very number type, chunks of the array's own width, and our three filters.
    void check_layout(const Handle& set, const std::string& path, const std::vector<hsize_t>& sizes, hid_t number_type) const {
        const Handle type(H5Dget_type(set.id()), H5Tclose);
        const Handle properties(H5Dget_create_plist(set.id()), H5Pclose);
        std::vector<hsize_t> chunk(sizes.size());
        bool ours = H5Tequal(type.id(), number_type) > 0 && H5Pget_layout(properties.id()) == H5D_CHUNKED &&
                    H5Pget_chunk(properties.id(), static_cast<int>(chunk.size()), chunk.data()) == static_cast<int>(chunk.size()) &&
                    std::equal(chunk.begin() + 1, chunk.end(), sizes.begin() + 1) && H5Pget_nfilters(properties.id()) == 3;
        for (const H5Z_filter_t wanted : {H5Z_FILTER_SHUFFLE, H5Z_FILTER_DEFLATE, H5Z_FILTER_FLETCHER32}) {
            unsigned flags = 0;
            std::size_t count = 0;
            ours = ours && H5Pget_filter_by_id2(properties.id(), wanted, &flags, &count, nullptr, 0, nullptr, nullptr) >= 0;
        }
        if (!ours) throw unexpected(path, "is not stored the way pelletlab stores it");
    }

    /// The same for a single value or text.
    void check_single(const Handle& set, const std::string& path, hid_t type) const {
        const Handle stored(H5Dget_type(set.id()), H5Tclose);
        const Handle space(H5Dget_space(set.id()), H5Sclose);
        const Handle properties(H5Dget_create_plist(set.id()), H5Pclose);
        const bool ours = H5Tequal(stored.id(), type) > 0 && H5Sget_simple_extent_type(space.id()) == H5S_SCALAR &&
                          H5Pget_layout(properties.id()) == H5D_CONTIGUOUS && H5Pget_external_count(properties.id()) == 0 &&
                          H5Dget_storage_size(set.id()) == H5Tget_size(type);
        if (!ours) throw unexpected(path, "is not stored the way pelletlab stores it");
    }

    /// A damaged header may claim sizes that no memory holds: deflate shrinks by 1030 at most, so the stored bytes bound the true ones.
    void check_stored_size(const Handle& set, const std::string& path, const std::vector<hsize_t>& sizes, std::size_t element_bytes) const {
        hsize_t bytes = element_bytes;
        for (const hsize_t size : sizes) bytes *= size;
        if (bytes / 1100 > H5Dget_storage_size(set.id()) + chunk_bytes) throw unexpected(path, "claims more numbers than the file holds");
    }

    void set_unit(const Handle& set, const char* unit) const {
        const Handle type = string_type(std::string(unit).size());
        const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
        const Handle attribute(H5Acreate2(set.id(), "unit", type.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
        if (!attribute.valid() || H5Awrite(attribute.id(), type.id(), unit) < 0) throw failure("cannot write a unit", "");
    }

    static Handle string_type(std::size_t length) {
        Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
        H5Tset_size(type.id(), std::max<std::size_t>(length, 1));
        H5Tset_cset(type.id(), H5T_CSET_UTF8);
        H5Tset_strpad(type.id(), H5T_STR_NULLPAD);
        return type;
    }

    static Handle compressed(std::span<const hsize_t> chunk) {
        Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
        H5Pset_chunk(properties.id(), static_cast<int>(chunk.size()), chunk.data());
        H5Pset_shuffle(properties.id());
        H5Pset_deflate(properties.id(), deflate_level);
        H5Pset_fletcher32(properties.id());
        return properties;
    }

    template <class T>
    void write_array(const std::string& path, std::span<const T> values, std::size_t columns, const char* unit) const {
        if (values.empty()) return;
        const QuietErrors quiet;
        const std::array<hsize_t, 2> sizes{values.size() / columns, columns};
        const std::array<hsize_t, 2> chunk{std::min<hsize_t>(sizes[0], std::max<hsize_t>(1, chunk_bytes * 4 / (columns * sizeof(T)))), columns};
        const Handle space(H5Screate_simple(2, sizes.data(), nullptr), H5Sclose);
        const Handle set = create(path, file_type<T>(), space, compressed(chunk));
        if (H5Dwrite(set.id(), memory_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) throw failure("cannot write", path);
        if (unit != nullptr) set_unit(set, unit);
    }

    template <class T>
    std::vector<T> read_array(const std::string& path, std::size_t columns, H5T_class_t number_class, bool exists) const {
        if (!exists) return {};
        const QuietErrors quiet;
        const Handle set = open(path);
        const auto sizes = shape(set, path, 2, number_class);
        if (sizes[1] != columns) throw unexpected(path, "has " + std::to_string(sizes[1]) + " columns instead of " + std::to_string(columns));
        check_layout(set, path, sizes, file_type<T>());
        check_stored_size(set, path, sizes, sizeof(T));
        std::vector<T> values(static_cast<std::size_t>(sizes[0]) * columns);
        if (!values.empty() && H5Dread(set.id(), memory_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) throw failure("cannot read", path);
        return values;
    }

    Selection select_row(hsize_t index, const std::vector<hsize_t>& sizes) const {
        Selection one;
        one.start.assign(sizes.size(), 0);
        one.count = sizes;
        one.start[0] = index;
        one.count[0] = 1;
        for (const hsize_t size : one.count) one.elements *= static_cast<std::size_t>(size);
        one.memory = Handle(H5Screate_simple(static_cast<int>(one.count.size()), one.count.data(), nullptr), H5Sclose);
        return one;
    }

    const Handle& growing(const std::string& path) const {
        const auto found = rows.find(path);
        if (found != rows.end()) return found->second;
        return rows.emplace(path, open(path)).first->second;
    }
};

namespace {
/// When a file could not be flushed (full disk), HDF5 1.10 keeps it open and crashes while it cleans up at the end of the program. Every handle here closes
/// itself, so that clean-up is switched off, before the library's first call.
void leave_no_work_for_the_exit() {
    [[maybe_unused]] static const herr_t done = H5dont_atexit();
}
}  // namespace

Storage::Storage(std::unique_ptr<Open> open) : open_(std::move(open)) {}
Storage::Storage(Storage&&) noexcept = default;
Storage& Storage::operator=(Storage&&) noexcept = default;
Storage::~Storage() = default;

Storage Storage::create(const std::filesystem::path& file) {
    leave_no_work_for_the_exit();
    const QuietErrors quiet;
    auto open = std::make_unique<Open>();
    open->name = file.string();
    open->file = Handle(H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
    if (!open->file.valid()) throw bad_input("the file cannot be written: " + reason(), "check that its folder exists and can be written", {open->name});
    return Storage(std::move(open));
}

Storage Storage::open(const std::filesystem::path& file) {
    leave_no_work_for_the_exit();
    const QuietErrors quiet;
    auto open = std::make_unique<Open>();
    open->name = file.string();
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(file, ignored)) throw bad_input("there is no such file", "check the name", {open->name});
    if (H5Fis_hdf5(file.c_str()) <= 0) throw bad_input("this is no HDF5 file", "name a trajectory made by `pelletlab fill` or `pelletlab drum`", {open->name});
    open->file = Handle(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
    if (!open->file.valid()) throw open->failure("the file cannot be opened; it may have been cut short", "");
    return Storage(std::move(open));
}

bool Storage::has(const std::string& path) const {
    const QuietErrors quiet;
    // every part of the path must exist before the whole may be asked for
    for (std::size_t slash = path.find('/', 1);; slash = path.find('/', slash + 1)) {
        if (H5Lexists(open_->file.id(), path.substr(0, slash).c_str(), H5P_DEFAULT) <= 0) return false;
        if (slash == std::string::npos) return true;
    }
}

void Storage::write_text(const std::string& path, const std::string& text) {
    const QuietErrors quiet;
    const Handle type = Open::string_type(text.size());
    const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    const Handle set = open_->create(path, type.id(), space, Handle());
    if (H5Dwrite(set.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, text.c_str()) < 0) throw open_->failure("cannot write", path);
}

std::string Storage::text(const std::string& path) const {
    const QuietErrors quiet;
    const Handle set = open_->open(path);
    const Handle type(H5Dget_type(set.id()), H5Tclose);
    if (H5Tget_class(type.id()) != H5T_STRING || H5Tis_variable_str(type.id()) != 0) throw open_->unexpected(path, "is no text");
    const std::size_t length = H5Tget_size(type.id());
    if (length > (std::size_t{1} << 30)) throw open_->unexpected(path, "is impossibly large");
    const Handle memory = Open::string_type(length);
    open_->check_single(set, path, memory.id());
    std::string text(length, '\0');
    if (H5Dread(set.id(), memory.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()) < 0) throw open_->failure("cannot read", path);
    text.resize(text.find_last_not_of('\0') + 1);
    return text;
}

void Storage::write(const std::string& path, std::span<const double> values, std::size_t columns, const char* unit) {
    open_->write_array(path, values, columns, unit);
}

void Storage::write(const std::string& path, std::span<const std::uint32_t> values, std::size_t columns) {
    open_->write_array(path, values, columns, nullptr);
}

void Storage::write(const std::string& path, std::uint64_t value) {
    const QuietErrors quiet;
    const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    const Handle set = open_->create(path, H5T_STD_U64LE, space, Handle());
    if (H5Dwrite(set.id(), H5T_NATIVE_UINT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, &value) < 0) throw open_->failure("cannot write", path);
}

std::vector<double> Storage::numbers(const std::string& path, std::size_t columns) const {
    return open_->read_array<double>(path, columns, H5T_FLOAT, has(path));
}

std::vector<std::uint32_t> Storage::indices(const std::string& path, std::size_t columns) const {
    return open_->read_array<std::uint32_t>(path, columns, H5T_INTEGER, has(path));
}

std::uint64_t Storage::whole(const std::string& path) const {
    const QuietErrors quiet;
    const Handle set = open_->open(path);
    open_->check_single(set, path, H5T_STD_U64LE);
    std::uint64_t value = 0;
    if (H5Dread(set.id(), H5T_NATIVE_UINT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, &value) < 0) throw open_->failure("cannot read", path);
    return value;
}

void Storage::create_rows(const std::string& path, const std::vector<std::size_t>& row_shape, const char* unit) {
    const QuietErrors quiet;
    std::vector<hsize_t> sizes{0}, largest{H5S_UNLIMITED}, chunk{1};
    std::size_t row_bytes = sizeof(double);
    for (const std::size_t size : row_shape) {
        for (auto* list : {&sizes, &largest, &chunk}) list->push_back(size);
        row_bytes *= size;
    }
    chunk[0] = std::clamp<hsize_t>(chunk_bytes / row_bytes, 1, 1024);
    const Handle access(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose);
    // the cache must hold the chunk that is being filled, or it would be compressed anew for each row
    H5Pset_chunk_cache(access.id(), 521, std::max(std::size_t{1} << 20, 2 * static_cast<std::size_t>(chunk[0]) * row_bytes), 1.0);
    const Handle space(H5Screate_simple(static_cast<int>(sizes.size()), sizes.data(), largest.data()), H5Sclose);
    Handle set = open_->create(path, H5T_IEEE_F64LE, space, Open::compressed(chunk), access.id());
    open_->set_unit(set, unit);
    open_->rows.emplace(path, std::move(set));
}

void Storage::append_row(const std::string& path, std::span<const double> row) {
    const QuietErrors quiet;
    const Handle& set = open_->growing(path);
    std::vector<hsize_t> sizes = open_->shape(set, path, any_rank, H5T_FLOAT);
    const Selection one = open_->select_row(sizes[0], sizes);
    if (row.size() != one.elements) throw open_->unexpected(path, "is given a row of another length");
    ++sizes[0];
    if (H5Dset_extent(set.id(), sizes.data()) < 0) throw open_->failure("cannot write", path);
    const Handle target = one.in(set);
    if (H5Dwrite(set.id(), H5T_NATIVE_DOUBLE, one.memory.id(), target.id(), H5P_DEFAULT, row.data()) < 0) throw open_->failure("cannot write", path);
}

std::size_t Storage::row_count(const std::string& path, const std::vector<std::size_t>& row_shape) const {
    const QuietErrors quiet;
    const auto sizes = open_->shape(open_->growing(path), path, any_rank, H5T_FLOAT);
    open_->check_layout(open_->growing(path), path, sizes, file_type<double>());
    open_->check_stored_size(open_->growing(path), path, sizes, sizeof(double));
    if (!std::equal(sizes.begin() + 1, sizes.end(), row_shape.begin(), row_shape.end()))
        throw open_->unexpected(path, "does not fit the number of bodies or walls");
    return static_cast<std::size_t>(sizes[0]);
}

void Storage::read_row(const std::string& path, std::size_t index, std::span<double> row) const {
    const QuietErrors quiet;
    const Handle& set = open_->growing(path);
    const std::vector<hsize_t> sizes = open_->shape(set, path, any_rank, H5T_FLOAT);
    const Selection one = open_->select_row(index, sizes);
    if (index >= sizes[0] || row.size() != one.elements) throw open_->unexpected(path, "has no such row");
    const Handle source = one.in(set);
    if (H5Dread(set.id(), H5T_NATIVE_DOUBLE, one.memory.id(), source.id(), H5P_DEFAULT, row.data()) < 0) throw open_->failure("cannot read", path);
}

void Storage::close() {
    bool written = true;
    for (auto& [path, set] : open_->rows) written = set.close() && written;
    open_->rows.clear();
    written = open_->file.close() && written;
    if (!written) throw open_->failure("the file cannot be written to its end", "");
}

}  // namespace pelletlab::io::detail
