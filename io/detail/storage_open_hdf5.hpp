// What is behind a Storage: the open file and its checks; for *_hdf5.cpp files only.
#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "io/detail/handles_hdf5.hpp"
#include "io/detail/storage.hpp"

namespace pelletlab::io::detail {

inline constexpr int any_rank = -1;

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
        const Handle plain(properties.valid() ? -1 : H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
        const hid_t chosen = properties.valid() ? properties.id() : plain.id();
        H5Pset_obj_track_times(chosen, false);  // no clock time: equal work gives equal files
        Handle set(H5Dcreate2(file.id(), path.c_str(), type, space.id(), links.id(), chosen, access), H5Dclose);
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

}  // namespace pelletlab::io::detail
