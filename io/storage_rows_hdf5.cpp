// Arrays that grow by one row at a time.
#include "io/detail/storage_open_hdf5.hpp"

namespace pelletlab::io::detail {

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

}  // namespace pelletlab::io::detail
