#include "meshes/detail/mesh_text.hpp"

#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>
#include <system_error>

#include "core/error.hpp"

namespace pelletlab::meshes::detail {
namespace {

constexpr std::string_view blanks = " \t\r\v\f";

/// Next line of `text` from `position` on, without its end; false at the end of the text.
bool next_line(std::string_view text, std::size_t& position, std::string_view& line) {
    if (position >= text.size()) return false;
    const std::size_t end = std::min(text.find('\n', position), text.size());
    line = text.substr(position, end - position);
    position = end + 1;
    return true;
}

/// Cuts the first word off a line.
std::string_view next_word(std::string_view& line) {
    const std::size_t begin = line.find_first_not_of(blanks);
    if (begin == std::string_view::npos) return line = {};
    const std::size_t end = std::min(line.find_first_of(blanks, begin), line.size());
    const std::string_view word = line.substr(begin, end - begin);
    line.remove_prefix(end);
    return word;
}

/// How often a whole word stands in a text whose words are separated by white space.
std::uint64_t count_word(std::string_view text, std::string_view word) {
    const auto is_edge = [&](std::size_t at) { return at >= text.size() || text[at] == '\n' || blanks.find(text[at]) != std::string_view::npos; };
    std::uint64_t count = 0;
    for (std::size_t at = text.find(word); at != std::string_view::npos; at = text.find(word, at + word.size()))
        if ((at == 0 || is_edge(at - 1)) && is_edge(at + word.size())) ++count;
    return count;
}

FileOutline outline_stl(std::string_view bytes, const std::filesystem::path& file) {
    std::uint64_t count = 0;
    if (bytes.size() >= 84)
        for (std::size_t k = 0; k < 4; ++k) count |= static_cast<std::uint64_t>(static_cast<unsigned char>(bytes[80 + k])) << (8 * k);
    if (bytes.size() >= 84 && bytes.size() == 84 + 50 * count) return {MeshFormat::stl_binary, count};

    std::string_view start = bytes.substr(0, 512);
    const bool says_solid = next_word(start) == "solid";
    if (says_solid && bytes.find('\0') == std::string_view::npos) {
        const std::uint64_t facets = count_word(bytes, "endfacet");
        const std::uint64_t begun = count_word(bytes, "facet");
        if (begun != facets || count_word(bytes, "vertex") != 3 * facets || count_word(bytes, "endsolid") == 0)
            throw bad_input("the ASCII STL is damaged or cut short: " + std::to_string(begun) + " facets begin, " + std::to_string(facets) +
                                " end, and they hold " + std::to_string(count_word(bytes, "vertex")) + " vertices",
                            "export it again", {file.string()});
        return {MeshFormat::stl_ascii, facets};
    }
    if (bytes.size() >= 84 && (says_solid || count < 100000000))
        throw bad_input("the file is no whole binary STL: its header announces " + std::to_string(count) + " triangles, that is " +
                            std::to_string(84 + 50 * count) + " bytes, but it has " + std::to_string(bytes.size()),
                        "export it again, or check that it is an STL at all", {file.string()});
    throw bad_input("the file is not an STL: it neither starts with «solid» nor has the length of a binary STL", "check that it is a mesh at all",
                    {file.string()});
}

FileOutline outline_obj(std::string_view bytes) {
    FileOutline result{MeshFormat::obj, 0};
    std::size_t position = 0;
    std::string_view line;
    while (next_line(bytes, position, line))
        if (next_word(line) == "f") ++result.faces;
    return result;
}

FileOutline outline_ply(std::string_view bytes, const std::filesystem::path& file) {
    FileOutline result{MeshFormat::ply, 0};
    std::size_t position = 0;
    std::string_view line;
    int number = 0;
    bool ended = false;
    while (!ended && next_line(bytes, position, line)) {
        ++number;
        const std::string_view word = next_word(line);
        if (number == 1 && word != "ply")
            throw bad_input("the file is not a PLY: its first line is not «ply»", "check that it is a mesh at all", {file.string(), 1});
        if (word == "element") {
            const std::string name(next_word(line)), text(next_word(line));
            char* end = nullptr;
            errno = 0;
            const unsigned long long count = std::strtoull(text.c_str(), &end, 10);
            if (text.empty() || *end != '\0' || text.front() == '-' || errno != 0 || count > bytes.size())
                throw bad_input("the PLY header announces «" + text + "» elements of the kind " + name + ", which the file cannot hold", "export it again",
                                {file.string(), number});
            if (name == "face") result.faces = count;
        }
        ended = word == "end_header";
    }
    if (!ended) throw bad_input("the PLY header has no end_header", "export it again", {file.string(), number});
    return result;
}

}  // namespace

FileOutline outline(std::string_view bytes, const std::string& extension, const std::filesystem::path& file) {
    if (extension == "stl") return outline_stl(bytes, file);
    if (extension == "obj") return outline_obj(bytes);
    return outline_ply(bytes, file);
}

int line_of_bad_number(std::string_view text) {
    std::size_t position = 0;
    std::string_view line;
    for (int number = 1; next_line(text, position, line); ++number) {
        std::string_view rest = line;
        const std::string_view first = next_word(rest);
        const bool is_bare_numbers =
            !first.empty() && (std::isdigit(static_cast<unsigned char>(first[0])) || first[0] == '-' || first[0] == 'n' || first[0] == 'i');
        if (first != "vertex" && first != "v" && !is_bare_numbers) continue;
        if (is_bare_numbers) rest = line;
        for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) {
            const std::string text_of_number(word);
            char* end = nullptr;
            const double value = std::strtod(text_of_number.c_str(), &end);
            if (end != text_of_number.c_str() && !std::isfinite(static_cast<float>(value))) return number;
        }
    }
    return 0;
}

std::string read_bytes(const std::filesystem::path& file) {
    std::error_code failure;
    const auto status = std::filesystem::status(file, failure);
    if (!std::filesystem::exists(status)) throw bad_input("the mesh file does not exist", "check its name and folder", {file.string()});
    if (std::filesystem::is_directory(status)) throw bad_input("the mesh file is a folder", "name the file in it", {file.string()});
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream content;
    if (stream) content << stream.rdbuf();
    std::string bytes = content.str();
    if (!stream || stream.bad()) {
        const bool empty = std::filesystem::file_size(file, failure) == 0 && !failure;
        throw bad_input(empty ? "the mesh file is empty" : "the mesh file cannot be read", empty ? "export it again" : "check its permissions",
                        {file.string()});
    }
    if (bytes.empty()) throw bad_input("the mesh file is empty", "export it again", {file.string()});
    return bytes;
}

}  // namespace pelletlab::meshes::detail
