// LAMMPS molecule file (command «molecule», fix rigid/small with keyword mol): Coords, Types, Diameters, Masses and the body's own mass, com, inertia.
// The header values override what LAMMPS would sum over overlapping spheres. Three traps:
// - until May 2020 (issue #1657, fixed by #2105) fix rigid/nve treated moments below 1e-6 as zero: a 3 mm pellet in «units si» (5e-11 kg m²) never turned.
//   Use a newer LAMMPS, fix rigid/small, or an export in cm and g («units cgs», 5e-4).
// - fix rigid/small recomputes all bodies from their atoms at every «run» unless it has «reinit no» (seen with version 20220106 by the crosscode test).
// - the manual gives the order Ixx Iyy Izz Ixy Ixz Iyz, src/molecule.cpp has read the last three as yz, xz, xy: in principal axes they are zero.
#include "core/error.hpp"
#include "shapegen/formats/detail/entries.hpp"
#include "shapegen/formats/detail/header.hpp"
#include "shapegen/formats/detail/print.hpp"
#include "shapegen/formats/detail/scan.hpp"

namespace pelletlab::shapegen::formats::detail {

namespace {

constexpr std::string_view blanks = " \t\r\f\v";

std::string lammps_units(const Units& units) {
    if (units.length == "m" && units.mass == "kg") return "si";
    if (units.length == "cm" && units.mass == "g") return "cgs";
    throw bad_input("LAMMPS has no unit system with lengths in " + units.length + " and masses in " + units.mass,
                    "use m and kg (units si) or cm and g (units cgs)");
}

std::vector<FormatFile> write(const ClumpTemplate& clump, const WriteOptions& options) {
    require_complete(clump);
    const std::vector<Sphere>& spheres = clump.rigid.spheres;
    const MassProperties& mass = clump.rigid.mass_properties;
    const Units units = units_for(options, "m", "kg");
    const std::string system = lammps_units(units);
    const std::string name = safe_name(clump);
    const std::string file = name + ".lammps.mol";
    const Vec3 inertia = mass.principal_inertia / (units.kilogram * units.metre * units.metre);

    std::string text = "# " + header_line(clump, units) + ", units " + system + "\n\n" + std::to_string(spheres.size()) + " atoms\n";
    text += exact(units.in_mass(mass.mass)) + " mass\n0 0 0 com\n";
    text += exact(inertia[0]) + ' ' + exact(inertia[1]) + ' ' + exact(inertia[2]) + " 0 0 0 inertia\n";
    std::string coords, types, diameters, masses;
    const std::string share = exact(units.in_mass(mass.mass) / static_cast<double>(spheres.size()));
    for (std::size_t i = 0; i < spheres.size(); ++i) {
        const Sphere& s = spheres[i];
        const std::string id = std::to_string(i + 1) + ' ';
        coords += id + exact(units.in_length(s.centre.x())) + ' ' + exact(units.in_length(s.centre.y())) + ' ' + exact(units.in_length(s.centre.z())) + '\n';
        types += id + std::to_string(options.atom_type) + '\n';
        diameters += id + exact(2.0 * units.in_length(s.radius)) + '\n';
        masses += id + share + '\n';
    }
    text += "\nCoords\n\n" + coords + "\nTypes\n\n" + types + "\nDiameters\n\n" + diameters + "\nMasses\n\n" + masses;

    std::string script = "# " + header_line(clump, units) + "\n# In a script with 'units " + system +
                         "' and 'atom_style hybrid sphere molecular' (or sphere + fix property/atom mol).\n";
    if (inertia.minCoeff() < 1e-6)
        script +=
            "# WARNING: moments of inertia below 1e-6 in these units. fix rigid/nve and its relatives of LAMMPS before June 2020 take them for zero and never\n"
            "# turn the body (LAMMPS issue 1657, fixed by 2105): use a newer version, or export with length unit cm and mass unit g (units cgs).\n";
    script += "molecule " + name + ' ' + file + "\nfix rigid_" + name + " all rigid/small molecule mol " + name + " reinit no\n";
    script +=
        "# reinit no: without it every further 'run' recomputes mass, centre and inertia from the separate spheres, overlaps counted several times.\n"
        "# Insert with: fix ... deposit ... mol " +
        name + " rigid rigid_" + name +
        " ... (or fix pour). Only bodies inserted so take mass, com and inertia from the file; bodies that\n"
        "# exist before the fix get those of the separate spheres unless its keyword infile gives them.\n";
    return {{file, text}, {name + ".lammps.in", script}};
}

/// What the header and the sections of a molecule file hold, in the file's units.
struct Molecule {
    long atoms = 0;
    std::optional<double> mass;
    std::optional<Vec3> centre;
    std::optional<Mat3> inertia;
    std::vector<std::optional<Vec3>> coords;
    std::vector<std::optional<double>> diameters, masses;
    Token atoms_place;
};

/// Reads one line of the header; false when it is not one (the first section begins).
bool read_header_line(const FormatFile& file, const std::vector<Token>& words, Molecule& molecule) {
    const Token& last = words.back();
    const auto expect = [&](std::size_t count) {
        if (words.size() != count + 1)
            throw bad_input("the header line '" + std::string(last.text) + "' needs " + std::to_string(count) + " value(s) before it", {},
                            place_of(file, words.front()));
    };
    if (last.text == "atoms") {
        expect(1);
        molecule.atoms = integer(file, words[0], "the number of atoms", 1, static_cast<long>(most_spheres));
        molecule.atoms_place = words[0];
    } else if (last.text == "mass") {
        expect(1);
        molecule.mass = positive_number(file, words[0], "the mass");
    } else if (last.text == "com") {
        expect(3);
        molecule.centre =
            Vec3(number(file, words[0], "the centre of mass"), number(file, words[1], "the centre of mass"), number(file, words[2], "the centre of mass"));
    } else if (last.text == "inertia") {
        expect(6);
        double v[6];
        for (std::size_t k = 0; k < 6; ++k) v[k] = number(file, words[k], "the inertia");
        molecule.inertia = Mat3{{v[0], v[3], v[4]}, {v[3], v[1], v[5]}, {v[4], v[5], v[2]}};
    } else if (last.text == "bonds" || last.text == "angles" || last.text == "dihedrals" || last.text == "impropers" || last.text == "fragments") {
        expect(1);
        if (integer(file, words[0], "the number of " + std::string(last.text), 0, 1'000'000'000) != 0)
            throw bad_input("a molecule with " + std::string(last.text) + " is not a rigid clump", "export the spheres alone", place_of(file, words[0]));
    } else if (last.text == "body") {
        throw bad_input("this is a body particle, not a molecule of spheres", {}, place_of(file, last));
    } else {
        return false;
    }
    return true;
}

Molecule read_molecule(const FormatFile& file) {
    const std::vector<Line> lines = lines_of(file);
    Molecule molecule;
    std::string section;
    std::vector<bool> seen;
    long rows_left = 0;
    for (std::size_t k = 1; k < lines.size(); ++k) {  // LAMMPS skips the first line
        const std::vector<Token> words = split(without_comment(lines[k], "#"), blanks);
        if (words.empty()) continue;
        if (rows_left == 0) {
            if (section.empty() && read_header_line(file, words, molecule)) continue;
            section = std::string(words[0].text);
            if (molecule.atoms == 0) throw bad_input("no line 'N atoms' before the first section", "is this a LAMMPS molecule file?", place_of(file, words[0]));
            const bool known = words.size() == 1 && (section == "Coords" || section == "Types" || section == "Diameters" || section == "Masses" ||
                                                     section == "Molecules" || section == "Charges");
            if (!known)
                throw bad_input("cannot read a section " + quoted(lines[k].text), "a rigid clump has Coords, Types, Diameters and Masses",
                                place_of(file, words[0]));
            rows_left = molecule.atoms;
            seen.assign(std::min<std::size_t>(static_cast<std::size_t>(molecule.atoms), lines.size()), false);
            continue;
        }
        const std::size_t id = static_cast<std::size_t>(integer(file, words[0], "the number of the atom", 1, molecule.atoms)) - 1;
        const std::size_t values = section == "Coords" ? 3 : 1;
        if (words.size() != values + 1)
            throw bad_input("a row of " + section + " needs a number and " + std::to_string(values) + " value(s)", {}, place_of(file, words[0]));
        if (id >= seen.size())
            throw bad_input("the file has fewer rows than its " + std::to_string(molecule.atoms) + " atoms", {}, place_of(file, molecule.atoms_place));
        if (seen[id]) throw bad_input("atom " + std::to_string(id + 1) + " appears twice in " + section, {}, place_of(file, words[0]));
        seen[id] = true;
        --rows_left;
        const std::size_t count = seen.size();
        if (section == "Coords") {
            molecule.coords.resize(count);
            molecule.coords[id] =
                Vec3(number(file, words[1], "the x coordinate"), number(file, words[2], "the y coordinate"), number(file, words[3], "the z coordinate"));
        } else if (section == "Diameters") {
            molecule.diameters.resize(count);
            molecule.diameters[id] = positive_number(file, words[1], "the diameter");
        } else if (section == "Masses") {
            molecule.masses.resize(count);
            molecule.masses[id] = positive_number(file, words[1], "the mass of an atom");
        }
    }
    if (molecule.atoms == 0) throw bad_input("no line 'N atoms'", "is this a LAMMPS molecule file?", {file.name});
    if (rows_left > 0)
        throw bad_input("the section " + section + " ends " + std::to_string(rows_left) + " row(s) early", {}, {file.name, static_cast<int>(lines.size()), 1});
    if (molecule.coords.empty() || molecule.diameters.empty())
        throw bad_input(std::string("the file has no section ") + (molecule.coords.empty() ? "Coords" : "Diameters"), "a clump needs both", {file.name});
    return molecule;
}

/// Mass, centre and inertia as LAMMPS sums them over separate spheres where the header does not give them.
void sum_atoms(Molecule& molecule) {
    double mass = 0.0;
    Vec3 moment = Vec3::Zero();
    for (std::size_t i = 0; i < molecule.masses.size(); ++i) {
        mass += *molecule.masses[i];
        moment += *molecule.masses[i] * *molecule.coords[i];
    }
    if (!molecule.mass) molecule.mass = mass;
    if (!molecule.centre) molecule.centre = Vec3(moment / mass);
    if (molecule.inertia) return;
    Mat3 inertia = Mat3::Zero();
    for (std::size_t i = 0; i < molecule.masses.size(); ++i) {
        const Vec3 arm = *molecule.coords[i] - *molecule.centre;
        const double radius = 0.5 * *molecule.diameters[i];
        inertia += *molecule.masses[i] * ((arm.squaredNorm() + 0.4 * radius * radius) * Mat3::Identity() - arm * arm.transpose());
    }
    molecule.inertia = inertia;
}

ImportedClump read(const std::vector<FormatFile>& files, const ReadOptions& options) {
    const FormatFile& file = main_file(files);
    const Header header = find_header(files);
    const double metre = metre_of(files, header, options);
    Molecule molecule = read_molecule(file);
    ImportedClump clump;
    const bool complete = molecule.mass && molecule.centre && molecule.inertia;
    if (!complete && !molecule.masses.empty()) {
        sum_atoms(molecule);
        clump.notes.emplace_back("mass, com or inertia summed over the spheres, overlaps counted twice, as LAMMPS does without those header lines");
    }
    for (std::size_t i = 0; i < molecule.coords.size(); ++i) {
        Sphere s{*molecule.coords[i] * metre, 0.5 * *molecule.diameters[i] * metre};
        if (!s.centre.allFinite() || !(s.radius > 0.0) || s.radius > 1e300)
            throw bad_input("atom " + std::to_string(i + 1) + " is too large or too small to compute with", "check the unit", {file.name});
        clump.spheres.push_back(s);
    }
    if (molecule.centre) clump.centre_of_mass = Vec3(*molecule.centre * metre);
    if (molecule.mass || molecule.inertia) {
        const double kilogram = kilogram_of(files, header, options);
        if (molecule.mass) clump.mass = *molecule.mass * kilogram;
        if (molecule.inertia) clump.inertia = Mat3(*molecule.inertia * (kilogram * metre * metre));
    }
    if (clump.inertia && complete && (*clump.inertia - Mat3(clump.inertia->diagonal().asDiagonal())).cwiseAbs().maxCoeff() > 0.0)
        clump.notes.emplace_back("off-diagonal inertia read in the order of the manual: xy xz yz");
    finish(file, header, clump);
    return clump;
}

}  // namespace

Format lammps() {
    return {.id = "lammps",
            .program = "LAMMPS molecule template",
            .extension = ".lammps.mol",
            .description = "molecule file with Coords, Types, Diameters, Masses and the body's mass, com and inertia; script lines for fix rigid/small",
            .documented_in = "docs.lammps.org/molecule.html, github.com/lammps/lammps src/molecule.cpp; inertia trap: issues 1657, 2105",
            .length_unit = "m",
            .mass_unit = "kg",
            .holds_mass_properties = true,
            .precision = 1e-15,
            .write = write,
            .read = read};
}

}  // namespace pelletlab::shapegen::formats::detail
