// Chrono DEM-Engine: csv with header x,y,z,r for DEMSolver::LoadClumpType (DEMClumpTemplate::ReadComponentFromFile), and script lines with what the user
// must type: mass, principal moments, volume. Its reader parses single precision digit by digit and loses digits in exponents, so numbers are written
// plainly, with ten decimals below the size of the clump.
#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "shapegen/formats/detail/entries.hpp"
#include "shapegen/formats/detail/header.hpp"
#include "shapegen/formats/detail/print.hpp"
#include "shapegen/formats/detail/table.hpp"

namespace pelletlab::shapegen::formats::detail {

namespace {

std::vector<FormatFile> write(const ClumpTemplate& clump, const WriteOptions& options) {
    require_complete(clump);
    const MassProperties& mass = clump.rigid.mass_properties;
    const Units units = units_for(options, "m", "kg");
    const std::string name = safe_name(clump);
    const double size = units.in_length(bounding_radius(clump.rigid.spheres));
    if (!(size > 1e-30 && size < 1e30))
        throw bad_input("DEM-Engine works in single precision: a clump of size " + exact(size) + " is out of its range", "use another unit of length");
    for (const Sphere& s : clump.rigid.spheres)
        if (units.in_length(s.radius) < 1e-7 * size)
            throw bad_input("DEM-Engine works in single precision: a sphere is smaller than 1e-7 of the clump", "drop it");
    const int decimals = std::clamp(10 - static_cast<int>(std::floor(std::log10(size))), 0, 60);
    std::string text = "x,y,z,r\n";
    for (const Sphere& s : clump.rigid.spheres)
        text += plain(units.in_length(s.centre.x()), decimals) + ',' + plain(units.in_length(s.centre.y()), decimals) + ',' +
                plain(units.in_length(s.centre.z()), decimals) + ',' + plain(units.in_length(s.radius), decimals) + '\n';
    text += "# " + header_line(clump, units) + "\n";
    const Vec3 inertia = mass.principal_inertia / (units.kilogram * units.metre * units.metre);
    const std::string moments = exact(inertia[0]) + ", " + exact(inertia[1]) + ", " + exact(inertia[2]);
    std::string script = "# " + header_line(clump, units) + "\n";
    script += "MASS = " + exact(units.in_mass(mass.mass)) + "\nMOI = [" + moments +
              "]  # principal, along x, y, z of the spheres\nVOLUME = " + exact(units.in_volume(mass.volume)) + "  # needed for void ratios only\n\n\n";
    script += "def load_pellet(solver, material, csv='" + name +
              ".chrono.csv'):\n    clump = solver.LoadClumpType(MASS, MOI, csv, material)\n    clump.SetVolume(VOLUME)\n    return clump\n\n\n";
    script += "# C++: auto pellet = DEMSim.LoadClumpType(" + exact(units.in_mass(mass.mass)) + ", make_float3(" + moments + "), \"" + name +
              ".chrono.csv\", material);\n";
    script += "#      pellet->SetVolume(" + exact(units.in_volume(mass.volume)) + ");\n";
    return {{name + ".chrono.csv", text}, {name + "_chrono.py", script}};
}

/// Numbers of «NAME = …» in the script of the export; empty when the line is missing.
std::vector<double> assigned(const FormatFile& script, std::string_view name, std::size_t count) {
    for (const Line& raw : lines_of(script)) {
        const std::vector<Token> words = split(without_comment(raw, "#"), " \t=(),[]");
        if (words.empty() || words[0].text != name || words[0].column != 1) continue;
        if (words.size() != count + 1) throw bad_input(std::string(name) + " needs " + std::to_string(count) + " number(s)", {}, place_of(script, words[0]));
        std::vector<double> values;
        for (std::size_t i = 1; i < words.size(); ++i) values.push_back(positive_number(script, words[i], name));
        return values;
    }
    return {};
}

ImportedClump read(const std::vector<FormatFile>& files, const ReadOptions& options) {
    const FormatFile& file = main_file(files);
    const Header header = find_header(files);
    const std::vector<Line> rows = rows_of(file);
    if (rows.empty()) throw bad_input("the file is empty", "is it the right file?", {file.name});
    const SphereColumns columns = sphere_columns(file, rows.front(), ',');
    if (columns.no_header)
        throw bad_input("the first line must be the header x,y,z,r: DEM-Engine finds the columns by it", {}, {file.name, rows.front().number, 1});
    const double metre = metre_of(files, header, options);
    ImportedClump clump;
    for (std::size_t i = 1; i < rows.size(); ++i) clump.spheres.push_back(sphere_of_row(file, cells_of(rows[i], ','), columns, metre));
    if (files.size() > 1) {
        const double kilogram = kilogram_of(files, header, options);
        if (const auto mass = assigned(files[1], "MASS", 1); !mass.empty()) clump.mass = mass[0] * kilogram;
        if (const auto volume = assigned(files[1], "VOLUME", 1); !volume.empty()) clump.volume = volume[0] * metre * metre * metre;
        if (const auto inertia = assigned(files[1], "MOI", 3); !inertia.empty()) {
            clump.inertia = Mat3(Vec3(inertia[0], inertia[1], inertia[2]).asDiagonal()) * (kilogram * metre * metre);
            clump.centre_of_mass = Vec3::Zero();
        }
    }
    finish(file, header, clump);
    return clump;
}

}  // namespace

Format chrono() {
    return {.id = "chrono",
            .program = "Project Chrono DEM-Engine clump",
            .extension = ".chrono.csv",
            .description = "csv x,y,z,r for LoadClumpType, and Python and C++ lines with mass, principal moments and volume",
            .documented_in = "github.com/projectchrono/DEM-Engine src/DEM/Structs.h (ReadComponentFromFile), src/core/utils/csv.hpp, data/clumps",
            .length_unit = "m",
            .mass_unit = "kg",
            .holds_mass_properties = true,
            .precision = 1e-10,
            .write = write,
            .read = read};
}

}  // namespace pelletlab::shapegen::formats::detail
