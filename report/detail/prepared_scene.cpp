#include "report/detail/prepared_scene.hpp"

#include <cmath>
#include <string>

#include "core/error.hpp"

namespace pelletlab::report::detail {
namespace {

bool draws_something(const SceneObject& object) {
    return !object.poses.empty() && (!object.mesh.empty() || !object.spheres.empty());
}

void check(const SceneObject& object, std::size_t number) {
    const auto fail = [number](const std::string& what) { throw bad_input("object " + std::to_string(number) + " of the picture: " + what); };
    const bool coloured_mesh = !object.vertex_colours.empty();
    if (coloured_mesh && object.vertex_colours.size() != object.mesh.vertices.size())
        fail(std::to_string(object.vertex_colours.size()) + " vertex colours for " + std::to_string(object.mesh.vertices.size()) + " vertices");
    if (!object.vertex_normals.empty() && object.vertex_normals.size() != object.mesh.vertices.size())
        fail(std::to_string(object.vertex_normals.size()) + " vertex normals for " + std::to_string(object.mesh.vertices.size()) + " vertices");
    const bool needs_colours = !object.glass && (!coloured_mesh || !object.spheres.empty());
    if (needs_colours ? object.colours.size() != object.poses.size() : !(object.colours.empty() || object.colours.size() == object.poses.size()))
        fail(std::to_string(object.colours.size()) + " colours for " + std::to_string(object.poses.size()) + " poses");
    for (const Vec3& vertex : object.mesh.vertices)
        if (!vertex.allFinite()) fail("a vertex is not finite");
    for (const Triangle& face : object.mesh.faces)
        for (const std::uint32_t index : face)
            if (index >= object.mesh.vertices.size()) fail("a face names vertex " + std::to_string(index) + ", which does not exist");
    for (const Sphere& sphere : object.spheres)
        if (!sphere.centre.allFinite() || !std::isfinite(sphere.radius) || sphere.radius <= 0.0) fail("a sphere has no finite centre and positive radius");
    for (const Pose& pose : object.poses)
        if (!pose.position.allFinite() || !pose.orientation.coeffs().allFinite()) fail("a pose is not finite");
}

Box box_of(const SceneObject& object) {
    Box own;
    for (const Vec3& vertex : object.mesh.vertices) own.extend(vertex);
    for (const Sphere& sphere : object.spheres) {
        own.extend(Vec3(sphere.centre.array() - sphere.radius));
        own.extend(Vec3(sphere.centre.array() + sphere.radius));
    }
    const double radius = own.isEmpty() ? 0.0 : 0.5 * own.diagonal().norm();
    Box world;
    for (const Pose& pose : object.poses) {
        const Vec3 centre = pose.to_world(own.center());
        world.extend(Vec3(centre.array() - radius));
        world.extend(Vec3(centre.array() + radius));
    }
    return world;
}

PreparedObject prepare_object(const SceneObject& object, double scale) {
    PreparedObject prepared;
    prepared.glass = object.glass;
    prepared.vertex_colours = object.vertex_colours;
    prepared.faces = object.mesh.faces;
    for (const Vec3& vertex : object.mesh.vertices) prepared.vertices.push_back((vertex * scale).cast<float>());
    if (object.vertex_normals.empty()) {
        prepared.corner_normals = corner_normals(object.mesh, object.crease_angle);
    } else {
        const auto normal = [&object](std::uint32_t vertex) -> Vec3f { return object.vertex_normals[vertex].cast<float>(); };
        for (const Triangle& face : object.mesh.faces) prepared.corner_normals.push_back({normal(face[0]), normal(face[1]), normal(face[2])});
    }
    for (const Sphere& sphere : object.spheres) {
        const Vec3 centre = sphere.centre * scale;
        prepared.spheres.emplace_back(Eigen::Vector4d(centre.x(), centre.y(), centre.z(), sphere.radius * scale).cast<float>());
    }
    if (object.glass)
        for (const auto& edge : feature_edges(object.mesh, object.crease_angle))
            prepared.edges.push_back({prepared.vertices[edge[0]], prepared.vertices[edge[1]]});
    return prepared;
}

}  // namespace

PreparedScene prepare(const Scene& scene, double line_radius) {
    PreparedScene prepared;
    Box everything;
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        check(scene.objects[i], i);
        if (draws_something(scene.objects[i])) everything.extend(box_of(scene.objects[i]));
    }
    if (everything.isEmpty()) throw bad_input("the picture has nothing to draw", "give it a mesh or spheres with at least one pose");
    prepared.centre = everything.center();
    prepared.scale = 2.0 / everything.diagonal().norm();
    prepared.line_radius = line_radius * prepared.scale;

    for (const SceneObject& object : scene.objects) {
        if (!draws_something(object)) continue;
        const auto index = static_cast<std::uint32_t>(prepared.objects.size());
        prepared.objects.push_back(prepare_object(object, prepared.scale));
        for (std::size_t i = 0; i < object.poses.size(); ++i) {
            PreparedInstance instance;
            instance.object = index;
            instance.rotation = object.poses[i].orientation.normalized().toRotationMatrix().cast<float>();
            instance.translation = prepared.scaled(object.poses[i].position).cast<float>();
            if (!object.colours.empty()) instance.colour = object.colours[i];
            (object.glass ? prepared.glass : prepared.opaque).push_back(instance);
        }
    }
    return prepared;
}

}  // namespace pelletlab::report::detail
