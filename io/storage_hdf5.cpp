#include <utility>

#include "io/detail/seal.hpp"
#include "io/detail/storage_open_hdf5.hpp"

namespace pelletlab::io::detail {

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
    check_seal(file);  // HDF5 itself may run in circles in a damaged file
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

void Storage::close() {
    bool written = true;
    for (auto& [path, set] : open_->rows) written = set.close() && written;
    open_->rows.clear();
    written = open_->file.close() && written;
    if (!written) throw open_->failure("the file cannot be written to its end", "");
    seal_file(open_->name);
}

}  // namespace pelletlab::io::detail
