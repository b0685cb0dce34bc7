// Part of the table of case keys: pile, funnel and attrition tester; walls beside those of the rig.
#include "io/detail/case_key_makers.hpp"

namespace pelletlab::io::detail {

/// Pile, funnel and attrition tester.
std::vector<CaseKey> keys_of_piles_and_testers() {
    using namespace dimension;
    std::vector<CaseKey> keys;
    const auto add = [&keys](CaseKey k) { keys.push_back(std::move(k)); };
    add(word({"funnel", "cylinder"},
             key("pile.release", PELLETLAB_MEMBER(c.pile.release), "The shutter of a funnel opens, or an open cylinder that stands on the plate is lifted.")));
    add(in(length, "mm", within(above(0), key("pile.plate_diameter", PELLETLAB_MEMBER(c.pile.plate_diameter), "What runs off the plate falls into a tray."))));
    add(in(length, "mm", within(above(0), key("pile.cylinder_diameter", PELLETLAB_MEMBER(c.pile.cylinder_diameter), "Inner diameter of the cylinder."))));
    add(in(velocity, "mm/s", within(above(0), key("pile.lift_speed", PELLETLAB_MEMBER(c.pile.lift_speed), "Of the cylinder."))));
    add(in(time, "s",
           within(above(0), key("pile.discharge_limit", PELLETLAB_MEMBER(c.pile.discharge_limit),
                                "After the release began; a pile that is not at rest by then gets the status «not at rest»."))));
    add(key("pile.mesh_file", PELLETLAB_MEMBER(c.pile.mesh_file), "Mesh to use instead of the round cylinder; empty: none."));
    add(key("pile.mesh_unit", PELLETLAB_MEMBER(c.pile.mesh_unit), "Length unit of mesh_file (an STL file does not tell): mm, m, in and so on."));
    add(key("pile.material", PELLETLAB_MEMBER(c.pile.material), "Material of all walls of the pile: a table [materials.<name>]."));

    add(in(length, "mm", within(above(0), key("funnel.outlet_diameter", PELLETLAB_MEMBER(c.funnel.outlet_diameter), "Of the round outlet."))));
    add(in(length, "mm", within(above(0), key("funnel.top_diameter", PELLETLAB_MEMBER(c.funnel.top_diameter), "Of the cylinder above the cone."))));
    add(in(angle, "deg",
           within(between(0, 1.5707963267948966),
                  key("funnel.half_angle", PELLETLAB_MEMBER(c.funnel.half_angle), "Between the wall of the cone and the vertical."))));
    add(in(length, "mm",
           within(from(0), key("funnel.outlet_height", PELLETLAB_MEMBER(c.funnel.outlet_height),
                               "Of the outlet above the plate or the floor of the tube; 0: 100 mm above the plate, just above the rim of the tube."))));
    add(in(time, "ms", within(above(0), key("funnel.shutter_time", PELLETLAB_MEMBER(c.funnel.shutter_time), "In which the shutter slides away."))));
    add(within(from_to(8, 4096), key("funnel.facets", PELLETLAB_MEMBER(c.funnel.facets), "Flat facets round the funnel, the cylinder and the plate.")));
    add(key("funnel.mesh_file", PELLETLAB_MEMBER(c.funnel.mesh_file),
            "Mesh to use instead of the cone and its cylinder, about the z axis, the outlet at outlet_height; empty: none."));
    add(key("funnel.mesh_unit", PELLETLAB_MEMBER(c.funnel.mesh_unit), "Length unit of mesh_file (an STL file does not tell): mm, m, in and so on."));

    add(in(length, "mm", within(above(0), key("tester.diameter", PELLETLAB_MEMBER(c.tester.diameter), "Inner diameter."))));
    add(in(length, "mm", within(above(0), key("tester.length", PELLETLAB_MEMBER(c.tester.length), "Inner length between the end plates."))));
    add(in(length, "mm",
           within(from(0), key("tester.baffle_height", PELLETLAB_MEMBER(c.tester.baffle_height), "Of the baffle, from the shell inward; 0: no baffle."))));
    add(in(length, "mm", within(above(0), key("tester.baffle_thickness", PELLETLAB_MEMBER(c.tester.baffle_thickness), "Of the baffle."))));
    add(in(angle, "deg",
           key("tester.baffle_start", PELLETLAB_MEMBER(c.tester.baffle_start),
               "Angle of the baffle while the pellets are filled in; 0 at the bottom, growing with the turn, 180 at the top.")));
    add(in(rotation_speed, "rpm", key("tester.speed", PELLETLAB_MEMBER(c.tester.speed), "Speed of rotation; positive turns about +y, as in the drum.")));
    add(within(from_to(8, 4096), key("tester.facets", PELLETLAB_MEMBER(c.tester.facets), "Flat facets of the round shell.")));
    add(key("tester.mesh_file", PELLETLAB_MEMBER(c.tester.mesh_file), "Mesh of shell and end plates to use instead of the round drum; empty: none."));
    add(key("tester.baffle_mesh_file", PELLETLAB_MEMBER(c.tester.baffle_mesh_file), "Mesh of the baffle, at baffle_start, instead of the plate; empty: none."));
    add(key("tester.mesh_unit", PELLETLAB_MEMBER(c.tester.mesh_unit), "Length unit of both meshes (an STL file does not tell): mm, m, in and so on."));
    add(key("tester.material", PELLETLAB_MEMBER(c.tester.material), "Material of shell, end plates and baffle: a table [materials.<name>]."));
    return keys;
}

/// Walls in closed form beside those of the rig.
std::vector<CaseKey> keys_of_extra_walls() {
    using namespace dimension;
    std::vector<CaseKey> keys;
    const auto add = [&keys](CaseKey k) { keys.push_back(std::move(k)); };
    add(word({"plane", "disc", "cylinder", "cone", "box"},
             key("walls.*.shape", PELLETLAB_MEMBER(c.walls.at(name).shape), "What it is; both of its sides act.")));
    add(in(length, "mm",
           key("walls.*.point", PELLETLAB_MEMBER(c.walls.at(name).point),
               "A point of the plane; the centre of disc and box; the centre of the end at which cylinder and cone begin.")));
    add(optional(key("walls.*.axis", PELLETLAB_MEMBER(c.walls.at(name).axis), "Normal of plane and disc, axis of cylinder and cone; of any length.")));
    add(optional(
        in(length, "mm",
           within(from(0), key("walls.*.radius", PELLETLAB_MEMBER(c.walls.at(name).radius), "Of disc and cylinder, and of the cone where it begins.")))));
    add(optional(
        in(length, "mm", within(from(0), key("walls.*.far_radius", PELLETLAB_MEMBER(c.walls.at(name).far_radius), "Of the cone where it ends; 0: a tip.")))));
    add(optional(in(length, "mm", within(from(0), key("walls.*.length", PELLETLAB_MEMBER(c.walls.at(name).length), "Of cylinder and cone, along the axis.")))));
    add(optional(in(length, "mm", within(from(0), key("walls.*.size", PELLETLAB_MEMBER(c.walls.at(name).size), "Edges of the box along x, y and z.")))));
    add(optional(key("walls.*.material", PELLETLAB_MEMBER(c.walls.at(name).material), "Its material: a table [materials.<name>].")));
    add(optional(key("walls.*.turns", PELLETLAB_MEMBER(c.walls.at(name).turns), "It turns with the drum or tester, as a lifter does, or stands still.")));
    return keys;
}

}  // namespace pelletlab::io::detail
