// Itasca PFC 6, 7, 9: a data file with one «clump template create» command. Templates have unit density: volume [length³] and inertia [length⁵] are those of
// a body of density 1; the particle density follows with «clump attribute density». Pebbles: number, then radius and position each. Inertia: 11 22 33 12 13 23.
#include "core/error.hpp"
#include "shapegen/formats/detail/entries.hpp"
#include "shapegen/formats/detail/header.hpp"
#include "shapegen/formats/detail/print.hpp"
#include "shapegen/formats/detail/scan.hpp"

namespace pelletlab::shapegen::formats::detail {

namespace {

std::string vector_of(const Units& units, const Vec3& v) {
    return "(" + exact(units.in_length(v.x())) + "," + exact(units.in_length(v.y())) + "," + exact(units.in_length(v.z())) + ")";
}

std::vector<FormatFile> write(const ClumpTemplate& clump, const WriteOptions& options) {
    require_complete(clump);
    const std::vector<Sphere>& spheres = clump.rigid.spheres;
    const MassProperties& mass = clump.rigid.mass_properties;
    const Units units = units_for(options, "m", "kg");
    const std::string name = safe_name(clump);
    const double metre5 = units.metre * units.metre * units.metre * units.metre * units.metre;
    const Vec3 inertia = mass.principal_inertia / mass.density / metre5;
    std::string text = "; " + header_line(clump, units) + "\n; Clump templates have unit density: volume and inertia below are per unit density.\n";
    text += "clump template create ...\n    name '" + name + "' ...\n    volume " + exact(units.in_volume(mass.volume)) + " ...\n    inertia " +
            exact(inertia[0]) + " " + exact(inertia[1]) + " " + exact(inertia[2]) + " 0 0 0 ...\n    pebbles " + std::to_string(spheres.size());
    for (const Sphere& s : spheres) text += " ...\n        " + exact(units.in_length(s.radius)) + " " + vector_of(units, s.centre);
    text += "\n; then, for instance: clump replicate name '" + name + "' id 1 position (0,0,0)\n";
    text += ";                     clump attribute density " + exact(mass.density / units.kilogram * units.metre * units.metre * units.metre) + "\n";
    return {{name + ".p3dat", text}};
}

/// Words of all commands: comments cut, «...» and «&» at the end of a line join it with the next, parentheses and commas count as blanks. Each inner vector
/// is one command.
std::vector<std::vector<Token>> commands_of(const FormatFile& file) {
    std::vector<std::vector<Token>> commands(1);
    for (const Line& raw : lines_of(file)) {
        std::vector<Token> words = split(without_comment(raw, ";"), " \t\r\f\v(),");
        const bool more = !words.empty() && (words.back().text == "..." || words.back().text == "&");
        if (more) words.pop_back();
        commands.back().insert(commands.back().end(), words.begin(), words.end());
        if (!more && !commands.back().empty()) commands.emplace_back();
    }
    if (commands.back().empty()) commands.pop_back();
    return commands;
}

bool starts_with(const std::vector<Token>& command, std::initializer_list<std::string_view> words) {
    std::size_t i = 0;
    for (const std::string_view word : words)
        if (i >= command.size() || lower_case(command[i++].text) != word) return false;
    return true;
}

struct Reader {
    const FormatFile& file;
    const std::vector<Token>& words;
    std::size_t at;

