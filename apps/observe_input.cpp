#include "apps/observe_input.hpp"

#include <fmt/format.h>

#include <fstream>
#include <string_view>
#include <vector>

#include "apps/shape_stage.hpp"
#include "apps/terminal.hpp"
#include "core/error.hpp"
#include "core/units.hpp"
#include "io/case_file.hpp"
#include "io/clump_file.hpp"
#include "io/files.hpp"
#include "io/tracked_particles.hpp"
#include "io/trajectory_file.hpp"
#include "meshes/check.hpp"
#include "meshes/mass_properties.hpp"
#include "meshes/read_mesh.hpp"
#include "meshes/repair.hpp"

namespace pelletlab::apps {

namespace fs = std::filesystem;

namespace {

bool is_hdf5(const fs::path& file) {
    constexpr std::string_view signature = "\x89HDF\r\n\x1a\n";
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw bad_input("the file '" + file.string() + "' cannot be read", "check its name", {file.string()});
    std::string begin(signature.size(), '\0');
    stream.read(begin.data(), static_cast<std::streamsize>(begin.size()));
    return begin == signature;
}

/// «x», «-y», … as a unit vector; nothing for anything else.
std::optional<Vec3> direction(std::string_view text) {
    const double sign = text.starts_with('-') ? -1.0 : 1.0;
    if (!text.empty() && (text.front() == '-' || text.front() == '+')) text.remove_prefix(1);
    if (text.size() != 1 || text[0] < 'x' || text[0] > 'z') return std::nullopt;
    return Vec3(sign * Vec3::Unit(text[0] - 'x'));
}

/// Rotation whose rows are our x, y and z axis in the file's frame.
Mat3 axes_of(const TrajectoryRequest& request) {
    const auto up = direction(request.up.empty() ? "z" : request.up);
    // Without an axis of rotation any direction across will do.
    const auto axis = direction(!request.axis.empty() ? request.axis : request.up.ends_with('y') ? "z" : "y");
    if (!up || !axis || up->cross(*axis).norm() < 0.5)
        throw usage_error("--axis and --up must be two different ones of x, y, z, with a minus sign where they point backwards",
                          "for instance --axis z --up -y for a drum that turns about z in a picture whose y runs downwards");
    Mat3 rows;
    rows << axis->cross(*up).transpose(), axis->transpose(), up->transpose();
    return rows;
}

Vec3 origin_of(const std::string& text) {
    if (text.empty()) return Vec3::Zero();
    Vec3 origin;
    std::string_view rest = text;
    for (int k = 0; k < 3; ++k) {
        const std::size_t comma = rest.find(',');
        if ((comma == std::string_view::npos) != (k == 2))
            throw usage_error("--origin '" + text + "' is no place", "write it as --origin \"0 mm, 0 mm, 120 mm\"");
        origin[k] = parse_quantity(rest.substr(0, comma), dimension::length);
        rest.remove_prefix(comma == std::string_view::npos ? rest.size() : comma + 1);
    }
    return origin;
}

/// Mass properties of no stated density carry no mass.
MassProperties of_density(MassProperties properties, const std::string& density) {
    properties = with_density(properties, density.empty() ? 1.0 : parse_quantity(density, dimension::density));
    if (density.empty()) properties.density = properties.mass = 0.0;
    return properties;
}

PelletShape pellet_of(const TrajectoryRequest& request, Quat& body_in_file) {
    const fs::path file = request.pellet_file;
    if (file.extension() == ".toml") {
        if (!request.pellet_unit.empty()) throw usage_error("--pellet-unit goes with a mesh; a clump file states its units", "leave it out");
        const ClumpTemplate clump = io::read_clump(file);
        body_in_file = clump.rigid.mass_properties.principal_axes;
        PelletShape shape{clump.rigid, clump.mesh_file.empty() ? TriangleMesh{} : true_surface(clump, file)};
        if (!request.pellet_density.empty()) shape.rigid.mass_properties = of_density(shape.rigid.mass_properties, request.pellet_density);
        return shape;
    }
    PelletShape shape;
    const TriangleMesh mesh = meshes::require_closed_body(meshes::read_mesh(file, request.pellet_unit)).mesh;
    shape.rigid.name = file.stem().string();
    const MassProperties properties = meshes::mass_properties(mesh, 1.0);
    const Pose body_in_mesh = properties.body_in_mesh();
    shape.surface_body = transformed(mesh, {body_in_mesh.to_body(Vec3::Zero()), body_in_mesh.orientation.conjugate()});
    shape.rigid.mass_properties = of_density(properties, request.pellet_density);
    for (const Vec3& vertex : shape.surface_body.vertices) shape.rigid.bounding_radius = std::max(shape.rigid.bounding_radius, vertex.norm());
    body_in_file = body_in_mesh.orientation;
    return shape;
}

void print_summary(const fs::path& file, const io::TrackedSummary& summary) {
    print_line(fmt::format("{}: {} rows, {} pellets, {} times", file.string(), summary.rows, summary.tracks, summary.times));
    if (summary.rows_without_place > 0) print_line(fmt::format("  {} rows hold no place and were left out", summary.rows_without_place));
    if (summary.lost > 0) print_line(fmt::format("  {} observations are missing within tracks", summary.lost));
    if (!summary.velocities_from_file) print_line("  velocities: from the places, by differences along each track");
    if (summary.without_velocity > 0) print_line(fmt::format("  {} observations stand alone and have no velocity", summary.without_velocity));
    if (summary.flat != ' ') print_line(fmt::format("  there is no column {}: it counts as 0, and nothing is measured that needs it", summary.flat));
    for (const std::string& name : summary.ignored_columns) print_line("  the column '" + name + "' means nothing here and was not read");
}

OpenedTrajectory open_table(const TrajectoryRequest& request) {
    io::TrackedSettings settings;
    settings.length_unit = request.length_unit;
    settings.time_unit = request.time_unit;
    settings.velocity_unit = request.velocity_unit;
    if (!request.frame_rate.empty()) settings.frame_rate = parse_quantity(request.frame_rate, dimension::frequency);
    settings.axes = axes_of(request);
    settings.origin = origin_of(request.origin);
    OpenedTrajectory opened;
    if (!request.pellet_file.empty() && !request.pellet_diameter.empty())
        throw usage_error("--pellet and --pellet-diameter were both given", "leave one of them out");
    if (!request.pellet_file.empty()) {
        settings.pellet = pellet_of(request, settings.body_in_file);
        opened.inputs["pellet"] = io::sha256_of_file(request.pellet_file);
    } else if (!request.pellet_diameter.empty()) {
        settings.pellet = io::sphere_shape(parse_quantity(request.pellet_diameter, dimension::length));
        if (!request.pellet_density.empty()) {
            MassProperties& mass = settings.pellet->rigid.mass_properties;
            mass.density = parse_quantity(request.pellet_density, dimension::density);
            mass.mass = mass.density * mass.volume;
        }
    }
    io::TrackedParticles tracked = io::read_tracked_particles(request.file, settings);
    print_summary(request.file, tracked.summary);
    const Mat3 axes = settings.axes;
    if (tracked.summary.flat != ' ') {
        opened.depth_known = false;
        if (std::abs(axes.row(1)[tracked.summary.flat - 'x']) < 0.5)
            throw bad_input(fmt::format("the column {} lacks and it is not the coordinate along the drum's axis", tracked.summary.flat),
                            "name the drum's axis with --axis; a tube or a pile needs all three coordinates", {request.file.string(), 1, 1});
    }
    opened.frames = std::move(tracked.frames);
    return opened;
}

}  // namespace

std::string TrajectoryRequest::settings() const {
    std::string text;
    for (const std::string* option :
         {&length_unit, &time_unit, &velocity_unit, &frame_rate, &pellet_file, &pellet_unit, &pellet_diameter, &pellet_density, &axis, &up, &origin})
        text += *option + "|";
    return text;
}

OpenedTrajectory open_for_observation(const TrajectoryRequest& request) {
    OpenedTrajectory opened;
    if (is_hdf5(request.file)) {
        if (request.settings().find_first_not_of('|') != std::string::npos)
            throw usage_error("'" + request.file.string() + "' is a run of pelletlab: it knows its units, axes and pellets",
                              "leave the options for tables out");
        opened.frames = io::open_trajectory(request.file);
        const std::string& text = opened.frames->header().resolved_case;
        if (!text.empty()) opened.resolved_case = io::parse_case(text, request.file.string() + " (its case)");
    } else {
        opened = open_table(request);
    }
    opened.inputs["trajectory"] = io::sha256_of_file(request.file);
    return opened;
}

}  // namespace pelletlab::apps
