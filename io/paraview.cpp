#include "io/paraview.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <vector>

#include "core/error.hpp"
#include "core/progress.hpp"
#include "io/detail/vtk_xml.hpp"
#include "io/files.hpp"

namespace pelletlab::io {

namespace {

using detail::VtkPolyData;
namespace fs = std::filesystem;

void push_point(VtkPolyData& data, const Vec3& p) {
    for (int k = 0; k < 3; ++k) data.points.push_back(static_cast<float>(p[k]));
}

std::int32_t point_count(const VtkPolyData& data) {
    return static_cast<std::int32_t>(data.points.size() / 3);
}

/// Adds the mesh at this pose; returns how many polygons came.
std::size_t push_mesh(VtkPolyData& data, const TriangleMesh& mesh, const Pose& pose) {
    const std::int32_t first = point_count(data);
    const Mat3 rotation = pose.orientation.toRotationMatrix();
    for (const Vec3& vertex : mesh.vertices) push_point(data, rotation * vertex + pose.position);
    for (const Triangle& face : mesh.faces) {
        for (const std::uint32_t corner : face) data.polygons.connectivity.push_back(first + static_cast<std::int32_t>(corner));
        data.polygons.offsets.push_back(static_cast<std::int32_t>(data.polygons.connectivity.size()));
    }
    return mesh.faces.size();
}

/// Each body as a point with its pose: ParaView's «Glyph With Custom Source» puts the pellet-<shape>.vtp there (orientation mode «Quaternion»).
VtkPolyData bodies_of(const TrajectoryHeader& header, const Frame& frame) {
    VtkPolyData data;
    std::vector<std::int32_t> body, shape;
    std::vector<float> quaternion, velocity, spin, speed, radius;
    for (std::size_t i = 0; i < header.shape_of_body.size(); ++i) {
        if (!frame.is_seen(i)) continue;  // not released yet, or a lost track
        data.vertices.connectivity.push_back(point_count(data));
        push_point(data, frame.positions[i]);
        body.push_back(static_cast<std::int32_t>(i));
        shape.push_back(static_cast<std::int32_t>(header.shape_of_body[i]));
        const Quat& q = frame.orientations[i];
        for (const double component : {q.w(), q.x(), q.y(), q.z()}) quaternion.push_back(static_cast<float>(component));
        for (int k = 0; k < 3; ++k) velocity.push_back(static_cast<float>(frame.velocities[i][k]));
        for (int k = 0; k < 3; ++k) spin.push_back(static_cast<float>(frame.spins[i][k]));
        speed.push_back(static_cast<float>(frame.velocities[i].norm()));
        radius.push_back(static_cast<float>(header.shapes[header.shape_of_body[i]].rigid.bounding_radius));
    }
    if (!body.empty()) data.vertices.offsets.push_back(point_count(data));
    data.point_data.push_back({"quaternion", 4, std::move(quaternion)});
    data.point_data.push_back({"velocity", 3, std::move(velocity)});
    data.point_data.push_back({"spin", 3, std::move(spin)});
    data.point_data.push_back({"speed", 1, std::move(speed)});
    data.point_data.push_back({"bounding_radius", 1, std::move(radius)});
    data.point_data.push_back({"body", 1, std::move(body)});
    data.point_data.push_back({"shape", 1, std::move(shape)});
    return data;
}

/// The true surfaces of all bodies at their poses, in one mesh.
VtkPolyData surfaces_of(const TrajectoryHeader& header, const Frame& frame) {
    VtkPolyData data;
    data.time = frame.time;
    std::vector<std::int32_t> body;
    std::vector<float> speed;
    for (std::size_t i = 0; i < header.shape_of_body.size(); ++i) {
        if (!frame.is_seen(i)) continue;  // not released yet, or a lost track
        const std::size_t polygons = push_mesh(data, header.shapes[header.shape_of_body[i]].surface_body, {frame.positions[i], frame.orientations[i]});
        body.insert(body.end(), polygons, static_cast<std::int32_t>(i));
        speed.insert(speed.end(), polygons, static_cast<float>(frame.velocities[i].norm()));
    }
    data.cell_data.push_back({"body", 1, std::move(body)});
    data.cell_data.push_back({"speed", 1, std::move(speed)});
    return data;
}

/// All spheres as points with radius: ParaView's «Point Gaussian» or its glyph filter draws them.
VtkPolyData spheres_of(const TrajectoryHeader& header, const Frame& frame) {
    VtkPolyData data;
    std::vector<std::int32_t> body;
    std::vector<float> radius, speed;
    for (std::size_t i = 0; i < header.shape_of_body.size(); ++i) {
        if (!frame.is_seen(i)) continue;  // not released yet, or a lost track
        const Pose pose{frame.positions[i], frame.orientations[i]};
        for (const Sphere& sphere : header.shapes[header.shape_of_body[i]].rigid.spheres) {
            data.vertices.connectivity.push_back(point_count(data));
            push_point(data, pose.to_world(sphere.centre));
            radius.push_back(static_cast<float>(sphere.radius));
            body.push_back(static_cast<std::int32_t>(i));
            speed.push_back(static_cast<float>(frame.velocities[i].norm()));
        }
    }
    if (!radius.empty()) data.vertices.offsets.push_back(point_count(data));
    data.point_data.push_back({"radius", 1, std::move(radius)});
    data.point_data.push_back({"body", 1, std::move(body)});
    data.point_data.push_back({"speed", 1, std::move(speed)});
    return data;
}

VtkPolyData walls_of(const TrajectoryHeader& header, const Frame& frame) {
    VtkPolyData data;
    std::vector<std::int32_t> wall;
    for (std::size_t i = 0; i < header.walls.size(); ++i) {
        wall.insert(wall.end(), push_mesh(data, header.walls[i].mesh, frame.wall_poses[i]), static_cast<std::int32_t>(i));
        data.names.push_back(header.walls[i].name);
    }
    data.cell_data.push_back({"wall", 1, std::move(wall)});
    return data;
}

/// VTK's indices are 32 bits wide here: refuse before they overflow.
void check_size(const TrajectoryHeader& header) {
    double points = 0.0;
    for (const std::uint32_t shape : header.shape_of_body) points += static_cast<double>(header.shapes[shape].rigid.spheres.size());
    if (points > 2e9) throw bad_input("the pellets have too many spheres for ParaView files", "set output.paraview = false");
}

std::size_t surface_triangles(const TrajectoryHeader& header) {
    std::size_t count = 0;
    for (const std::uint32_t shape : header.shape_of_body) count += header.shapes[shape].surface_body.faces.size();
    return count;
}

std::vector<std::size_t> chosen_frames(std::size_t count, std::size_t every) {
    std::vector<std::size_t> chosen;
    for (std::size_t i = 0; i < count; i += std::max<std::size_t>(every, 1)) chosen.push_back(i);
    if (!chosen.empty() && chosen.back() + 1 != count) chosen.push_back(count - 1);
    return chosen;
}

}  // namespace

ParaviewFiles write_paraview(const FrameSource& trajectory, const fs::path& folder, std::size_t every, std::size_t most_surface) {
    const TrajectoryHeader& header = trajectory.header();
    check_size(header);
    struct Series {
        const char* name;
        VtkPolyData (*make)(const TrajectoryHeader&, const Frame&);
        std::vector<detail::PvdEntry> entries;
    };
    std::array<Series, 3> all{{{"bodies", bodies_of, {}}, {"spheres", spheres_of, {}}, {"walls", walls_of, {}}}};
    for (const Series& series : all) prepare_output_folder(folder / series.name);
    for (const std::size_t index : chosen_frames(trajectory.frame_count(), every)) {
        throw_if_interrupted();
        const Frame frame = trajectory.frame(index);
        char file_name[32];
        std::snprintf(file_name, sizeof file_name, "%06zu.vtp", index);
        for (Series& series : all) {
            VtkPolyData data = series.make(header, frame);
            data.time = frame.time;
            write_text(folder / series.name / file_name, detail::vtp_text(data));
            series.entries.push_back({frame.time, std::string(series.name) + "/" + file_name});
        }
    }
    for (const Series& series : all) write_text(folder / (std::string(series.name) + ".pvd"), detail::pvd_text(series.entries));
    for (std::size_t shape = 0; shape < header.shapes.size(); ++shape) {
        VtkPolyData data;
        push_mesh(data, header.shapes[shape].surface_body, {});
        write_text(folder / ("pellet-" + std::to_string(shape) + ".vtp"), detail::vtp_text(data));
    }
    ParaviewFiles files{folder / "bodies.pvd", folder / "spheres.pvd", folder / "walls.pvd", {}};
    if (trajectory.frame_count() > 0 && surface_triangles(header) <= most_surface) {
        files.surface = folder / "surface-last.vtp";
        write_text(files.surface, detail::vtp_text(surfaces_of(header, trajectory.frame(trajectory.frame_count() - 1))));
    }
    return files;
}

}  // namespace pelletlab::io
