#include <bit>
#include <optional>

#include "meshes/detail/polygons.hpp"
#include "meshes/detail/text_scan.hpp"

namespace pelletlab::meshes::detail {
namespace {

enum class Encoding { ascii, little_endian, big_endian };
enum class Number { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

struct Property {
    std::string name;
    Number type = Number::float32;
    std::optional<Number> length;  ///< of a list
};

struct Element {
    std::string name;
    std::uint64_t count = 0;
    std::vector<Property> properties;
};

struct Header {
    Encoding encoding = Encoding::ascii;
    std::vector<Element> elements;
    std::size_t end = 0;  ///< first byte of the body
    int lines = 0;
};

std::size_t size_of(Number type) {
    switch (type) {
        case Number::int8:
        case Number::uint8:
            return 1;
        case Number::int16:
        case Number::uint16:
            return 2;
        case Number::int32:
        case Number::uint32:
        case Number::float32:
            return 4;
        default:
            return 8;
    }
}

Number number_type(const TextScan& scan, std::string_view word) {
    struct Name {
        std::string_view text;
        Number type;
    };
    static constexpr std::array<Name, 16> names = {{{"char", Number::int8},
                                                    {"int8", Number::int8},
                                                    {"uchar", Number::uint8},
                                                    {"uint8", Number::uint8},
                                                    {"short", Number::int16},
                                                    {"int16", Number::int16},
                                                    {"ushort", Number::uint16},
                                                    {"uint16", Number::uint16},
                                                    {"int", Number::int32},
                                                    {"int32", Number::int32},
                                                    {"uint", Number::uint32},
                                                    {"uint32", Number::uint32},
                                                    {"float", Number::float32},
                                                    {"float32", Number::float32},
                                                    {"double", Number::float64},
                                                    {"float64", Number::float64}}};
    for (const Name& name : names)
        if (name.text == word) return name.type;
    throw scan.fault("«" + std::string(word.substr(0, 40)) + "» is no number type of a PLY", "export the mesh again");
}

Header parse_header(std::string_view bytes, const std::filesystem::path& file) {
    Header header;
    TextScan scan(bytes, file);
    if (!scan.next_line() || scan.word() != "ply") throw scan.fault("the file is not a PLY: its first line is not «ply»", "check that it is a mesh at all");
    while (scan.next_line()) {
        const std::string_view word = scan.word();
        if (word == "format") {
            const std::string_view name = scan.word();
            if (name == "ascii")
                header.encoding = Encoding::ascii;
            else if (name == "binary_little_endian")
                header.encoding = Encoding::little_endian;
            else if (name == "binary_big_endian")
                header.encoding = Encoding::big_endian;
            else
                throw scan.fault("«" + std::string(name.substr(0, 40)) + "» is no format of a PLY", "export the mesh again");
        } else if (word == "element") {
            Element element;
            element.name = scan.word();
            const std::string_view text = scan.word();
            const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), element.count);
            if (status != std::errc() || end != text.data() + text.size() || element.count > bytes.size())
                throw scan.fault("the PLY header announces «" + std::string(text.substr(0, 40)) + "» elements of the kind " + element.name.substr(0, 40) +
                                     ", which the file cannot hold",
                                 "export it again");
            header.elements.push_back(element);
        } else if (word == "property") {
            if (header.elements.empty()) throw scan.fault("a property stands before the first element", "export the mesh again");
            Property property;
            std::string_view type = scan.word();
            if (type == "list") {
                property.length = number_type(scan, scan.word());
                if (*property.length == Number::float32 || *property.length == Number::float64)
                    throw scan.fault("the length of a list is no whole number", "export the mesh again");
                type = scan.word();
            }
            property.type = number_type(scan, type);
            property.name = scan.word();
            header.elements.back().properties.push_back(property);
        } else if (word == "end_header") {
            header.end = scan.position();
            header.lines = scan.line();
            return header;
        } else if (!word.empty() && word != "comment" && word != "obj_info") {
            throw scan.fault("«" + std::string(word.substr(0, 40)) + "» has no meaning in a PLY header", "export the mesh again");
        }
    }
    throw scan.fault("the PLY header has no end_header", "export it again");
}

/// The numbers of the body, one after the other.
class Body {
public:
    Body(std::string_view bytes, const Header& header, const std::filesystem::path& file)
        : bytes_(bytes), encoding_(header.encoding), position_(header.end), file_(file), text_(bytes, file, header.end, header.lines) {}

