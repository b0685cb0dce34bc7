// Plain CSV: a table of spheres with the unit in the header, and a small table of the mass properties beside it.
#include <map>

#include "core/error.hpp"
#include "core/units.hpp"
#include "shapegen/formats/detail/entries.hpp"
#include "shapegen/formats/detail/header.hpp"
#include "shapegen/formats/detail/print.hpp"
#include "shapegen/formats/detail/table.hpp"

namespace pelletlab::shapegen::formats::detail {

namespace {

std::vector<FormatFile> write(const ClumpTemplate& clump, const WriteOptions& options) {
    require_complete(clump);
    const MassProperties& mass = clump.rigid.mass_properties;
    const Units units = units_for(options, "mm", "kg");
    const std::string name = safe_name(clump);
    const std::string unit = " [" + units.length + "]";
    std::string text = "x" + unit + ",y" + unit + ",z" + unit + ",radius" + unit + "\n";
    for (const Sphere& s : clump.rigid.spheres)
        text += exact(units.in_length(s.centre.x())) + ',' + exact(units.in_length(s.centre.y())) + ',' + exact(units.in_length(s.centre.z())) + ',' +
                exact(units.in_length(s.radius)) + '\n';
    const std::string inertia_unit = "," + units.mass + "*" + units.length + "^2\n";
    std::string table = "quantity,value,unit\nname," + name + ",\n";
    table += "mass," + exact(units.in_mass(mass.mass)) + ',' + units.mass + "\nvolume," + exact(units.in_volume(mass.volume)) + ',' + units.length + "^3\n";
    table += "density," + exact(mass.density) + ",kg/m^3\n";
    for (int k = 0; k < 3; ++k) table += std::string("inertia_") + "xyz"[k] + ',' + exact(units.in_inertia(mass.principal_inertia[k])) + inertia_unit;
    return {{name + ".csv", text}, {name + ".mass.csv", table}};
}

void read_mass_table(const FormatFile& file, ImportedClump& clump) {
    const std::vector<Line> rows = rows_of(file);
    const std::map<std::string, Dimension> known{{"mass", dimension::mass},
                                                 {"volume", Dimension{3, 0, 0, 0}},
                                                 {"density", dimension::density},
                                                 {"inertia_x", Dimension{2, 1, 0, 0}},
                                                 {"inertia_y", Dimension{2, 1, 0, 0}},
                                                 {"inertia_z", Dimension{2, 1, 0, 0}}};
    std::map<std::string, double> values;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const std::vector<Token> cells = cells_of(rows[i], ',');
        const std::string quantity = lower_case(cells[0].text);
        if (i == 0 && quantity == "quantity") continue;
        if (cells.size() < 3) throw bad_input("a row needs quantity, value, unit", {}, place_of(file, cells[0]));
        if (quantity == "name") {
            clump.name = std::string(cells[1].text.substr(0, 60));
            continue;
        }
        const auto dimension = known.find(quantity);
        if (dimension == known.end())
            throw bad_input("unknown quantity " + quoted(cells[0].text), "known: name, mass, volume, density, inertia_x, inertia_y, inertia_z",
                            place_of(file, cells[0]));
        double factor = 0.0;
        try {
            factor = unit_factor(cells[2].text, dimension->second);
        } catch (const Error& error) {
            throw bad_input(error.problem(), error.remedy(), place_of(file, cells[2]));
        }
        values[quantity] = positive_number(file, cells[1], quantity) * factor;
    }
    if (values.count("mass") != 0) clump.mass = values["mass"];
    if (values.count("volume") != 0) clump.volume = values["volume"];
    if (values.count("density") != 0) clump.density = values["density"];
    if (values.count("inertia_x") + values.count("inertia_y") + values.count("inertia_z") == 3) {
        clump.inertia = Mat3(Vec3(values["inertia_x"], values["inertia_y"], values["inertia_z"]).asDiagonal());
        clump.centre_of_mass = Vec3::Zero();
    }
}

ImportedClump read(const std::vector<FormatFile>& files, const ReadOptions& options) {
    const FormatFile& file = main_file(files);
    const std::vector<Line> rows = rows_of(file);
    if (rows.empty()) throw bad_input("the file is empty", "is it the right file?", {file.name});
    const char separator = separator_of(rows);
    const SphereColumns columns = sphere_columns(file, rows.front(), separator);
    Header header = find_header(files);
    if (!columns.length_unit.empty()) header.length_unit = columns.length_unit;
    const double metre = metre_of(files, header, options);
    ImportedClump clump;
    if (columns.no_header) clump.notes.emplace_back("no header: columns taken as x, y, z, radius");
    for (std::size_t i = columns.no_header ? 0 : 1; i < rows.size(); ++i)
        clump.spheres.push_back(sphere_of_row(file, cells_of(rows[i], separator), columns, metre));
    if (files.size() > 1) read_mass_table(files[1], clump);
    finish(file, header, clump);
    return clump;
}

}  // namespace

Format csv() {
    return {.id = "csv",
            .program = "CSV table",
            .extension = ".csv",
            .description = "spheres x, y, z, radius with the unit in the header; mass properties in a second table",
            .documented_in = "docs/clump-formats.md (our own; RFC 4180 commas)",
            .length_unit = "mm",
            .mass_unit = "kg",
            .holds_mass_properties = true,
            .precision = 1e-15,
            .write = write,
            .read = read};
}

}  // namespace pelletlab::shapegen::formats::detail
