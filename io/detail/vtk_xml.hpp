// VTK's XML files for surfaces and points (.vtp): zlib-compressed arrays in base64 at the end of the file, so that the whole is well-formed XML.
// Format: «VTK XML Formats» in the VTK book; read back by VTK itself and by ParaView.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace pelletlab::io::detail {

/// A named array over points or cells; several numbers each when components > 1.
struct VtkArray {
    std::string name;
    int components = 1;
    std::variant<std::vector<float>, std::vector<std::int32_t>> values;
};

/// Cells of one kind: cell k has the points connectivity[offsets[k−1]] … connectivity[offsets[k]−1].
struct VtkCells {
    std::vector<std::int32_t> connectivity, offsets;
};

struct VtkPolyData {
    double time = 0.0;          ///< [s]
    std::vector<float> points;  ///< x, y, z one after the other [m]
    VtkCells vertices;          ///< point cells
    VtkCells polygons;
    std::vector<VtkArray> point_data;
    std::vector<VtkArray> cell_data;  ///< first all point cells, then all polygons
    std::vector<std::string> names;   ///< text array «names» of the file, for instance those of the walls
};

std::string vtp_text(const VtkPolyData& data);

struct PvdEntry {
    double time = 0.0;  ///< [s]
    std::string file;   ///< relative to the .pvd
};

/// The file that ties .vtp files to times.
std::string pvd_text(const std::vector<PvdEntry>& entries);

}  // namespace pelletlab::io::detail
