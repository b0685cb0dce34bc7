// HDF5's identifiers, errors and number types as C++ values; for *_hdf5.cpp files only.
#pragma once

#include <hdf5.h>

#include <cstdint>
#include <string>
#include <utility>

namespace pelletlab::io::detail {

inline constexpr unsigned deflate_level = 2;                      // level 1 to 3 differ little in size, and higher ones only cost time
inline constexpr std::size_t chunk_bytes = std::size_t{1} << 18;  // of growing arrays
inline constexpr hsize_t most_elements = hsize_t{1} << 33;        // a count beyond this is damage, not data

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
inline std::string reason() {
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
inline hid_t memory_type<double>() {
    return H5T_NATIVE_DOUBLE;
}
template <>
inline hid_t memory_type<std::uint32_t>() {
    return H5T_NATIVE_UINT32;
}
template <class T>
hid_t file_type();
template <>
inline hid_t file_type<double>() {
    return H5T_IEEE_F64LE;
}
template <>
inline hid_t file_type<std::uint32_t>() {
    return H5T_STD_U32LE;
}

}  // namespace pelletlab::io::detail
