#include "meshes/named_body.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "core/error.hpp"
#include "core/units.hpp"
#include "meshes/makers.hpp"
#include "meshes/mass_properties.hpp"
#include "meshes/pellet_makers.hpp"

namespace pelletlab::meshes {

namespace {

constexpr std::uint32_t usual_facets = 128, most_facets = 2000;

using Lengths = std::map<std::string, double>;  // key → [m]

struct Entry {
    NamedBody body;
    std::vector<std::string> more_keys;  // known, and absent by default
    TriangleMesh (*make)(const Lengths& sizes, std::uint32_t facets);
};

bool has(const Lengths& sizes, const char* key) {
    return sizes.count(key) != 0;
}

TriangleMesh cylinder(const Lengths& sizes, std::uint32_t facets) {
    const double diameter = sizes.at("diameter"), height = sizes.at("height");
    if (has(sizes, "rim_radius") + has(sizes, "bevel") + has(sizes, "dome_height") > 1)
        throw bad_input("a cylinder has one kind of rim", "give one of rim_radius, bevel and dome_height");
    if (has(sizes, "rim_radius") && sizes.at("rim_radius") > 0.0) return make_pellet(RoundedCylinder{diameter, height, sizes.at("rim_radius")}, facets, true);
    if (has(sizes, "bevel") && sizes.at("bevel") > 0.0)
        return make_pellet(BevelledCylinder{diameter, height, sizes.at("bevel"), sizes.at("bevel")}, facets, true);
    if (has(sizes, "dome_height") && sizes.at("dome_height") > 0.0)  // `height` is the whole one
        return make_pellet(DomedCylinder{diameter, height - 2.0 * sizes.at("dome_height"), sizes.at("dome_height")}, facets, true);
    return make_cylinder(diameter, height, facets, true);
}

TriangleMesh lobed(const Lengths& sizes, std::uint32_t facets, std::uint32_t lobes) {
    return make_pellet(LobedExtrudate{lobes, sizes.at("lobe_diameter"), sizes.at("lobe_offset"), sizes.at("height")}, facets, true);
}

// An icosahedron has 5 edges around its equator, each subdivision doubles them.
std::uint32_t subdivisions_for(std::uint32_t facets) {
    std::uint32_t subdivisions = 2;
    while (subdivisions < 7 && (5u << subdivisions) < facets) ++subdivisions;
    return subdivisions;
}

TriangleMesh sphere(const Lengths& sizes, std::uint32_t facets) {
    const double diameter = sizes.at("diameter");
    if (!(diameter > 0.0)) throw bad_input("a sphere needs a positive diameter", "give it like diameter=3mm");
    TriangleMesh mesh = make_sphere(diameter, subdivisions_for(facets));
    const double exact = std::numbers::pi / 6.0 * diameter * diameter * diameter, factor = std::cbrt(exact / volume_moments(mesh).volume);
    return stretched(std::move(mesh), Vec3::Constant(factor));
}

TriangleMesh scan(const Lengths& sizes, std::uint32_t facets) {
    if (!(sizes.at("size") > 0.0)) throw bad_input("a scan needs a positive size", "give it like size=4mm");
    ScanLike body;
    body.size = sizes.at("size");
    return make_scan_like(body, subdivisions_for(facets));
}

TriangleMesh box(const Lengths& sizes, std::uint32_t) {
    const Vec3 half = 0.5 * Vec3(sizes.at("x"), sizes.at("y"), sizes.at("z"));
    return make_box(-half, half);
}

const std::vector<Entry>& table() {
    static const std::vector<Entry> entries{
        {{"cylinder", "cylinder:diameter=3.12mm,height=2.96mm",
          "flat ends; with rim_radius= rounded rims, with bevel= bevelled ones, with dome_height= domed ends"},
         {"rim_radius", "bevel", "dome_height"},
         cylinder},
        {{"capsule", "capsule:diameter=2mm,length=4mm", "cylinder with half-spheres on its ends, length over all"},
         {},
         [](const Lengths& s, std::uint32_t facets) {
             return make_pellet(Capsule{s.at("diameter"), s.at("length")}, facets, true);
         }},
        {{"ring", "ring:outer_diameter=5mm,inner_diameter=2.5mm,height=5mm", "hollow cylinder (Raschig ring)"},
         {},
         [](const Lengths& s, std::uint32_t facets) {
             return make_pellet(HollowCylinder{s.at("outer_diameter"), s.at("inner_diameter"), s.at("height")}, facets, true);
         }},
        {{"trilobe", "trilobe:lobe_diameter=1mm,lobe_offset=0.5mm,height=3mm", "extrudate of three lobes, their centres lobe_offset from the axis"},
         {},
         [](const Lengths& s, std::uint32_t facets) { return lobed(s, facets, 3); }},
        {{"quadrulobe", "quadrulobe:lobe_diameter=1mm,lobe_offset=0.6mm,height=3mm", "extrudate of four lobes"},
         {},
         [](const Lengths& s, std::uint32_t facets) { return lobed(s, facets, 4); }},
        {{"sphere", "sphere:diameter=3mm", "ball"}, {}, sphere},
        {{"scan", "scan:size=4mm", "a lump with head and ears as a scanner gives it, rough, nothing symmetric"}, {}, scan},
        {{"box", "box:x=3mm,y=2mm,z=1mm", "cuboid"}, {}, box}};
    return entries;
}

std::string trimmed(std::string_view text) {
    const std::size_t begin = text.find_first_not_of(" \t");
    if (begin == std::string_view::npos) return {};
    return std::string(text.substr(begin, text.find_last_not_of(" \t") + 1 - begin));
}

struct Pair {
    std::string key, value;
};

std::vector<Pair> pairs_of(std::string_view text) {
    std::vector<Pair> pairs;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find(','), text.size());
        const std::string_view one = text.substr(0, end);
        const std::size_t equal = one.find('=');
        if (equal == std::string_view::npos)
            throw bad_input("'" + std::string(one.substr(0, 40)) + "' is not key=value", "write the body like cylinder:diameter=3.12mm,height=2.96mm");
        pairs.push_back({trimmed(one.substr(0, equal)), trimmed(one.substr(equal + 1))});
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return pairs;
}

std::uint32_t facets_of(const std::string& text) {
    std::size_t used = 0;
    unsigned long value = 0;
    try {
        value = std::stoul(text, &used);
    } catch (const std::exception&) {
        used = 0;
    }
    if (used == 0 || used != text.size() || text[0] == '-' || value < 8 || value > most_facets)
        throw bad_input("facets = " + text.substr(0, 40) + " is out of reach", "give a whole number from 8 to " + std::to_string(most_facets));
    return static_cast<std::uint32_t>(value);
}

const Entry& entry_of(const std::string& name) {
    std::vector<std::string> known;
    std::string list;
    for (const Entry& entry : table()) {
        if (entry.body.name == name) return entry;
        known.push_back(entry.body.name);
        list += (list.empty() ? "" : ", ") + entry.body.name;
    }
    const std::string guess = closest_word(name.substr(0, 40), known);
    throw bad_input("there is no body '" + name.substr(0, 40) + "'", (guess.empty() ? "" : "did you mean '" + guess + "'? ") + ("known: " + list));
}

}  // namespace

