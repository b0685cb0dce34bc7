// VTK legacy PolyData (ASCII): the centres as points, the array «radius» as point data, mass properties as field data. In ParaView: filter Glyph, glyph type
// Sphere with radius 1, scale array «radius», scale factor 1, all points.
#include <cmath>
#include <map>

#include "core/error.hpp"
#include "shapegen/formats/detail/entries.hpp"
#include "shapegen/formats/detail/header.hpp"
#include "shapegen/formats/detail/print.hpp"
#include "shapegen/formats/detail/scan.hpp"

namespace pelletlab::shapegen::formats::detail {

namespace {

std::vector<FormatFile> write(const ClumpTemplate& clump, const WriteOptions& options) {
    require_complete(clump);
    const std::vector<Sphere>& spheres = clump.rigid.spheres;
    const MassProperties& mass = clump.rigid.mass_properties;
    const Units units = units_for({options.length_unit, "kg"}, "m", "kg");
    const std::string count = std::to_string(spheres.size());
    std::string text = "# vtk DataFile Version 3.0\n" + header_line(clump, units) + "\nASCII\nDATASET POLYDATA\n";
    text += "FIELD FieldData 4\nmass_kg 1 1 double\n" + exact(mass.mass) + "\nvolume_m3 1 1 double\n" + exact(mass.volume) +
            "\nprincipal_inertia_kg_m2 3 1 double\n" + exact(mass.principal_inertia[0]) + ' ' + exact(mass.principal_inertia[1]) + ' ' +
            exact(mass.principal_inertia[2]) + "\nmetres_per_unit 1 1 double\n" + exact(units.metre) + "\n";
    text += "POINTS " + count + " double\n";
    for (const Sphere& s : spheres)
        text += exact(units.in_length(s.centre.x())) + ' ' + exact(units.in_length(s.centre.y())) + ' ' + exact(units.in_length(s.centre.z())) + '\n';
    text += "VERTICES " + count + " " + std::to_string(2 * spheres.size()) + "\n";
    for (std::size_t i = 0; i < spheres.size(); ++i) text += "1 " + std::to_string(i) + "\n";
    text += "POINT_DATA " + count + "\nSCALARS radius double 1\nLOOKUP_TABLE default\n";
    for (const Sphere& s : spheres) text += exact(units.in_length(s.radius)) + "\n";
    return {{safe_name(clump) + ".vtk", text}};
}

/// Words of the file from the fourth line on, one after the other.
class Words {
public:
    Words(const FormatFile& file, const std::vector<Line>& lines) : file_(file), lines_(lines), line_(2) {}

