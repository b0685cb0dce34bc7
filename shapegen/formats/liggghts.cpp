// LIGGGHTS-PUBLIC 3.8 multisphere template: a file of lines «x y z r» and the fix commands that load it.
// The sphere file is read by InputMultisphere::clmpfile ('#' starts a comment, '&' continues a line, at least four words a line); the command by
// FixTemplateMultisphere, which with «mass … inertia_tensor … use_density» takes the origin of the file as centre of mass and integrates nothing.
#include "core/error.hpp"
#include "shapegen/formats/detail/entries.hpp"
#include "shapegen/formats/detail/header.hpp"
#include "shapegen/formats/detail/print.hpp"
#include "shapegen/formats/detail/scan.hpp"

namespace pelletlab::shapegen::formats::detail {

namespace {

constexpr std::string_view blanks = " \t\r\f\v";

std::vector<FormatFile> write(const ClumpTemplate& clump, const WriteOptions& options) {
    require_complete(clump);
    const std::vector<Sphere>& spheres = clump.rigid.spheres;
    const MassProperties& mass = clump.rigid.mass_properties;
    if (spheres.size() < 2) throw bad_input("LIGGGHTS takes no multisphere template of one sphere", "use fix particletemplate/sphere there");
    const Units units = units_for({options.length_unit, "kg"}, "mm", "kg");
    const std::string name = safe_name(clump);
    const std::string file = name + ".liggghts.txt";

    std::string text = "# " + header_line(clump, units) + "\n# x y z r; origin in the centre of mass, principal axes along x, y, z\n";
    for (const Sphere& s : spheres)
        text += exact(units.in_length(s.centre.x())) + ' ' + exact(units.in_length(s.centre.y())) + ' ' + exact(units.in_length(s.centre.z())) + ' ' +
                exact(units.in_length(s.radius)) + '\n';

    const Vec3& inertia = mass.principal_inertia;
    std::string script = "# " + header_line(clump, units) +
                         "\n# For \"units si\": mass in kg, inertia in kg m^2 whatever the unit of the sphere file (its scale factor makes metres).\n"
                         "# use_density keeps mass and inertia as given; use_volume or no mass would replace them by a Monte Carlo estimate of the union.\n"
                         "# type: templates are numbered 1, 2, ... without gaps; atom_type: of the material. Seeds: any prime above 10000.\n";
    script += "fix pts_" + name + " all particletemplate/multisphere 15485863 atom_type " + std::to_string(options.atom_type) + " density constant " +
              exact(mass.density) + " nspheres " + std::to_string(spheres.size()) + " ntry 100000 spheres file " + file + " scale " + exact(units.metre) +
              " type " + std::to_string(options.template_type) + " mass " + exact(mass.mass) + " inertia_tensor " + exact(inertia[0]) + " 0 0 " +
              exact(inertia[1]) + " 0 " + exact(inertia[2]) + " use_density\n";
    script += "fix pdd_" + name + " all particledistribution/discrete 15485867 1 pts_" + name + " 1.0\n";
    script += "# then: fix ... insert/pack ... distributiontemplate pdd_" + name + " ..., and once: fix ... multisphere (instead of fix nve/sphere)\n";
    return {{file, text}, {name + ".liggghts.in", script}};
}

/// Words of the particletemplate/multisphere command in an input script, continuation lines joined; empty when there is none.
std::vector<Token> template_command(const FormatFile& script) {
    std::vector<Token> words;
    bool continued = false;
    for (const Line& raw : lines_of(script)) {
        std::vector<Token> tokens = split(without_comment(raw, "#"), blanks);
        const bool more = !tokens.empty() && tokens.back().text == "&";
        if (more) tokens.pop_back();
        if (!continued) words.clear();
        words.insert(words.end(), tokens.begin(), tokens.end());
        continued = more;
        if (!continued && words.size() > 3 && words[0].text == "fix" && words[3].text == "particletemplate/multisphere") return words;
    }
    if (words.size() > 3 && words[0].text == "fix" && words[3].text == "particletemplate/multisphere") return words;
    return {};
}

/// The `count` words after the keyword at `at`, or an error that says which keyword lacks them.
const Token* values_of(const FormatFile& script, const std::vector<Token>& words, std::size_t at, std::size_t count) {
    if (at + count >= words.size())
        throw bad_input("the keyword " + quoted(words[at].text) + " needs " + std::to_string(count) + " value(s)", {}, place_of(script, words[at]));
    return &words[at + 1];
}

/// Mass properties of the command, in SI. Returns the scale factor of the sphere file, 0 when the command names none.
double read_command(const FormatFile& script, ImportedClump& clump) {
    const std::vector<Token> words = template_command(script);
    if (words.empty())
        throw bad_input("no 'fix … particletemplate/multisphere' command in this script", "give the script that loads the sphere file", {script.name});
    double scale = 0.0;
    std::optional<double> mass;
    bool mass_and_density = false;
    for (std::size_t i = 4; i < words.size(); ++i) {
        const std::string_view key = words[i].text;
        if (key == "density") {
            const Token* value = values_of(script, words, i, 2);
            if (value[0].text != "constant") throw bad_input("only 'density constant' can be read", {}, place_of(script, value[0]));
            clump.density = positive_number(script, value[1], "the density");
        } else if (key == "scale") {
            scale = positive_number(script, *values_of(script, words, i, 1), "the scale factor");
        } else if (key == "mass") {
            mass = positive_number(script, *values_of(script, words, i, 1), "the mass");
        } else if (key == "inertia_tensor") {  // Ixx Ixy Ixz Iyy Iyz Izz
            const Token* value = values_of(script, words, i, 6);
            double v[6];
            for (int k = 0; k < 6; ++k) v[k] = number(script, value[k], "the inertia");
            clump.inertia = Mat3{{v[0], v[1], v[2]}, {v[1], v[3], v[4]}, {v[2], v[4], v[5]}};
        } else if (key == "use_density") {
            mass_and_density = true;
        }
    }
    if (mass) {
        clump.mass = mass;
        if (!mass_and_density) clump.density.reset();  // use_volume: LIGGGHTS finds the density itself
        clump.centre_of_mass = Vec3::Zero();
        clump.notes.emplace_back("mass and inertia read as kg and kg m^2 (units si)");
    } else {
        clump.inertia.reset();
        clump.notes.emplace_back("the command gives no mass: LIGGGHTS would take that of the union of spheres");
    }
    return scale;
}

ImportedClump read(const std::vector<FormatFile>& files, const ReadOptions& options) {
    const FormatFile& file = main_file(files);
    const Header header = find_header(files);
    ImportedClump clump;
    double scale = 0.0;
    if (const FormatFile* script = files.size() > 1 ? &files[1] : nullptr) scale = read_command(*script, clump);
    const bool unit_known = !header.length_unit.empty() || !options.length_unit.empty();
    const double metre = (!unit_known && scale > 0.0) ? scale : metre_of(files, header, options);
    std::vector<Token> words;
    for (const Line& raw : lines_of(file)) {
        const std::vector<Token> tokens = split(without_comment(raw, "#"), blanks);
        const bool more = !tokens.empty() && tokens.back().text == "&";
        words.insert(words.end(), tokens.begin(), more ? tokens.end() - 1 : tokens.end());
        if (more || words.empty()) continue;
        if (words.size() < 4)
            throw bad_input("a sphere needs four numbers, x y z r; this line has " + std::to_string(words.size()), {}, place_of(file, words.back()));
        clump.spheres.push_back(sphere(file, words[0], words[1], words[2], words[3], metre));
        words.clear();
    }
    if (!words.empty()) throw bad_input("the file ends in a continued line", {}, place_of(file, words.back()));
    finish(file, header, clump);
    return clump;
}

}  // namespace

Format liggghts() {
    return {
        .id = "liggghts",
        .program = "LIGGGHTS-PUBLIC multisphere template",
        .extension = ".liggghts.txt",
        .description = "sphere file «x y z r» and the fix commands with mass, inertia tensor and use_density",
        .documented_in =
            "github.com/CFDEMproject/LIGGGHTS-PUBLIC doc/fix_particletemplate_multisphere.html, src/input_multisphere.cpp, src/fix_template_multisphere.cpp",
        .length_unit = "mm",
        .mass_unit = "kg",
        .holds_mass_properties = true,
        .precision = 1e-15,
        .write = write,
        .read = read};
}

}  // namespace pelletlab::shapegen::formats::detail