    const Token& next(std::string_view keyword) {
        if (at >= words.size())
            throw bad_input("the command ends after the keyword '" + std::string(keyword) + "'", "give its values", place_of(file, words.back()));
        return words[at++];
    }
    Vec3 position(std::string_view keyword) {
        Vec3 p;
        for (int k = 0; k < 3; ++k) p[k] = number(file, next(keyword), "the position");
        return p;
    }
};

void read_command(const FormatFile& file, const std::vector<Token>& words, std::size_t begin, bool is_template, double metre, ImportedClump& clump) {
    Reader reader{file, words, begin};
    std::optional<Vec3> position;
    bool calculated = false;
    while (reader.at < words.size()) {
        const Token& token = words[reader.at++];
        const std::string key = lower_case(token.text);
        if (key == "name") {
            std::string_view name = reader.next(key).text;
            if (name.size() >= 2 && (name.front() == '\'' || name.front() == '"') && name.back() == name.front()) name = name.substr(1, name.size() - 2);
            clump.name = std::string(name.substr(0, 60));
        } else if (key == "volume") {
            clump.volume = positive_number(file, reader.next(key), "the volume") * metre * metre * metre;
        } else if (key == "inertia") {
            double v[6];
            for (double& value : v) value = number(file, reader.next(key), "the inertia");
            const double metre5 = metre * metre * metre * metre * metre;
            clump.unit_density_inertia = Mat3(Mat3{{v[0], v[3], v[4]}, {v[3], v[1], v[5]}, {v[4], v[5], v[2]}} * metre5);
        } else if (key == "position") {
            position = reader.position(key) * metre;
        } else if (key == "pebbles" || key == "pebble") {
            const long count = integer(file, reader.next(key), "the number of pebbles", 1, static_cast<long>(most_spheres));
            for (long i = 0; i < count; ++i) {
                const Token& radius = reader.next(key);
                const Token& x = reader.next(key);
                const Token& y = reader.next(key);
                clump.spheres.push_back(sphere(file, x, y, reader.next(key), radius, metre));
            }
        } else if (key == "density" && !is_template) {
            clump.notes.emplace_back("density " + quoted(reader.next(key).text) + " of 'clump create' not used: its unit is not known");
        } else if (key == "id") {
            reader.next(key);
        } else if (key.rfind("calculate", 0) == 0 || key == "pebcalculate" || key == "surfcalculate") {
            calculated = true;
            if (reader.at < words.size() && parse_number(words[reader.at].text)) ++reader.at;
        } else {
            throw bad_input("cannot read the keyword " + quoted(token.text), "known: name, pebbles, volume, inertia, position, calculate",
                            place_of(file, token));
        }
    }
    if (calculated) {
        clump.notes.emplace_back("PFC calculates volume and inertia of this template itself: the file holds none");
        return;
    }
    if (clump.volume || clump.unit_density_inertia) clump.centre_of_mass = position.value_or(Vec3::Zero());
}

ImportedClump read(const std::vector<FormatFile>& files, const ReadOptions& options) {
    const FormatFile& file = main_file(files);
    const Header header = find_header(files);
    const double metre = metre_of(files, header, options);
    ImportedClump clump;
    bool found = false;
    for (const std::vector<Token>& words : commands_of(file)) {
        const bool is_template = starts_with(words, {"clump", "template", "create"});
        if (!is_template && !starts_with(words, {"clump", "create"})) continue;
        if (found) throw bad_input("a second clump in this file", "keep one", place_of(file, words.front()));
        found = true;
        read_command(file, words, is_template ? 3 : 2, is_template, metre, clump);
    }
    if (!found) throw bad_input("no command 'clump template create' in this file", "is it a PFC data file?", {file.name});
    finish(file, header, clump);
    return clump;
}

}  // namespace

Format pfc() {
    return {
        .id = "pfc",
        .program = "Itasca PFC clump template",
        .extension = ".p3dat",
        .description = "data file with one «clump template create»: name, volume, inertia (unit density), pebbles",
        .documented_in = "docs.itascacg.com/itasca900/pfc/pfcmodule/doc/manual/clump_manual/clump_commands/cmd_clump_template.html and cmd_clump_create.html",
        .length_unit = "m",
        .mass_unit = "kg",
        .holds_mass_properties = true,
        .precision = 1e-15,
        .write = write,
        .read = read};
}

}  // namespace pelletlab::shapegen::formats::detail