    bool at_end() {
        while (next_ >= words_.size()) {
            if (line_ >= lines_.size()) return true;
            words_ = split(lines_[line_++], " \t\r\f\v");
            next_ = 0;
        }
        return false;
    }
    const Token& next(std::string_view what) {
        if (at_end())
            throw bad_input("the file ends where " + std::string(what) + " should follow", "is it complete?", {file_.name, static_cast<int>(lines_.size()), 1});
        return words_[next_++];
    }
    std::size_t count(std::string_view what) { return static_cast<std::size_t>(integer(file_, next(what), what, 0, static_cast<long>(most_spheres))); }
    std::vector<double> numbers(std::size_t n, std::string_view what) {
        std::vector<double> values;
        for (std::size_t i = 0; i < n; ++i) values.push_back(number(file_, next(what), what));
        return values;
    }
    void skip_line() { next_ = words_.size(); }

private:
    const FormatFile& file_;
    const std::vector<Line>& lines_;
    std::size_t line_, next_ = 0;
    std::vector<Token> words_;
};

/// Everything numeric the file holds under a name; arrays of data sets and of fields alike.
struct Contents {
    std::vector<double> points;
    std::map<std::string, std::vector<double>> arrays;
};

void read_field(const FormatFile& file, Words& words, Contents& contents) {
    words.next("the name of the field");
    const std::size_t arrays = words.count("the number of arrays");
    for (std::size_t a = 0; a < arrays; ++a) {
        const Token name = words.next("the name of an array");
        const std::size_t components = words.count("the number of components");
        const std::size_t tuples = words.count("the number of tuples");
        const Token type = words.next("the type of an array");
        if (lower_case(type.text) == "string") throw bad_input("cannot read an array of strings", "leave it out", place_of(file, type));
        if (components > 9) throw bad_input("an array of more than nine components", {}, place_of(file, name));
        contents.arrays[lower_case(name.text)] = words.numbers(components * tuples, "a value of " + quoted(name.text));
    }
}

/// Cells are of no use here; both layouts are stepped over: «n size, n lists with their length» and, since version 5, offsets and connectivity.
void read_cells(const FormatFile& file, Words& words) {
    const std::size_t count = words.count("the number of cells");
    const std::size_t size =
        static_cast<std::size_t>(integer(file, words.next("the size of the list"), "the size of the list", 0, 10 * static_cast<long>(most_spheres)));
    if (size == 0) return;
    const Token first = words.next("an index");
    if (lower_case(first.text) != "offsets") {
        number(file, first, "an index");
        words.numbers(size - 1, "an index");
        return;
    }
    words.next("the type of the offsets");
    words.numbers(count, "an offset");
    const Token connectivity = words.next("CONNECTIVITY");
    if (lower_case(connectivity.text) != "connectivity")
        throw bad_input("CONNECTIVITY expected, not " + quoted(connectivity.text), {}, place_of(file, connectivity));
    words.next("the type of the indices");
    words.numbers(size, "an index");
}

Contents read_contents(const FormatFile& file) {
    const std::vector<Line> lines = lines_of(file);
    if (lines.size() < 4 || lines[0].text.rfind("# vtk DataFile", 0) != 0)
        throw bad_input("this is not a legacy VTK file: the first line must be '# vtk DataFile Version …'", "save it as legacy VTK, ASCII", {file.name, 1, 1});
    Words words(file, lines);
    if (const Token kind = words.next("ASCII"); lower_case(kind.text) != "ascii")
        throw bad_input("only ASCII files can be read, not " + quoted(kind.text), "save it as legacy VTK, ASCII", place_of(file, kind));
    Contents contents;
    std::size_t data_size = 0;
    while (!words.at_end()) {
        const Token token = words.next("a keyword");
        const std::string key = lower_case(token.text);
        if (key == "dataset") {
            const Token kind = words.next("the kind of data set");
            const std::string name = lower_case(kind.text);
            if (name != "polydata" && name != "unstructured_grid")
                throw bad_input("cannot read a data set " + quoted(kind.text), "POLYDATA or UNSTRUCTURED_GRID hold points with radii", place_of(file, kind));
        } else if (key == "field") {
            read_field(file, words, contents);
        } else if (key == "points") {
            const std::size_t count = words.count("the number of points");
            words.next("the type of the points");
            contents.points = words.numbers(3 * count, "a coordinate");
        } else if (key == "vertices" || key == "lines" || key == "polygons" || key == "triangle_strips" || key == "cells") {
            read_cells(file, words);
        } else if (key == "cell_types") {
            words.numbers(words.count("the number of cells"), "a cell type");
        } else if (key == "point_data" || key == "cell_data") {
            data_size = words.count("the number of tuples");
        } else if (key == "scalars") {
            const Token name = words.next("the name of the scalars");
            words.next("the type of the scalars");
            std::size_t components = 1;
            Token table = words.next("LOOKUP_TABLE");
            if (lower_case(table.text) != "lookup_table") {
                components = static_cast<std::size_t>(integer(file, table, "the number of components", 1, 4));
                table = words.next("LOOKUP_TABLE");
            }
            if (lower_case(table.text) != "lookup_table") throw bad_input("LOOKUP_TABLE expected, not " + quoted(table.text), {}, place_of(file, table));
            words.next("the name of the lookup table");
            contents.arrays[lower_case(name.text)] = words.numbers(components * data_size, "a value of " + quoted(name.text));
        } else if (key == "vectors" || key == "normals") {
            const Token name = words.next("the name of the vectors");
            words.next("the type of the vectors");
            contents.arrays[lower_case(name.text)] = words.numbers(3 * data_size, "a value of " + quoted(name.text));
        } else if (key == "metadata") {
            // VTK's own writers add blocks «METADATA INFORMATION n … » that end at a blank line; their lines hold no keyword of ours.
            words.skip_line();
        } else if (key == "information" || key == "name" || key == "data" || key == "component_names") {
            words.skip_line();
        } else {
            throw bad_input("cannot read the keyword " + quoted(token.text), "a clump needs POINTS and the point data 'radius'", place_of(file, token));
        }
    }
    return contents;
}

ImportedClump read(const std::vector<FormatFile>& files, const ReadOptions& options) {
    const FormatFile& file = main_file(files);
    const Header header = find_header(files);
    const Contents contents = read_contents(file);
    if (contents.points.empty()) throw bad_input("the file has no POINTS", "is it a clump?", {file.name});
    const auto array = [&](const char* name) -> const std::vector<double>* {
        const auto found = contents.arrays.find(name);
        return found == contents.arrays.end() || found->second.empty() ? nullptr : &found->second;
    };
    const std::vector<double>* radii = nullptr;
    double to_radius = 1.0;
    for (const char* name : {"radius", "radii", "r"})
        if (radii == nullptr) radii = array(name);
    if (radii == nullptr && (radii = array("diameter")) != nullptr) to_radius = 0.5;
    if (radii == nullptr) throw bad_input("the points have no array 'radius'", "name the array of the radii 'radius'", {file.name});
    const std::size_t count = contents.points.size() / 3;
    if (radii->size() != count)
        throw bad_input("there are " + std::to_string(count) + " points but " + std::to_string(radii->size()) + " radii", {}, {file.name});

    const std::vector<double>* field_unit = array("metres_per_unit");
    const bool by_field = field_unit != nullptr && header.length_unit.empty() && options.length_unit.empty();
    const double metre = by_field ? field_unit->front() : metre_of(files, header, options);
    if (!(metre > 0.0)) throw bad_input("the field metres_per_unit must be positive", {}, {file.name});
    ImportedClump clump;
    for (std::size_t i = 0; i < count; ++i) {
        const Sphere s{Vec3(contents.points[3 * i], contents.points[3 * i + 1], contents.points[3 * i + 2]) * metre, (*radii)[i] * to_radius * metre};
        if (!s.centre.allFinite() || !std::isfinite(s.radius) || !(s.radius > 0.0))
            throw bad_input("point " + std::to_string(i) + " has no finite centre and positive radius", "check the unit", {file.name});
        clump.spheres.push_back(s);
    }
    if (const auto* mass = array("mass_kg")) clump.mass = mass->front();
    if (const auto* volume = array("volume_m3")) clump.volume = volume->front();
    if (const auto* inertia = array("principal_inertia_kg_m2"); inertia != nullptr && inertia->size() == 3) {
        clump.inertia = Mat3(Vec3((*inertia)[0], (*inertia)[1], (*inertia)[2]).asDiagonal());
        clump.centre_of_mass = Vec3::Zero();
    }
    finish(file, header, clump);
    return clump;
}

}  // namespace

Format vtk() {
    return {.id = "vtk",
            .program = "VTK legacy PolyData (ParaView)",
            .extension = ".vtk",
            .description = "centres as points, radius as point data, mass properties as field data; ASCII",
            .documented_in = "docs.vtk.org, VTK file formats, simple legacy formats",
            .length_unit = "m",
            .mass_unit = "kg",
            .holds_mass_properties = true,
            .precision = 1e-15,
            .write = write,
            .read = read};
}

}  // namespace pelletlab::shapegen::formats::detail
