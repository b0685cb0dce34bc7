#include "io/detail/vtk_xml.hpp"

#include <zlib.h>

#include <bit>
#include <charconv>
#include <cstddef>
#include <stdexcept>
#include <string_view>
#include <type_traits>

#include "core/parallel.hpp"

namespace pelletlab::io::detail {

namespace {

constexpr std::size_t block_bytes = std::size_t{1} << 18;
constexpr int zlib_level = 1;  // higher levels save some percent and cost several times the time

void append_base64(std::string& text, std::string_view bytes) {
    static constexpr char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k) text += i + k > bytes.size() ? '=' : letters[group >> (18 - 6 * k) & 63];
    }
}

std::string compressed(std::string_view bytes) {
    uLongf size = compressBound(static_cast<uLong>(bytes.size()));
    std::string out(size, '\0');
    if (compress2(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uLong>(bytes.size()), zlib_level) !=
        Z_OK)
        throw std::runtime_error("zlib cannot compress");
    out.resize(size);
    return out;
}

/// VTK's layout of a compressed array: header [blocks, size of a block, size of the last if shorter, compressed sizes…] in base64, then all blocks in base64.
void append_array(std::string& appended, std::string_view bytes) {
    const std::size_t blocks = (bytes.size() + block_bytes - 1) / block_bytes;
    std::vector<std::string> packed(blocks);
    parallel_for(blocks, 1, [&](std::size_t i) { packed[i] = compressed(bytes.substr(i * block_bytes, block_bytes)); });
    std::vector<std::uint64_t> header{blocks, block_bytes, bytes.size() % block_bytes};
    std::string all;
    for (const std::string& block : packed) {
        header.push_back(block.size());
        all += block;
    }
    append_base64(appended, {reinterpret_cast<const char*>(header.data()), header.size() * sizeof(std::uint64_t)});
    append_base64(appended, all);
}

template <class T>
std::string_view bytes_of(const std::vector<T>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

std::string number_text(double value) {
    char buffer[40];
    return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

/// Collects <DataArray> elements and the data that they point to.
class Arrays {
public:
    template <class T>
    std::string element(const std::string& name, int components, const std::vector<T>& values) {
        const char* type = std::is_same_v<T, float> ? "Float32" : "Int32";
        const std::string text = "<DataArray type=\"" + std::string(type) + "\" Name=\"" + name + "\" NumberOfComponents=\"" + std::to_string(components) +
                                 "\" format=\"appended\" offset=\"" + std::to_string(appended_.size()) + "\"/>\n";
        append_array(appended_, bytes_of(values));
        return text;
    }
    std::string element(const VtkArray& array) {
        return std::visit([&](const auto& values) { return element(array.name, array.components, values); }, array.values);
    }
    std::string cells(const char* tag, const VtkCells& cells) {
        return "<" + std::string(tag) + ">\n" + element("connectivity", 1, cells.connectivity) + element("offsets", 1, cells.offsets) + "</" + tag + ">\n";
    }
    std::string group(const char* tag, const std::vector<VtkArray>& arrays) {
        std::string text = "<" + std::string(tag) + ">\n";
        for (const VtkArray& array : arrays) text += element(array);
        return text + "</" + tag + ">\n";
    }
    const std::string& appended() const { return appended_; }

private:
    std::string appended_;
};

/// Time and names; VTK writes texts as the codes of their bytes, each text ended by 0.
std::string field_data(const VtkPolyData& data) {
    std::string text =
        "<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">" + number_text(data.time) + "</DataArray>\n";
    if (!data.names.empty()) {
        text += "<DataArray type=\"String\" Name=\"names\" NumberOfTuples=\"" + std::to_string(data.names.size()) + "\" format=\"ascii\">";
        for (const std::string& name : data.names) {
            for (const char c : name) text += std::to_string(static_cast<int>(static_cast<unsigned char>(c))) + " ";
            text += "0 ";
        }
        text += "</DataArray>\n";
    }
    return text + "</FieldData>\n";
}

}  // namespace

std::string vtp_text(const VtkPolyData& data) {
    static_assert(std::endian::native == std::endian::little, "the files say LittleEndian");
    Arrays arrays;
    std::string text =
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\" "
        "compressor=\"vtkZLibDataCompressor\">\n<PolyData>\n";
    text += field_data(data);
    text += "<Piece NumberOfPoints=\"" + std::to_string(data.points.size() / 3) + "\" NumberOfVerts=\"" + std::to_string(data.vertices.offsets.size()) +
            "\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"" + std::to_string(data.polygons.offsets.size()) + "\">\n";
    text += arrays.group("PointData", data.point_data);
    text += arrays.group("CellData", data.cell_data);
    text += "<Points>\n" + arrays.element("Points", 3, data.points) + "</Points>\n";
    if (!data.vertices.offsets.empty()) text += arrays.cells("Verts", data.vertices);
    if (!data.polygons.offsets.empty()) text += arrays.cells("Polys", data.polygons);
    text += "</Piece>\n</PolyData>\n<AppendedData encoding=\"base64\">\n_" + arrays.appended() + "\n</AppendedData>\n</VTKFile>\n";
    return text;
}

std::string pvd_text(const std::vector<PvdEntry>& entries) {
    std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n<Collection>\n";
    for (const PvdEntry& entry : entries) text += "<DataSet timestep=\"" + number_text(entry.time) + "\" group=\"\" part=\"0\" file=\"" + entry.file + "\"/>\n";
    return text + "</Collection>\n</VTKFile>\n";
}

}  // namespace pelletlab::io::detail
