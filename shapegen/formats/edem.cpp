// Altair EDEM: the table of spheres of a multi-sphere particle, to be pasted into the Creator. Altair documents that the table can be pasted and that it
// «must match the format of the table in EDEM», and the fields (physical radius, contact radius, position X, Y, Z), but not the order of the columns nor
// a file: compare the header line with the table on the screen. Mass and inertia cannot be pasted; they are given as a note.
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
    const Units units = units_for({options.length_unit, "kg"}, "mm", "kg");
    const std::string name = safe_name(clump);
    const std::string unit = " [" + units.length + "]";
    std::string text =
        "Name\tPhysical Radius" + unit + "\tContact Radius" + unit + "\tPosition X" + unit + "\tPosition Y" + unit + "\tPosition Z" + unit + "\n";
    for (std::size_t i = 0; i < clump.rigid.spheres.size(); ++i) {
        const Sphere& s = clump.rigid.spheres[i];
        const std::string radius = exact(units.in_length(s.radius));
        text += "sphere " + std::to_string(i) + '\t' + radius + '\t' + radius + '\t' + exact(units.in_length(s.centre.x())) + '\t' +
                exact(units.in_length(s.centre.y())) + '\t' + exact(units.in_length(s.centre.z())) + '\n';
    }
    const Vec3 inertia = mass.principal_inertia;
    std::string note =
        header_line(clump, units) +
        "\nPaste the rows of the other file into the sphere table of a Multi-Sphere particle (help.altair.com/edem, Add Multi-Sphere Particles).\n"
        "The manual does not state the order of the columns: compare them with the table on the screen, and its length unit with the header.\n"
        "Then enter these on the particle's Properties instead of Calculate Properties (which integrates the union of spheres):\n";
    note += "mass " + exact(mass.mass) + " kg\nvolume " + exact(mass.volume) + " m^3\nmoment of inertia X " + exact(inertia[0]) +
            " kg*m^2\nmoment of inertia Y " + exact(inertia[1]) + " kg*m^2\nmoment of inertia Z " + exact(inertia[2]) + " kg*m^2\n";
    return {{name + ".edem.txt", text}, {name + ".edem.note.txt", note}};
}

ImportedClump read(const std::vector<FormatFile>& files, const ReadOptions& options) {
    const FormatFile& file = main_file(files);
    const std::vector<Line> rows = rows_of(file);
    if (rows.empty()) throw bad_input("the file is empty", "is it the right file?", {file.name});
    const char separator = separator_of(rows);
    const SphereColumns columns = sphere_columns(file, rows.front(), separator);
    Header header;
    header.length_unit = columns.length_unit;
    const double metre = metre_of(files, header, options);
    ImportedClump clump;
    if (columns.no_header) clump.notes.emplace_back("no header: columns taken as x, y, z, radius");
    for (std::size_t i = columns.no_header ? 0 : 1; i < rows.size(); ++i)
        clump.spheres.push_back(sphere_of_row(file, cells_of(rows[i], separator), columns, metre));
    finish(file, header, clump);
    return clump;
}

}  // namespace

Format edem() {
    return {.id = "edem",
            .program = "Altair EDEM sphere table",
            .extension = ".edem.txt",
            .description =
                "tab-separated sphere table to paste into a multi-sphere particle, and a note with mass and inertia to type in (column order not documented)",
            .documented_in = "help.altair.com/edem/topics/creator_tree_bulk_material/defining_multisphere_particles_t.htm",
            .length_unit = "mm",
            .mass_unit = "kg",
            .holds_mass_properties = false,
            .precision = 1e-15,
            .write = write,
            .read = read};
}

}  // namespace pelletlab::shapegen::formats::detail
