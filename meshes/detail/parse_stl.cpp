#include <bit>

#include "meshes/detail/polygons.hpp"
#include "meshes/detail/text_scan.hpp"

namespace pelletlab::meshes::detail {
namespace {

std::uint32_t word_at(std::string_view bytes, std::size_t at) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 4; ++k) word |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + k])) << (8 * k);
    return word;
}

Polygons parse_binary(std::string_view bytes, std::uint32_t count, const std::filesystem::path& file) {
    Polygons polygons;
    polygons.points.reserve(3 * static_cast<std::size_t>(count));
    for (std::uint32_t t = 0; t < count; ++t) {
        for (std::size_t corner = 0; corner < 3; ++corner) {
            std::array<double, 3> point{};
            for (std::size_t k = 0; k < 3; ++k) {
                const auto value = std::bit_cast<float>(word_at(bytes, 84 + 50 * static_cast<std::size_t>(t) + 12 + 12 * corner + 4 * k));
                if (!std::isfinite(value))
                    throw bad_input(
                        "corner " + std::to_string(corner + 1) + " of triangle " + std::to_string(t + 1) + " has a coordinate that is not a finite number",
                        "export the mesh again", {file.string()});
                point[k] = static_cast<double>(value);
            }
            polygons.points.push_back(point);
        }
        polygons.add({3 * t, 3 * t + 1, 3 * t + 2});
    }
    return polygons;
}

Polygons parse_ascii(std::string_view text, const std::filesystem::path& file) {
    Polygons polygons;
    TextScan scan(text, file);
    bool in_solid = false, in_facet = false;
    std::size_t corners = 0;
    while (scan.next_line()) {
        const std::string_view word = scan.word();
        if (word.empty()) continue;
        if (equals_ignoring_case(word, "solid")) {
            if (in_solid) throw scan.fault("a solid begins inside another one: the STL is damaged or cut short", "export it again");
            in_solid = true;
        } else if (equals_ignoring_case(word, "facet")) {
            if (!in_solid || in_facet) throw scan.fault("a facet begins at the wrong place: the STL is damaged or cut short", "export it again");
            in_facet = true;
            corners = 0;
        } else if (equals_ignoring_case(word, "vertex")) {
            if (!in_facet) throw scan.fault("a vertex stands outside of a facet", "export it again");
            const double x = scan.coordinate(), y = scan.coordinate(), z = scan.coordinate();
            polygons.points.push_back({x, y, z});
            ++corners;
        } else if (equals_ignoring_case(word, "endfacet")) {
            if (!in_facet || corners != 3)
                throw scan.fault("a facet ends with " + std::to_string(corners) + " vertices instead of three: the STL is damaged or cut short",
                                 "export it again");
            in_facet = false;
            const auto end = static_cast<std::uint32_t>(polygons.points.size());
            polygons.add({end - 3, end - 2, end - 1});
        } else if (equals_ignoring_case(word, "endsolid")) {
            if (!in_solid || in_facet) throw scan.fault("a solid ends at the wrong place: the STL is damaged or cut short", "export it again");
            in_solid = false;
        } else if (!equals_ignoring_case(word, "outer") && !equals_ignoring_case(word, "endloop")) {
            throw scan.fault("«" + std::string(word.substr(0, 40)) + "» has no meaning in an ASCII STL", "export it again, or check that it is an STL at all");
        }
    }
    if (in_solid) throw scan.fault("the ASCII STL is cut short: its endsolid is missing", "export it again");
    return polygons;
}

}  // namespace

Polygons parse_stl(std::string_view bytes, const std::filesystem::path& file) {
    const std::uint32_t count = bytes.size() >= 84 ? word_at(bytes, 80) : 0;
    const std::uint64_t expected = 84 + 50 * static_cast<std::uint64_t>(count);
    if (bytes.size() >= 84 && bytes.size() == expected) return parse_binary(bytes, count, file);  // also where the header says «solid»
    const std::size_t start = bytes.find_first_not_of(" \t\r\n");
    const bool says_solid = start != std::string_view::npos && equals_ignoring_case(bytes.substr(start, 5), "solid");
    if (says_solid && bytes.find('\0') == std::string_view::npos) return parse_ascii(bytes, file);
    const bool could_be_binary = bytes.size() >= 84 && (says_solid || expected / 4 < bytes.size());
    if (could_be_binary)
        throw bad_input("the file is no whole binary STL: its header announces " + std::to_string(count) + " triangles, that is " + std::to_string(expected) +
                            " bytes, but it has " + std::to_string(bytes.size()),
                        "export it again, or check that it is an STL at all", {file.string()});
    throw bad_input("the file is not an STL: it neither starts with «solid» nor has the length of a binary STL", "check that it is a mesh at all",
                    {file.string()});
}

}  // namespace pelletlab::meshes::detail
