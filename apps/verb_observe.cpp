// pelletlab observe tube|pile|drum|tester TRAJECTORY
#include <CLI/CLI.hpp>
#include <memory>

#include "apps/observe_stage.hpp"
#include "apps/verbs.hpp"

namespace pelletlab::apps {

namespace {

using Measure = void (*)(const ObserveRequest&);

std::shared_ptr<ObserveRequest> add_common(CLI::App* verb, Measure measure) {
    auto request = std::make_shared<ObserveRequest>();
    TrajectoryRequest& file = request->trajectory;
    verb->add_option("trajectory", file.file, "run.h5 of pelletlab, or a table (CSV) of tracked particles: time, id, x, y, z, …")->required();
    verb->add_option("-o,--output", request->output, "Folder of the results; 'observed' when not given");
    verb->add_flag("--force", request->force, "Measure again although nothing has changed");
    verb->add_flag("!--no-picture", request->pictures, "Write no pictures");
    const std::string group = "For a table";
    verb->add_option("--unit", file.length_unit, "Unit of lengths whose column states none: mm, m, …")->group(group);
    verb->add_option("--time-unit", file.time_unit, "Unit of times whose column states none: s, ms, …")->group(group);
    verb->add_option("--velocity-unit", file.velocity_unit, "Unit of velocities whose column states none; else length per time")->group(group);
    verb->add_option("--frame-rate", file.frame_rate, "Pictures a second, when the table counts frames: \"1000 Hz\"")->group(group);
    verb->add_option("--pellet-diameter", file.pellet_diameter, "The pellets are spheres of this size: \"3 mm\"")->group(group);
    verb->add_option("--pellet", file.pellet_file, "The pellet: a clump (.clump.toml) or a mesh (.stl)")->group(group);
    verb->add_option("--pellet-unit", file.pellet_unit, "Unit of the pellet's mesh")->group(group);
    verb->add_option("--pellet-density", file.pellet_density, "\"1800 kg/m^3\", for figures that need a mass")->group(group);
    verb->add_option("--up", file.up, "Axis of the table that points up: z when not given; -y for a picture whose y runs downwards")->group(group);
    verb->add_option("--origin", file.origin,
                     "Place in the table that is our origin (drum: its centre; tube and pile: the axis at the floor): \"0 mm, 0 mm, 0 mm\"")
        ->group(group);
    verb->callback([request, measure] { measure(*request); });
    return request;
}

void add_window(CLI::App* verb, ObserveRequest& request) {
    verb->add_option("--from", request.from, "Begin of the window that is measured: \"2 s\"");
    verb->add_option("--until", request.until, "End of that window");
}

void add_tube(CLI::App* observe) {
    CLI::App* verb = observe->add_subcommand(
        "tube",
        "A bed in a tube, standing or lying, at the last time: height, packing and porosity over radius and height, orientation, overlaps of the true\n"
        "pellets; of a run also contacts and their forces; profiles.csv and pictures\n  example: pelletlab observe tube out/tube/run.h5 -o out/tube-observed");
    const auto request = add_common(verb, observe_tube);
    verb->add_option("--diameter", request->diameter, "Inner diameter of the tube: \"52 mm\"; a run of pelletlab knows it");
    verb->add_option("--floor", request->floor, "Height of the floor; 0 when not given");
    verb->add_option("--grid", request->grid, "Cell of the top-surface grid: \"1 mm\"");
    verb->add_flag("--lying", request->lying, "The tube of the table lies level along --axis, its centre in the origin; a run of pelletlab knows it");
    verb->add_option("--length", request->length, "Inner length of a lying tube: \"90 mm\"");
    verb->add_option("--axis", request->trajectory.axis, "Axis of the table along which a lying tube lies: y when not given")->group("For a table");
}

void add_pile(CLI::App* observe) {
    CLI::App* verb = observe->add_subcommand(
        "pile", "A pile on a flat plate, at the last time\n  example: pelletlab observe pile pile.csv --pellet-diameter \"3.5 mm\" --ceiling \"100 mm\"");
    const auto request = add_common(verb, observe_pile);
    verb->add_option("--floor", request->floor, "Height of the plate; 0 when not given");
    verb->add_option("--ceiling", request->ceiling, "Pellets above this height are still in the funnel and do not count");
    verb->add_option("--grid", request->grid, "Cell of the top-surface grid; 1 mm when not given");
}

void add_drum(CLI::App* observe) {
    CLI::App* verb = observe->add_subcommand("drum",
                                             "A turning drum: surface, angles, velocities\n"
                                             "  example: pelletlab observe drum tracks.csv --diameter \"240 mm\" --length \"90 mm\" --speed \"20 rpm\" "
                                             "--pellet-diameter \"3.5 mm\" --unit mm --time-unit s");
    const auto request = add_common(verb, observe_drum);
    add_window(verb, *request);
    verb->add_option("--diameter", request->diameter, "Inner diameter: \"240 mm\"; a run of pelletlab knows it, as the next two");
    verb->add_option("--length", request->length, "Inner length: \"90 mm\"");
    verb->add_option("--speed", request->speed, "\"20 rpm\", about the axis: seen along it, positive is clockwise with the bed climbing on the left");
    verb->add_option("--axis", request->trajectory.axis, "Axis of the table along which the camera looks, from the front plate to the back: y when not given")
        ->group("For a table");
    verb->add_option("--pellets-each", request->pellets_each, "Pellets that each tracked one stands for, when only some of those in the drum were tracked")
        ->check(CLI::PositiveNumber);
    verb->add_option("--grid", request->grid, "Cell of the velocity map: \"2 mm\"");
    verb->add_option("--slab", request->slab, "Measure this axial slab only, counted from the drum's middle: \"-5 mm, 5 mm\"");
    verb->add_option("--view-depth", request->view_depth, "How deep behind the front plate the camera sees: \"7 mm\"; two pellets when not given");
    verb->add_option("--camera-grid", request->camera_grid, "Cell of the camera's map: \"0.5 mm\"");
}

void add_tester(CLI::App* observe) {
    CLI::App* verb =
        observe->add_subcommand("tester",
                                "An attrition tester: pellet cloud, load of the baffle, release angle; of a run also the energies of collisions\n"
                                "  example: pelletlab observe tester tracks.csv --diameter \"254 mm\" --length \"152 mm\" --baffle-height \"51 mm\" "
                                "--speed \"40 rpm\" --baffle-angle \"0 deg\" --pellet-diameter \"3.5 mm\" --unit mm --time-unit s");
    const auto request = add_common(verb, observe_tester);
    add_window(verb, *request);
    verb->add_option("--diameter", request->diameter, "Inner diameter: \"254 mm\"; a run of pelletlab knows it, as the next four");
    verb->add_option("--length", request->length, "Inner length: \"152 mm\"");
    verb->add_option("--speed", request->speed, "\"40 rpm\", about the axis: seen along it, positive is clockwise with the baffle rising on the left");
    verb->add_option("--baffle-height", request->baffle_height, "Of the baffle, from the shell inward: \"51 mm\"");
    verb->add_option("--baffle-angle", request->baffle_angle, "Angle of the baffle at time 0: 0 at the bottom, growing with the turn");
    verb->add_option("--axis", request->trajectory.axis, "Axis of the table along which one looks, from the front plate to the back: y when not given")
        ->group("For a table");
    verb->add_option("--grid", request->grid, "Cell of the maps: \"2 mm\"");
}

}  // namespace

void add_observe_verb(CLI::App& app) {
    CLI::App* observe = app.add_subcommand("observe", "Measure a trajectory: a run, or particles tracked by a camera, a detector or another program");
    observe->require_subcommand(1);
    observe->fallthrough();
    add_tube(observe);
    add_pile(observe);
    add_drum(observe);
    add_tester(observe);
}

}  // namespace pelletlab::apps