const std::vector<NamedBody>& named_bodies() {
    static const std::vector<NamedBody> bodies = [] {
        std::vector<NamedBody> list;
        for (const Entry& entry : table()) list.push_back(entry.body);
        return list;
    }();
    return bodies;
}

TriangleMesh make_named_body(std::string_view text) {
    const std::size_t colon = std::min(text.find(':'), text.size());
    const Entry& entry = entry_of(trimmed(text.substr(0, colon)));
    Lengths sizes;
    std::vector<std::string> known = entry.more_keys;
    known.emplace_back("facets");
    for (const Pair& pair : pairs_of(std::string_view(entry.body.example).substr(entry.body.name.size() + 1))) {
        sizes[pair.key] = parse_quantity(pair.value, dimension::length);
        known.push_back(pair.key);
    }
    std::uint32_t facets = usual_facets;
    std::map<std::string, bool> seen;
    for (const Pair& pair : pairs_of(text.substr(std::min(colon + 1, text.size())))) {
        if (std::find(known.begin(), known.end(), pair.key) == known.end()) {
            const std::string guess = closest_word(pair.key.substr(0, 40), known);
            std::string list;
            for (const std::string& key : known) list += (list.empty() ? "" : ", ") + key;
            throw bad_input("a " + entry.body.name + " has no '" + pair.key.substr(0, 40) + "'",
                            (guess.empty() ? "" : "did you mean '" + guess + "'? ") + ("known: " + list));
        }
        if (seen[pair.key]) throw bad_input("'" + pair.key + "' is given twice", "give it once");
        seen[pair.key] = true;
        if (pair.key == "facets") {
            facets = facets_of(pair.value);
            continue;
        }
        const double value = parse_quantity(pair.value, dimension::length);
        if (!(value >= 0.0)) throw bad_input(pair.key + " = " + pair.value + " is negative", "give a length that makes a body");
        sizes[pair.key] = value;
    }
    return entry.make(sizes, facets);
}

}  // namespace pelletlab::meshes
