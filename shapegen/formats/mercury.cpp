// MercuryDPM, output of Tools/MClump as Drivers/Clump/ClumpInput.h reads it: four files without comments or header.
//   Clump/Clump.txt   one pebble a line, x,y,z,r in the principal frame, origin in the centre of mass
//   Inertia/Mass.txt  one number     Inertia/TOI.txt  3 × 3 tensor of inertia     Inertia/PD.txt  principal directions, one a line
// ClumpInput.h converts with std::stof: single precision, and a number below 1e-38 ends the program, so nothing smaller than 1e-30 is written.
#include <cmath>

#include "core/error.hpp"
#include "shapegen/formats/detail/entries.hpp"
#include "shapegen/formats/detail/header.hpp"
#include "shapegen/formats/detail/print.hpp"
#include "shapegen/formats/detail/scan.hpp"

namespace pelletlab::shapegen::formats::detail {

namespace {

std::string coordinate(double value) {
    return std::abs(value) < 1e-30 ? "0" : exact(value);
}

/// A mass property, which must survive single precision.
std::string property(double value, const char* meaning) {
    if (!(value > 1.2e-38 && value < 3.4e38))
        throw bad_input(std::string("MercuryDPM reads single precision: the ") + meaning + " " + exact(value) + " is out of its range",
                        "use other units, for instance mm and g");
    return exact(value);
}

std::vector<FormatFile> write(const ClumpTemplate& clump, const WriteOptions& options) {
    require_complete(clump);
    const MassProperties& mass = clump.rigid.mass_properties;
    const Units units = units_for(options, "m", "kg");
    const std::string folder = safe_name(clump) + "/";
    std::string pebbles;
    for (const Sphere& s : clump.rigid.spheres)
        pebbles += coordinate(units.in_length(s.centre.x())) + ',' + coordinate(units.in_length(s.centre.y())) + ',' +
                   coordinate(units.in_length(s.centre.z())) + ',' + property(units.in_length(s.radius), "radius") + '\n';
    const Vec3 inertia = mass.principal_inertia / (units.kilogram * units.metre * units.metre);
    const std::string tensor =
        property(inertia[0], "inertia") + ",0,0\n0," + property(inertia[1], "inertia") + ",0\n0,0," + property(inertia[2], "inertia") + "\n";
    return {{folder + "Clump/Clump.txt", pebbles},
            {folder + "Inertia/Mass.txt", property(units.in_mass(mass.mass), "mass") + "\n"},
            {folder + "Inertia/TOI.txt", tensor},
            {folder + "Inertia/PD.txt", "1,0,0\n0,1,0\n0,0,1\n"}};
}

/// The numbers of a file of `rows` lines with `columns` numbers each.
std::vector<double> matrix(const FormatFile& file, std::size_t rows, std::size_t columns, std::string_view meaning) {
    std::vector<double> values;
    std::size_t row = 0;
    for (const Line& line : lines_of(file)) {
        const std::vector<Token> words = split(line, ", \t");
        if (words.empty()) continue;
        if (++row > rows || words.size() != columns)
            throw bad_input(std::string(meaning) + " needs " + std::to_string(rows) + " line(s) of " + std::to_string(columns) + " number(s)", {},
                            place_of(file, words[0]));
        for (const Token& word : words) values.push_back(number(file, word, meaning));
    }
    if (row != rows)
        throw bad_input(std::string(meaning) + " needs " + std::to_string(rows) + " line(s), this file has " + std::to_string(row), {}, {file.name});
    return values;
}

ImportedClump read(const std::vector<FormatFile>& files, const ReadOptions& options) {
    const FormatFile& file = main_file(files);
    const Header header = find_header(files);
    const double metre = metre_of(files, header, options);
    ImportedClump clump;
    for (const Line& line : lines_of(file)) {
        const std::vector<Token> words = split(line, ",", true);
        if (words.size() == 1 && trimmed(words[0]).text.empty()) continue;
        if (words.size() != 4)
            throw bad_input("a pebble needs four numbers x,y,z,r; this line has " + std::to_string(words.size()), {}, place_of(file, words.back()));
        clump.spheres.push_back(sphere(file, words[0], words[1], words[2], words[3], metre));
    }
    if (const FormatFile* mass = companion(files, "mass.txt")) clump.mass = matrix(*mass, 1, 1, "the mass")[0] * kilogram_of(files, header, options);
    if (const FormatFile* toi = companion(files, "toi.txt")) {
        const std::vector<double> v = matrix(*toi, 3, 3, "the tensor of inertia");
        const Mat3 tensor{{v[0], v[1], v[2]}, {v[3], v[4], v[5]}, {v[6], v[7], v[8]}};
        if ((tensor - tensor.transpose()).cwiseAbs().maxCoeff() > 1e-5 * tensor.cwiseAbs().maxCoeff())
            throw bad_input("the tensor of inertia is not symmetric", {}, {toi->name, 1, 1});
        clump.inertia = Mat3(0.5 * (tensor + tensor.transpose()) * (kilogram_of(files, header, options) * metre * metre));
        clump.centre_of_mass = Vec3::Zero();
    }
    finish(file, header, clump);
    return clump;
}

}  // namespace

Format mercury() {
    return {.id = "mercury",
            .program = "MercuryDPM MClump",
            .extension = "/Clump/Clump.txt",
            .description = "folder for Tools/MClump/Clumps: Clump/Clump.txt, Inertia/Mass.txt, Inertia/TOI.txt, Inertia/PD.txt",
            .documented_in = "MercuryDPM Drivers/Clump/ClumpInput.h and Tools/MClump/Src/OutputData.py (read in github.com/kuwt/MercuryDPM_fork)",
            .length_unit = "m",
            .mass_unit = "kg",
            .holds_mass_properties = true,
            .precision = 1e-15,
            .write = write,
            .read = read};
}

}  // namespace pelletlab::shapegen::formats::detail
