#include "io/files.hpp"

#include <fcntl.h>
#include <openssl/evp.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <memory>
#include <sstream>
#include <system_error>

#include "core/error.hpp"

namespace pelletlab::io {

namespace {

namespace fs = std::filesystem;

std::string reason() {
    return errno != 0 ? std::strerror(errno) : "unknown reason";
}

/// Removes the temporary file unless it has become the real one.
class TemporaryFile {
public:
    explicit TemporaryFile(fs::path path) : path_(std::move(path)) {}
    ~TemporaryFile() {
        std::error_code ignored;
        if (!kept_) fs::remove(path_, ignored);
    }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    const fs::path& path() const { return path_; }
    void rename_to(const fs::path& file) {
        std::error_code failure;
        fs::rename(path_, file, failure);
        if (failure) throw bad_input("the file cannot be written: " + failure.message(), "choose another name or folder", {file.string()});
        kept_ = true;
    }

private:
    fs::path path_;
    bool kept_ = false;
};

class Sha256 {
public:
    Sha256() : context_(EVP_MD_CTX_new(), EVP_MD_CTX_free) {
        if (!context_ || EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) != 1) throw std::runtime_error("OpenSSL offers no SHA-256");
    }
    void add(std::string_view bytes) {
        if (EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size()) != 1) throw std::runtime_error("OpenSSL's SHA-256 failed");
    }
    std::string hexadecimal() {
        std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
        unsigned int length = 0;
        if (EVP_DigestFinal_ex(context_.get(), digest.data(), &length) != 1) throw std::runtime_error("OpenSSL's SHA-256 failed");
        std::string text;
        for (unsigned int i = 0; i < length; ++i) {
            text += "0123456789abcdef"[digest[i] >> 4];
            text += "0123456789abcdef"[digest[i] & 15];
        }
        return text;
    }

private:
    std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_;
};

std::ifstream open_for_reading(const fs::path& file) {
    std::error_code ignored;
    if (fs::is_directory(file, ignored)) throw bad_input("this is a folder, and a file is asked for", "name a file in it", {file.string()});
    errno = 0;
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw bad_input("the file cannot be read: " + reason(), "check the name and the permissions", {file.string()});
    return stream;
}

/// Calls take(bytes) for the file's content, piece by piece.
template <class Take>
void for_each_piece(const fs::path& file, const Take& take) {
    std::ifstream stream = open_for_reading(file);
    std::array<char, 1 << 16> buffer{};
    errno = 0;
    while (stream) {
        stream.read(buffer.data(), buffer.size());
        take(std::string_view(buffer.data(), static_cast<std::size_t>(stream.gcount())));
    }
    if (stream.bad()) throw bad_input("the file cannot be read to its end: " + reason(), "check the disk", {file.string()});
}

}  // namespace

void write_atomically(const fs::path& file, const std::function<void(const fs::path& temporary)>& write) {
    fs::path temporary_path = file;
    temporary_path += ".part";
    TemporaryFile temporary(std::move(temporary_path));
    write(temporary.path());
    temporary.rename_to(file);
}

void write_text(const fs::path& file, std::string_view text) {
    write_atomically(file, [&](const fs::path& temporary) {
        errno = 0;
        std::ofstream stream(temporary, std::ios::binary | std::ios::trunc);
        if (!stream) throw bad_input("the file cannot be written: " + reason(), "check that its folder exists and can be written", {file.string()});
        stream.write(text.data(), static_cast<std::streamsize>(text.size()));
        stream.close();
        if (!stream) throw bad_input("the file cannot be written to its end: " + reason(), "check the space on the disk", {file.string()});
    });
}

std::string read_text(const fs::path& file) {
    std::string text;
    for_each_piece(file, [&text](std::string_view piece) { text += piece; });
    return text;
}

void bring_to_disk(const fs::path& file) {
    errno = 0;
    const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
    const bool good = descriptor >= 0 && ::fsync(descriptor) == 0;
    const std::string why = reason();
    if (descriptor >= 0) ::close(descriptor);
    if (!good) throw bad_input("the file cannot be brought to the disk: " + why, "check the space on the disk", {file.string()});
}

void prepare_output_folder(const fs::path& folder) {
    const auto fail = [&folder](const std::string& why) {
        return bad_input("the output folder cannot be written: " + why, "choose another folder with --out, or correct its permissions", {folder.string()});
    };
    std::error_code failure;
    fs::create_directories(folder, failure);
    if (failure) throw fail(failure.message());
    if (!fs::is_directory(folder)) throw fail("it is not a folder");
    const TemporaryFile probe(folder / ".write-probe.part");
    errno = 0;
    std::ofstream stream(probe.path(), std::ios::binary | std::ios::trunc);
    stream << "probe";
    stream.close();
    if (!stream) throw fail(reason());
}

std::string sha256_of_text(std::string_view text) {
    Sha256 hash;
    hash.add(text);
    return hash.hexadecimal();
}

std::string sha256_of_file(const fs::path& file) {
    Sha256 hash;
    for_each_piece(file, [&hash](std::string_view piece) { hash.add(piece); });
    return hash.hexadecimal();
}

}  // namespace pelletlab::io
