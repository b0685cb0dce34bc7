#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "report/detail/camera_rays.hpp"
#include "report/detail/fit_camera.hpp"
#include "report/detail/page.hpp"
#include "report/detail/sphere_mesh.hpp"

namespace pelletlab::report {
namespace {

constexpr double millimetre = 1e-3;

void check_input(const TriangleMesh& body, std::span<const Sphere> spheres) {
    if (body.empty()) throw bad_input("the body to draw has no triangles");
    if (spheres.empty()) throw bad_input("the clump to draw has no spheres");
}

/// Round, the same on both sides of zero, and wide enough for all but the largest 0.2 % of the visible distances [mm].
ColourBar bar_of(const std::vector<double>& visible, const std::optional<ValueRange>& wanted) {
    ColourBar bar;
    bar.map = ColourMap::diverging;
    bar.label = "distance (mm)";
    if (wanted) {
        bar.range = {wanted->lower / millimetre, wanted->upper / millimetre};
    } else {
        std::vector<double> sizes;
        for (const double value : visible) sizes.push_back(std::abs(value));
        std::sort(sizes.begin(), sizes.end());
        const double largest = sizes.empty() ? 0.0 : sizes[static_cast<std::size_t>(0.998 * static_cast<double>(sizes.size() - 1))];
        const double end = largest > 0.0 ? round_up(largest) : 1.0;
        bar.range = {-end, end};
    }
    for (const double value : visible) {
        bar.some_below |= value < bar.range.lower;
        bar.some_above |= value > bar.range.upper;
    }
    return bar;
}

/// Vertices that a far camera looking along `forward` sees: they face it and no other sphere stands in the way.
std::vector<bool> seen_along(const Vec3& forward, std::span<const Sphere> spheres, const detail::ShowingSurface& surface) {
    std::vector<bool> seen(surface.mesh.vertices.size(), false);
    for (std::size_t i = 0; i < seen.size(); ++i) {
        const Vec3& p = surface.mesh.vertices[i];
        bool free = surface.normals[i].dot(forward) < 0.0;
        for (std::size_t s = 0; free && s < spheres.size(); ++s) {
            if (s == surface.sphere[i]) continue;
            const Vec3 to_centre = spheres[s].centre - p;
            const double along = -to_centre.dot(forward);  // towards the camera
            const double square = to_centre.squaredNorm(), beside = square - along * along, radius = spheres[s].radius;
            free = square > radius * radius && (along <= 0.0 || beside >= radius * radius);
        }
        seen[i] = free;
    }
    return seen;
}

SceneObject one_of(TriangleMesh mesh, const Vec3& place) {
    SceneObject object;
    object.mesh = std::move(mesh);
    object.poses = {{place, Quat::Identity()}};
    object.colours = {linear_colour({196, 203, 210})};
    return object;
}

/// `distance`: one a vertex of the surface.
Image draw_clump(const TriangleMesh& body, std::span<const Sphere> spheres_mesh, const detail::ShowingSurface& surface, std::span<const double> distance,
                 const PictureSettings& settings) {
    const detail::Page page(settings.width);
    // Both stand on one ground, left and right of the picture's middle, seen from the same side.
    constexpr double elevation = 0.42, heading = 0.5, field_of_view = 0.12;  // [rad]
    const Vec3 forward(std::cos(elevation) * std::sin(heading), std::cos(elevation) * std::cos(heading), -std::sin(elevation));
    const std::vector<bool> seen = seen_along(forward, spheres_mesh, surface);
    std::vector<double> visible;  // [mm]
    for (std::size_t i = 0; i < seen.size(); ++i)
        if (seen[i]) visible.push_back(distance[i] / millimetre);
    const ColourBar bar = bar_of(visible, settings.range);

    const Vec3 right = forward.cross(Vec3::UnitZ()).normalized();
    const Box body_box = bounding_box(body), clump_box = bounding_box(surface.mesh);
    const Vec3 centre = body_box.merged(clump_box).center();
    double half_width = 0.0;
    for (const Vec3& vertex : body.vertices) half_width = std::max(half_width, std::abs((vertex - centre).dot(right)));
    for (const Vec3& vertex : surface.mesh.vertices) half_width = std::max(half_width, std::abs((vertex - centre).dot(right)));
    const Vec3 body_place = -1.35 * half_width * right;
    const Vec3 clump_place = 1.35 * half_width * right + (body_box.min().z() - clump_box.min().z()) * Vec3::UnitZ();

    Scene scene;
    scene.objects.push_back(one_of(body, body_place));
    scene.objects.push_back(one_of(surface.mesh, clump_place));
    scene.objects.back().vertex_normals = surface.normals;
    for (const double value : distance) scene.objects.back().vertex_colours.push_back(map_colour(bar.map, bar.range.fraction(value / millimetre)));
    scene.ground = true;
    scene.ground_level = body_box.min().z();

    std::vector<Vec3> outline;
    for (const Vec3& vertex : body.vertices) outline.push_back(vertex + body_place);
    for (const Vec3& vertex : surface.mesh.vertices) outline.push_back(vertex + clump_place);
    const double column = colour_bar_width(bar, page.bar_width, page.text) + 2.0 * page.margin;
    const double head = 2.0 * page.margin + page.title.cap_height, foot = 1.6 * page.margin + 2.0 * page.text.cap_height;
    const double width = settings.width - column - 2.0 * page.margin;
    const double wanted = width * detail::aspect(outline, forward, Vec3::UnitZ()) + head + foot;
    const auto height = static_cast<std::uint32_t>(std::lround(std::clamp(wanted, 0.3 * settings.width, 1.2 * settings.width)));
    const detail::Viewport viewport{page.margin, head, page.margin + width, height - foot};
    const Camera camera = detail::fit_camera(outline, forward, Vec3::UnitZ(), field_of_view, settings.width, height, viewport);
    Image image = render(scene, camera, settings.width, height, settings.samples);

    TextStyle caption = page.text;
    caption.align = Align::centre;
    const double baseline = height - 0.9 * page.margin;
    const detail::CameraRays rays(camera, settings.width, height);
    draw_text(image, (*rays.project(centre + body_place))[0], baseline, "body", caption);
    const std::string count = std::to_string(spheres_mesh.size()) + (spheres_mesh.size() == 1 ? " sphere" : " spheres");
    draw_text(image, (*rays.project(centre + clump_place))[0], baseline, "clump of " + count, caption);
    if (settings.title) draw_text(image, page.margin, page.margin + page.title.cap_height, *settings.title, page.title);
    const double bar_height = std::min(0.55 * height, 420.0 * page.unit);
    draw_colour_bar(image, bar, settings.width - column + page.margin, 0.5 * (height - bar_height) + page.text.cap_height, page.bar_width, bar_height,
                    page.text);
    return image;
}

}  // namespace

Image picture_of_clump(const TriangleMesh& body, std::span<const Sphere> spheres_mesh, std::span<const double> union_vertex_distance,
                       const PictureSettings& settings) {
    check_input(body, spheres_mesh);
    const std::size_t wanted = sphere_surfaces(spheres_mesh).vertices.size();
    if (union_vertex_distance.size() != wanted)
        throw bad_input("the clump to draw has " + std::to_string(wanted) + " surface points, but " + std::to_string(union_vertex_distance.size()) +
                        " distances");
    const detail::ShowingSurface surface = detail::showing_surface(spheres_mesh);
    std::vector<double> distance;
    for (const std::size_t number : surface.number) distance.push_back(union_vertex_distance[number]);
    return draw_clump(body, spheres_mesh, surface, distance, settings);
}

Image picture_of_clump(const TriangleMesh& body, std::span<const Sphere> spheres_mesh,
                       const std::function<std::vector<double>(std::span<const Vec3>)>& signed_distance, const PictureSettings& settings) {
    check_input(body, spheres_mesh);
    const detail::ShowingSurface surface = detail::showing_surface(spheres_mesh);
    const std::vector<double> distance = signed_distance(surface.mesh.vertices);
    if (distance.size() != surface.mesh.vertices.size())
        throw bad_input("the distance query gave " + std::to_string(distance.size()) + " numbers for " + std::to_string(surface.mesh.vertices.size()) +
                        " points");
    return draw_clump(body, spheres_mesh, surface, distance, settings);
}

}  // namespace pelletlab::report