    double next(Number type) {
        if (encoding_ == Encoding::ascii) return next_word();
        const std::size_t size = size_of(type);
        if (bytes_.size() - position_ < size) throw fault("the PLY is cut short", "export it again");
        std::uint64_t word = 0;
        for (std::size_t k = 0; k < size; ++k) {
            const std::size_t at = encoding_ == Encoding::little_endian ? position_ + size - 1 - k : position_ + k;
            word = word << 8 | static_cast<unsigned char>(bytes_[at]);
        }
        position_ += size;
        switch (type) {
            case Number::int8:
                return static_cast<std::int8_t>(word);
            case Number::int16:
                return static_cast<std::int16_t>(word);
            case Number::int32:
                return static_cast<std::int32_t>(word);
            case Number::float32:
                return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(word)));
            case Number::float64:
                return std::bit_cast<double>(word);
            default:
                return static_cast<double>(word);
        }
    }
    /// A whole number of at least 0.
    std::uint64_t next_count(Number type) {
        const double value = next(type);
        if (!(value >= 0.0) || value != std::floor(value) || value > 4294967294.0)
            throw fault("the PLY names a vertex or a length that is no whole number", "export the mesh again");
        return static_cast<std::uint64_t>(value);
    }
    std::size_t bytes_left() const { return encoding_ == Encoding::ascii ? bytes_.size() : bytes_.size() - position_; }
    Error fault(const std::string& problem, const std::string& remedy) const {
        return bad_input(problem, remedy, {file_.string(), encoding_ == Encoding::ascii ? text_.line() : 0});
    }

private:
    double next_word() {
        std::string_view word = text_.word();
        while (word.empty()) {
            if (!text_.next_line()) throw fault("the PLY is cut short", "export it again");
            word = text_.word();
        }
        const std::string shown(word.substr(0, 40));
        char* end = nullptr;
        const std::string text(word);
        const double value = std::strtod(text.c_str(), &end);
        if (end != text.c_str() + text.size()) throw fault("«" + shown + "» is not a number", "export the mesh again");
        return value;
    }

    std::string_view bytes_;
    Encoding encoding_;
    std::size_t position_;
    const std::filesystem::path& file_;
    TextScan text_;
};

void read_vertices(const Element& element, Body& body, Polygons& polygons) {
    std::array<int, 3> found{};
    for (const Property& property : element.properties)
        for (std::size_t k = 0; k < 3; ++k)
            if (property.name == std::string(1, static_cast<char>('x' + k)) && !property.length) ++found[k];
    if (found != std::array<int, 3>{1, 1, 1}) throw body.fault("the vertices of the PLY have no x, y and z", "export the mesh again");
    for (std::uint64_t v = 0; v < element.count; ++v) {
        std::array<double, 3> point{};
        for (const Property& property : element.properties) {
            const std::uint64_t length = property.length ? body.next_count(*property.length) : 1;
            for (std::uint64_t i = 0; i < length; ++i) {
                const double value = body.next(property.type);
                if (property.length || property.name.size() != 1 || property.name[0] < 'x' || property.name[0] > 'z') continue;
                if (!std::isfinite(static_cast<float>(value)))
                    throw body.fault("vertex " + std::to_string(v + 1) + " has a coordinate that is not a finite number", "export the mesh again");
                point[static_cast<std::size_t>(property.name[0] - 'x')] = value;
            }
        }
        polygons.points.push_back(point);
    }
}

void read_faces(const Element& element, Body& body, Polygons& polygons) {
    std::vector<std::uint32_t> polygon;
    for (std::uint64_t f = 0; f < element.count; ++f) {
        polygon.clear();
        for (const Property& property : element.properties) {
            const std::uint64_t length = property.length ? body.next_count(*property.length) : 1;
            if (length > body.bytes_left())
                throw body.fault("face " + std::to_string(f + 1) + " has more corners than the file has bytes", "export the mesh again");
            const bool is_polygon = property.length && (property.name == "vertex_indices" || property.name == "vertex_index");
            for (std::uint64_t i = 0; i < length; ++i)
                if (is_polygon)
                    polygon.push_back(static_cast<std::uint32_t>(body.next_count(property.type)));
                else
                    body.next(property.type);
        }
        if (polygon.size() < 3) throw body.fault("face " + std::to_string(f + 1) + " has fewer than three corners", "export the mesh again");
        polygons.add(polygon);
    }
}

}  // namespace

Polygons parse_ply(std::string_view bytes, const std::filesystem::path& file) {
    const Header header = parse_header(bytes, file);
    Body body(bytes, header, file);
    Polygons polygons;
    for (const Element& element : header.elements) {
        if (element.properties.empty() && element.count > 0)
            throw body.fault("the elements of the kind " + element.name.substr(0, 40) + " have no properties", "export the mesh again");
        if (element.name == "vertex") {
            read_vertices(element, body, polygons);
        } else if (element.name == "face") {
            read_faces(element, body, polygons);
        } else if (element.name == "tristrips") {
            throw body.fault("the PLY holds triangle strips, which are not read", "export plain faces");
        } else {
            for (std::uint64_t e = 0; e < element.count; ++e)
                for (const Property& property : element.properties) {
                    const std::uint64_t length = property.length ? body.next_count(*property.length) : 1;
                    for (std::uint64_t i = 0; i < length; ++i) body.next(property.type);
                }
        }
    }
    for (const std::uint32_t corner : polygons.corners)
        if (corner >= polygons.points.size())
            throw bad_input(
                "a face names vertex " + std::to_string(corner) + ", but the last one is " + std::to_string(static_cast<long long>(polygons.points.size()) - 1),
                "export the mesh again", {file.string()});
    return polygons;
}

}  // namespace pelletlab::meshes::detail
