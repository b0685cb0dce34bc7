// Yade: a text file «x_y_z_r» (yade.ymport.textExt) and a Python function that builds the clump with our mass properties.
// Yade takes the mass, centre and principal axes of a clump from its members (Clump::updateProperties) and has no way to set the centre afterwards. So the
// clump is built of massless spheres and one carrier, a body without a bound that has the mass, centre and inertia; then the carrier is erased
// and the clump moved to its place.
#include "core/error.hpp"
#include "shapegen/formats/detail/entries.hpp"
#include "shapegen/formats/detail/header.hpp"
#include "shapegen/formats/detail/print.hpp"
#include "shapegen/formats/detail/scan.hpp"

namespace pelletlab::shapegen::formats::detail {

namespace {

constexpr std::string_view blanks = " \t\r\f\v";

constexpr const char* function = R"(

def append_pellet(material, position=(0, 0, 0), orientation=Quaternion.Identity):
    """Adds one pellet: centre of mass at position, body axes turned by orientation. Returns (clump id, ids of its spheres).

    Set its motion through O.bodies[clump id].state: vel, angVel, and for a spin angMom too (in the world).
    """
    position = Vector3(*position)
    massless = FrictMat(density=0.0)
    members = [sphere((x, y, z), r, material=massless) for x, y, z, r in SPHERES]
    carrier = Body()
    carrier.shape = Box(extents=Vector3(1, 1, 1) * min(s[3] for s in SPHERES))
    carrier.bounded = False  # no contacts
    carrier.material = material
    carrier.state.mass, carrier.state.inertia = MASS, Vector3(*INERTIA)
    clump, ids = O.bodies.appendClumped(members + [carrier], discretization=0)
    if len(members) > 1:  # Yade drops a clump that is left with one member
        O.bodies.erase(ids.pop())
    body = O.bodies[clump]
    given, kept = sorted(INERTIA), sorted(body.state.inertia)
    axes = body.state.ori.toRotationMatrix()
    if abs(body.state.mass - MASS) > 1e-9 * MASS or body.state.pos.norm() > 1e-9 * BOUNDING_RADIUS or any(
            abs(a - b) > 1e-9 * given[2] for a, b in zip(given, kept)) or any(
            abs(sum(axes[j, k]**2 * INERTIA[j] for j in range(3)) - body.state.inertia[k]) > 1e-9 * given[2] for k in range(3)):
        raise RuntimeError('this version of Yade changed the mass properties of the clump')
    body.aspherical = len(set(INERTIA)) > 1
    # Built about the origin with the carrier unturned, then moved: Yade turns the inertia of a turned member the wrong way round (2023.02).
    body.state.pos, body.state.ori = position, orientation * body.state.ori
    for i, (centre, turn) in body.shape.members.items():
        state = O.bodies[i].state
        state.pos, state.ori = position + body.state.ori * centre, body.state.ori * turn
        state.mass = MASS  # contact damping laws use the mass of the member
        O.bodies[i].material = material
    return clump, ids[:len(members)]
)";

std::vector<FormatFile> write(const ClumpTemplate& clump, const WriteOptions& options) {
    require_complete(clump);
    const MassProperties& mass = clump.rigid.mass_properties;
    const Units units = units_for(options, "m", "kg");
    const std::string name = safe_name(clump);
    std::string text = "#format x_y_z_r\n# " + header_line(clump, units) + "\n";
    std::string list;
    for (const Sphere& s : clump.rigid.spheres) {
        const std::string x = exact(units.in_length(s.centre.x())), y = exact(units.in_length(s.centre.y())), z = exact(units.in_length(s.centre.z()));
        const std::string r = exact(units.in_length(s.radius));
        text += x + ' ' + y + ' ' + z + ' ' + r + '\n';
        list += "    (" + x + ", " + y + ", " + z + ", " + r + "),\n";
    }
    const Vec3 inertia = mass.principal_inertia / (units.kilogram * units.metre * units.metre);
    std::string script =
        "# " + header_line(clump, units) + "\n# Run by yade: exec(open('" + name + "_yade.py').read()), then append_pellet(material, position).\n";
    script += "from yade import *\n\n";
    script += "MASS = " + exact(units.in_mass(mass.mass)) + "\nVOLUME = " + exact(units.in_volume(mass.volume)) + "\nINERTIA = (" + exact(inertia[0]) + ", " +
              exact(inertia[1]) + ", " + exact(inertia[2]) + ")  # principal, along x, y, z of the spheres below\n";
    script += "BOUNDING_RADIUS = " + exact(units.in_length(bounding_radius(clump.rigid.spheres))) +
              "\nSPHERES = [  # x, y, z, r; origin in the centre of mass\n" + list + "]\n";
    script += function;
    return {{name + ".yade.txt", text}, {name + "_yade.py", script}};
}

/// Numbers after «NAME =» at the start of a line of a Python script; empty when there is no such line.
std::vector<double> assigned(const FormatFile& script, std::string_view name, std::size_t count) {
    for (const Line& raw : lines_of(script)) {
        const Line line = without_comment(raw, "#");
        if (line.text.substr(0, name.size()) != name) continue;
        const std::vector<Token> words = split(line, " \t=(),[]");
        if (words.empty() || words[0].text != name) continue;
        if (words.size() != count + 1) throw bad_input(std::string(name) + " needs " + std::to_string(count) + " number(s)", {}, place_of(script, words[0]));
        std::vector<double> values;
        for (std::size_t i = 1; i < words.size(); ++i) values.push_back(number(script, words[i], name));
        return values;
    }
    return {};
}

ImportedClump read(const std::vector<FormatFile>& files, const ReadOptions& options) {
    const FormatFile& file = main_file(files);
    const Header header = find_header(files);
    const double metre = metre_of(files, header, options);
    ImportedClump clump;
    std::string columns = "x_y_z_r";
    std::string first_clump;
    for (const Line& raw : lines_of(file)) {
        const std::vector<Token> words = split(raw, blanks);
        if (words.empty()) continue;
        if (words[0].text == "#format") {
            columns = words.size() > 1 ? std::string(words[1].text) : "";
            if (columns != "x_y_z_r" && columns != "x_y_z_r_matId" && columns != "x_y_z_r_clumpId" && columns != "x_y_z_r_attrs" &&
                columns != "id_x_y_z_r_matId")
                throw bad_input("cannot read the Yade format " + quoted(columns), "use x_y_z_r or x_y_z_r_clumpId", place_of(file, words.back()));
            continue;
        }
        if (words[0].text.front() == '#') continue;
        const std::size_t skip = columns == "id_x_y_z_r_matId" ? 1 : 0;
        const std::size_t wanted = columns == "x_y_z_r" ? 4 : columns == "id_x_y_z_r_matId" ? 6 : 5;
        if (words.size() < wanted)
            throw bad_input("a line of format " + columns + " needs " + std::to_string(wanted) + " values; this one has " + std::to_string(words.size()), {},
                            place_of(file, words.back()));
        clump.spheres.push_back(sphere(file, words[skip], words[skip + 1], words[skip + 2], words[skip + 3], metre));
        if (columns != "x_y_z_r_clumpId") continue;
        if (first_clump.empty()) first_clump = std::string(words[4].text);
        if (words[4].text != first_clump) throw bad_input("the file holds more than one clump", "keep the lines of one clump", place_of(file, words[4]));
    }
    if (files.size() > 1) {
        const FormatFile& script = files[1];
        const double kilogram = kilogram_of(files, header, options);
        if (const auto mass = assigned(script, "MASS", 1); !mass.empty()) clump.mass = mass[0] * kilogram;
        if (const auto volume = assigned(script, "VOLUME", 1); !volume.empty()) clump.volume = volume[0] * metre * metre * metre;
        if (const auto inertia = assigned(script, "INERTIA", 3); !inertia.empty()) {
            clump.inertia = Mat3(Vec3(inertia[0], inertia[1], inertia[2]).asDiagonal()) * (kilogram * metre * metre);
            clump.centre_of_mass = Vec3::Zero();
        }
    }
    finish(file, header, clump);
    return clump;
}

}  // namespace

Format yade() {
    return {.id = "yade",
            .program = "Yade clump",
            .extension = ".yade.txt",
            .description = "text «x_y_z_r» for ymport.textExt, and a Python function that appends a clump with our mass, centre and inertia",
            .documented_in = "yade-dem.org/doc/yade.ymport.html (textExt, textClumps), gitlab.com/yade-dev/trunk core/Clump.cpp",
            .length_unit = "m",
            .mass_unit = "kg",
            .holds_mass_properties = true,
            .precision = 1e-15,
            .write = write,
            .read = read};
}

}  // namespace pelletlab::shapegen::formats::detail
