// pelletlab observe tube: a bed in a standing or lying tube.
#include <fmt/format.h>

#include <cmath>

#include "apps/observe_parts.hpp"
#include "apps/terminal.hpp"
#include "observables/bed.hpp"
#include "observables/contacts.hpp"
#include "observables/lying_bed.hpp"
#include "packing/voidage_correlations.hpp"
#include "report/measured_charts.hpp"

namespace pelletlab::apps {

namespace fs = std::filesystem;

namespace {

/// Material of a wall of a tube's case.
const Material& material_of_wall(const Case& c, const std::string& wall) {
    const auto extra = c.walls.find(wall);
    return c.materials.at(extra == c.walls.end() ? c.tube.material : extra->second.material);
}

/// Elastic constants of a run's contacts; nothing when its forces are not a function of the overlap alone, and then `why` says so.
std::optional<observables::ContactStiffness> stiffness_of(const Case& c, const TrajectoryHeader& header, std::string& why) {
    if (c.physics.cohesion != "none") why = "with cohesion a force is no function of the overlap alone";
    if (c.physics.clump_contacts != "sum") why = "with physics.clump_contacts = \"shared\" the contacts of a pair carry one load between them";
    if (!why.empty()) return std::nullopt;
    const Material& pellet = c.materials.at(c.pellet.material);
    const auto modulus = [&](const Material& other) {
        return observables::effective_modulus(pellet.shear_modulus, pellet.poisson_ratio, other.shear_modulus, other.poisson_ratio);
    };
    observables::ContactStiffness stiffness;
    stiffness.hertz = c.physics.contact_model != "linear";
    stiffness.pellets = stiffness.hertz ? modulus(pellet) : c.physics.linear_stiffness;
    for (const WallShape& wall : header.walls)
        stiffness.walls.push_back(stiffness.hertz ? modulus(material_of_wall(c, wall.name)) : c.physics.linear_stiffness);
    return stiffness;
}

/// Contacts as the solver had them, from the spheres and materials of a run. A table has neither: its pellets touch where their true surfaces are near.
void add_contacts(Observables& measured, const OpenedTrajectory& opened, const observables::TubeGeometry& tube, const Case* c) {
    if (c == nullptr) {
        print_line(
            "  a table tells no contact forces and no sphere contacts: they need the clump's spheres, the materials, and places good to a part of an overlap;");
        print_line("  true_neighbours_per_pellet counts pellets whose true surfaces are closer than a hundredth of their diameter");
        return;
    }
    std::string why;
    const auto stiffness = stiffness_of(*c, opened.frames->header(), why);
    if (!why.empty()) print_line("  contacts are counted, their forces are not given: " + why);
    observables::add_frame_contacts(measured, *opened.frames, tube,
                                    c->tube.surface == "exact" ? observables::TubeSurface::exact : observables::TubeSurface::triangles, stiffness);
}

/// Mean porosities that published correlations give, where the pellets have an axis as the cylinders have that they were fitted to.
std::vector<report::NamedLevel> published_levels(const Observables& measured, const observables::TubeGeometry& tube) {
    std::vector<report::NamedLevel> levels;
    double diameter = not_known;
    bool has_axis = false;
    for (const Observable& o : measured.values) {
        if (o.name == "mean_equivalent_diameter") diameter = o.value * 1e-3;
        has_axis = has_axis || o.name == "mean_axis_alignment";
    }
    if (!has_axis) return levels;
    const double s = diameter / (2.0 * tube.radius);
    for (const packing::VoidageCorrelation& law : packing::voidage_correlations_of_cylinders())
        if (s >= law.lowest && s <= law.highest) levels.emplace_back(law.name + ", mean", law.voidage(s));
    return levels;
}

void write_pictures(const Observables& measured, const observables::TubeGeometry& tube, const fs::path& folder) {
    write_chart(report::porosity_from_wall(measured, tube.radius, published_levels(measured, tube)), folder / "porosity-from-wall.png");
    write_chart(report::porosity_over_height(measured), folder / "porosity-over-height.png");
    write_chart(report::orientation_over_radius(measured), folder / "orientation.png");
    write_chart(report::contact_forces(measured), folder / "contact-forces.png");
    write_map(measured, "packing_fraction", 0.0, folder / "packing-map.png");
}

void observe_lying_tube(const ObserveRequest& request, const OpenedTrajectory& opened, const Case* c) {
    const auto known = [c](double TubeRig::*member) { return c ? std::optional(c->tube.*member) : std::nullopt; };
    observables::LyingGeometry tube;
    tube.radius = 0.5 * needed(request.diameter, dimension::length, known(&TubeRig::diameter), "--diameter \"240 mm\"", "the tube's inner diameter");
    tube.length = needed(request.length, dimension::length, known(&TubeRig::height), "--length \"90 mm\"", "the lying tube's inner length");
    tube.height_grid = given(request.grid, dimension::length, c ? c->measurement.height_grid : tube.height_grid);
    finish(request, "tube", opened, [&] { return observables::measure_lying_bed(*opened.frames, tube); }, {});
}

}  // namespace

void observe_tube(const ObserveRequest& request) {
    const OpenedTrajectory opened = open_for_observation(request.trajectory);
    const Case* c = case_of(opened, Rig::tube);
    if (c ? c->tube.lying : request.lying) {
        observe_lying_tube(request, opened, c);
        return;
    }
    observables::TubeGeometry tube;
    tube.radius = 0.5 * needed(request.diameter, dimension::length, c ? std::optional(c->tube.diameter) : std::nullopt, "--diameter \"52 mm\"",
                               "the tube's inner diameter");
    tube.floor = given(request.floor, dimension::length, 0.0);
    tube.height_grid = given(request.grid, dimension::length, c ? c->measurement.height_grid : tube.height_grid);
    finish(
        request, "tube", opened,
        [&] {
            Observables measured = observables::measure_tube_bed(*opened.frames, tube);
            add_contacts(measured, opened, tube, c);
            return measured;
        },
        [&](const Observables& measured, const fs::path& folder) { write_pictures(measured, tube, folder); });
}

}  // namespace pelletlab::apps
