#include "io/detail/case_check.hpp"

#include <algorithm>

#include "core/units.hpp"
#include "io/detail/case_keys.hpp"
#include "io/detail/toml_text.hpp"

namespace pelletlab::io::detail {

namespace {

std::string suggestion(const std::string& word, const std::vector<std::string>& candidates) {
    const std::string guess = closest_word(word, candidates);
    return guess.empty() ? "" : "did you mean '" + guess + "'? ";
}

std::vector<std::string> defined_materials(const Case& c) {
    std::vector<std::string> names;
    for (const auto& [name, ignored] : c.materials) names.push_back(name);
    return names;
}

void check_material(const Case& c, const std::string& key, const std::string& name, const CasePlaces& places) {
    if (c.materials.contains(name)) return;
    throw bad_input(key + ": the material '" + name + "' is not defined",
                    suggestion(name, defined_materials(c)) + "add a table [materials." + toml_key(name) + "]", places.of({key}));
}

/// A row's name is «pellet-» and then «pellet», a wall or a material.
void check_contact_name(const Case& c, const std::string& name, const CasePlaces& places) {
    std::vector<std::string> walls_of_case = wall_names(c);
    for (const auto& [wall, ignored] : c.walls) walls_of_case.push_back(wall);
    std::vector<std::string> partners = walls_of_case;
    partners.emplace_back("pellet");
    for (const std::string& material : defined_materials(c)) partners.push_back(material);
    std::vector<std::string> rows;
    for (const std::string& partner : partners) rows.push_back("pellet-" + partner);
    if (default_contact(name) != nullptr || std::find(rows.begin(), rows.end(), name) != rows.end()) return;
    std::string walls;
    for (const std::string& wall : walls_of_case) walls += ", '" + wall + "'";
    throw bad_input("contacts." + toml_key(name) + ": its partner is no wall and no defined material",
                    suggestion(name, rows) + "name it pellet-<partner>, the partner 'pellet'" + walls + " or a material",
                    places.of({"contacts." + toml_key(name)}));
}

void check_contacts(const Case& c, const CasePlaces& places) {
    for (const auto& [name, ignored] : c.contacts) check_contact_name(c, name, places);
    if (!c.contacts.contains("pellet-pellet"))
        throw bad_input("the contact row pellet-pellet is missing", "add [contacts.pellet-pellet]", places.of({"contacts"}));
    const std::string& material = wall_material(c);
    if (c.contacts.contains("pellet-" + material)) return;
    for (const std::string& wall : wall_names(c)) {
        if (c.contacts.contains("pellet-" + wall)) continue;
        throw bad_input("the wall '" + wall + "' has no contact row with the pellets",
                        "add [contacts." + toml_key("pellet-" + material) + "] for its material or [contacts.pellet-" + wall + "] for this wall",
                        places.of({rig_name(c.rig) + ".material", "contacts", "rig"}));
    }
}

/// A wall of the case says all that its shape needs.
void check_extra_wall(const Case& c, const std::string& name, const ExtraWall& w, const CasePlaces& places) {
    const std::string table = "walls." + toml_key(name);
    const auto need = [&](bool good, const std::string& key, const std::string& what, const std::string& remedy) {
        if (!good) throw bad_input(table + ": " + what, remedy, places.of({table + "." + key, table}));
    };
    const std::vector<std::string> taken = wall_names(c);
    need(std::find(taken.begin(), taken.end(), name) == taken.end(), "", "the rig itself has a wall of this name", "choose another name");
    if (w.shape != "box") need(w.axis.norm() > 0.0, "axis", "its axis has no direction", "write for instance axis = [0, 0, 1]");
    if (w.shape == "disc" || w.shape == "cylinder") need(w.radius > 0.0, "radius", "a " + w.shape + " needs a radius", "write for instance radius = \"10 mm\"");
    if (w.shape == "cone") need(w.radius + w.far_radius > 0.0, "radius", "a cone needs a radius at one of its ends", "write for instance radius = \"10 mm\"");
    if (w.shape == "cylinder" || w.shape == "cone") need(w.length > 0.0, "length", "a " + w.shape + " needs a length", "write for instance length = \"10 mm\"");
    if (w.shape == "box") need(w.size.minCoeff() > 0.0, "size", "a box needs three edges", "write for instance size = [\"10 mm\", \"20 mm\", \"5 mm\"]");
    need(!w.turns || c.rig == Rig::drum || c.rig == Rig::tester, "turns", "only a drum or a tester turns", "remove turns, or write turns = false");
    check_material(c, table + ".material", w.material, places);
    need(c.contacts.contains("pellet-" + name) || c.contacts.contains("pellet-" + w.material), "material", "it has no contact row with the pellets",
         "add [contacts." + toml_key("pellet-" + name) + "] or [contacts." + toml_key("pellet-" + w.material) + "]");
}

void check_surface(const std::string& rig, const std::string& surface, const std::string& mesh_file, const CasePlaces& places) {
    if (surface != "exact" || mesh_file.empty()) return;
    throw bad_input(rig + ".surface = \"exact\" stands for the round " + rig + " of its diameter, and " + rig + ".mesh_file asks for another vessel",
                    "remove one of the two", places.of({rig + ".surface", rig + ".mesh_file"}));
}

void check_mesh(const std::string& rig, const std::string& mesh_file, const std::string& mesh_unit, const CasePlaces& places) {
    if (mesh_file.empty() && mesh_unit.empty()) return;
    if (mesh_unit.empty())
        throw bad_input(rig + ".mesh_file has no unit: a mesh file does not tell whether it is in mm or m", "add mesh_unit = \"mm\" beside it",
                        places.of({rig + ".mesh_file"}));
    try {
        unit_factor(mesh_unit, dimension::length);
    } catch (const Error& error) {
        throw bad_input(rig + ".mesh_unit: " + error.problem(), error.remedy(), places.of({rig + ".mesh_unit"}));
    }
}

void check_tube(const Case& c, const CasePlaces& places) {
    check_mesh("tube", c.tube.mesh_file, c.tube.mesh_unit, places);
    check_surface("tube", c.tube.surface, c.tube.mesh_file, places);
    if (c.tube.lying && !(c.tube.height > 0.0))
        throw bad_input("a lying tube needs its length", "write tube.height = \"90 mm\"", places.of({"tube.height", "tube.lying"}));
    if (c.tube.lying && c.insertion.way != "cloud")
        throw bad_input("a lying tube is closed by end plates: it can only be filled with a cloud of pellets", "write insertion.way = \"cloud\"",
                        places.of({"insertion.way", "tube.lying"}));
    if (c.insertion.way == "sieve" && c.tube.height > 0.0 && c.insertion.sieve_height > c.tube.height)
        throw bad_input("the sieve lies above the rim of the tube", "lower insertion.sieve_height, or raise tube.height",
                        places.of({"insertion.sieve_height", "tube.height"}));
    if (c.insertion.way == "batches" && c.insertion.batches > c.pellet.count)
        throw bad_input("there are more batches than pellets", "lower insertion.batches", places.of({"insertion.batches", "pellet.count"}));
}

void check_funnel(const Case& c, const CasePlaces& places) {
    check_mesh("funnel", c.funnel.mesh_file, c.funnel.mesh_unit, places);
    if (c.funnel.outlet_diameter >= c.funnel.top_diameter)
        throw bad_input("the outlet of the funnel is not narrower than its top", "correct funnel.outlet_diameter or funnel.top_diameter",
                        places.of({"funnel.outlet_diameter", "funnel.top_diameter"}));
    if (c.rig == Rig::tube && c.funnel.outlet_diameter > c.tube.diameter)
        throw bad_input("the outlet of the funnel is wider than the tube: pellets would fall beside it", "make funnel.outlet_diameter smaller",
                        places.of({"funnel.outlet_diameter", "tube.diameter"}));
    if (c.rig == Rig::tube && c.funnel.outlet_height > 0.0 && c.tube.height > 0.0 && c.funnel.outlet_height < c.tube.height)
        throw bad_input("the outlet of the funnel lies below the rim of the tube", "raise funnel.outlet_height, or leave it at 0",
                        places.of({"funnel.outlet_height", "tube.height"}));
}

void check_tester(const Case& c, const CasePlaces& places) {
    const TesterRig& t = c.tester;
    check_mesh("tester", t.mesh_file.empty() ? t.baffle_mesh_file : t.mesh_file, t.mesh_unit, places);
    if (t.baffle_height >= 0.5 * t.diameter)
        throw bad_input("the baffle reaches the axis of the tester", "make tester.baffle_height smaller than half of tester.diameter",
                        places.of({"tester.baffle_height", "tester.diameter"}));
    if (t.baffle_height > 0.0 && t.baffle_thickness > t.baffle_height)
        throw bad_input("the baffle is thicker than high", "make tester.baffle_thickness smaller",
                        places.of({"tester.baffle_thickness", "tester.baffle_height"}));
    if (t.speed == 0.0) throw bad_input("tester.speed is zero", "state the speed of rotation, \"40 rpm\"", places.of({"tester.speed"}));
}

void check_rig(const Case& c, const CasePlaces& places) {
    if (c.rig == Rig::tube) check_tube(c, places);
    if (c.rig == Rig::drum) {
        check_mesh("drum", c.drum.mesh_file, c.drum.mesh_unit, places);
        check_surface("drum", c.drum.surface, c.drum.mesh_file, places);
    }
    if (c.rig == Rig::pile) check_mesh("pile", c.pile.mesh_file, c.pile.mesh_unit, places);
    if (c.rig == Rig::tester) check_tester(c, places);
    if (has_funnel(c)) check_funnel(c, places);
    for (const auto& [name, wall] : c.walls) check_extra_wall(c, name, wall, places);
}

void check_times(const Case& c, const CasePlaces& places) {
    if (c.time.step > c.output.frame_interval)
        throw bad_input("time.step is longer than output.frame_interval", "store frames less often, or shorten the step",
                        places.of({"time.step", "output.frame_interval"}));
    if (c.time.step > c.time.settle_limit)
        throw bad_input("time.step is longer than time.settle_limit", "raise the limit, or shorten the step", places.of({"time.settle_limit", "time.step"}));
    if ((c.rig == Rig::drum || c.rig == Rig::tester) && c.output.frame_interval > c.time.measure)
        throw bad_input("output.frame_interval is longer than time.measure: no frame would be measured", "store frames more often, or measure longer",
                        places.of({"time.measure", "output.frame_interval"}));
}

void check_sizes(const Case& c, const CasePlaces& places) {
    if (c.rig == Rig::tube && c.measurement.height_grid > c.tube.diameter)
        throw bad_input("measurement.height_grid is larger than the tube's diameter", "choose a finer grid",
                        places.of({"measurement.height_grid", "tube.diameter"}));
    if (c.rig == Rig::tester && c.measurement.velocity_grid > c.tester.diameter)
        throw bad_input("measurement.velocity_grid is larger than the tester's diameter", "choose a finer grid",
                        places.of({"measurement.velocity_grid", "tester.diameter"}));
    if (c.rig == Rig::drum && c.measurement.velocity_grid > c.drum.diameter)
        throw bad_input("measurement.velocity_grid is larger than the drum's diameter", "choose a finer grid",
                        places.of({"measurement.velocity_grid", "drum.diameter"}));
}

}  // namespace

Place CasePlaces::of(const std::vector<std::string>& paths) const {
    for (const std::string& path : paths)
        if (const auto found = places_.find(path); found != places_.end()) return found->second;
    return {file_};
}

void add_default_materials(Case& c) {
    std::vector<std::string> materials = {c.pellet.material, wall_material(c)}, rows = {"pellet-pellet", "pellet-" + wall_material(c)};
    for (const auto& [ignored, wall] : c.walls) materials.push_back(wall.material), rows.push_back("pellet-" + wall.material);
    for (const std::string& name : materials)
        if (const Material* material = default_material(name)) c.materials.try_emplace(name, *material);
    for (const std::string& name : rows)
        if (const ContactParameters* contact = default_contact(name)) c.contacts.try_emplace(name, *contact);
}

void check_case(const Case& c, const CasePlaces& places) {
    if (c.name.empty()) throw bad_input("name is empty", "give the run a name", places.of({"name"}));
    if (c.gravity.norm() == 0.0)
        throw bad_input("gravity is zero: the pellets would never come to rest", "write for instance gravity = [\"0 m/s^2\", \"0 m/s^2\", \"-9.81 m/s^2\"]",
                        places.of({"gravity"}));
    if (c.pellet.clump_file.empty())
        throw bad_input("pellet.clump_file is empty", "name the clump template, made by `pelletlab shape`", places.of({"pellet.clump_file"}));
    if (c.rig != Rig::drum && c.pellet.count == 0)
        throw bad_input("pellet.count is 0: only a drum has a fill fraction to take the number from", "state the number of pellets",
                        places.of({"pellet.count"}));
    check_material(c, "pellet.material", c.pellet.material, places);
    check_material(c, rig_name(c.rig) + ".material", wall_material(c), places);
    check_contacts(c, places);
    check_rig(c, places);
    check_times(c, places);
    check_sizes(c, places);
}

}  // namespace pelletlab::io::detail
