#include "report/render.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "report/detail/lighting.hpp"
#include "report/image.hpp"
#include "small_scenes.hpp"

namespace pelletlab::report {
namespace {

using testing::box;
using testing::parallel_camera;
using testing::pixel;
using testing::pixels_unlike;

constexpr Srgb white = {255, 255, 255};
constexpr Colour blue = {0.05f, 0.1f, 0.6f}, red = {0.6f, 0.05f, 0.02f};

SceneObject mesh_at(TriangleMesh mesh, const Vec3& place, const Colour& colour = blue) {
    SceneObject object;
    object.mesh = std::move(mesh);
    object.poses = {{place, Quat::Identity()}};
    object.colours = {colour};
    return object;
}

SceneObject sphere_at(const Vec3& place, double radius, const Colour& colour = blue) {
    SceneObject object;
    object.spheres = {{Vec3::Zero(), radius}};
    object.poses = {{place, Quat::Identity()}};
    object.colours = {colour};
    return object;
}

Scene scene_of(std::vector<SceneObject> objects) {
    Scene scene;
    scene.objects = std::move(objects);
    return scene;
}

// One ray a pixel at a random place in it: only the 2πR pixels on the rim are uncertain, each by less than 1/2, so the standard deviation of the
// area is below sqrt(2πR)/2 pixels; the tolerance is five times that.
double rim_tolerance(double radius_pixels) {
    return 2.5 * std::sqrt(2.0 * std::numbers::pi * radius_pixels);
}

TEST(Render, SilhouetteOfASphereInParallelProjection) {
    const double radius = 0.0017, height = 0.004;
    const std::uint32_t size = 400;
    const Image image = render(scene_of({sphere_at({0.0001, 0.0, -0.0002}, radius)}), parallel_camera(height), size, size, 1);
    const double pixels = radius / height * size;
    EXPECT_NEAR(static_cast<double>(pixels_unlike(image, white)), std::numbers::pi * pixels * pixels, rim_tolerance(pixels));
}

TEST(Render, SilhouetteOfASphereInPerspective) {
    const double radius = 1.0, distance = 3.0, field_of_view = 0.9;
    const std::uint32_t size = 400;
    const Camera camera{{0.0, -distance, 0.0}, Vec3::Zero(), Vec3::UnitZ(), field_of_view, 0.0};
    const Image image = render(scene_of({sphere_at(Vec3::Zero(), radius)}), camera, size, size, 1);
    // The cone that touches the sphere has sin(half angle) = r/d.
    const double pixels = std::tan(std::asin(radius / distance)) / std::tan(0.5 * field_of_view) * 0.5 * size;
    EXPECT_NEAR(static_cast<double>(pixels_unlike(image, white)), std::numbers::pi * pixels * pixels, rim_tolerance(pixels));
}

TEST(Render, ParallelProjectionIsExactToThePixel) {
    // 1 pixel = 0.1 mm; the box covers columns 30 … 69 and rows 20 … 59 exactly, all sixteen rays of each pixel.
    const Scene scene = scene_of({mesh_at(box({-2e-3, -1e-3, -1e-3}, {2e-3, 1e-3, 3e-3}), Vec3::Zero())});
    const Image image = render(scene, parallel_camera(10e-3), 100, 100, 16);
    for (std::size_t y = 0; y < 100; ++y)
        for (std::size_t x = 0; x < 100; ++x) {
            const bool inside = x >= 30 && x < 70 && y >= 20 && y < 60;
            if (inside)
                ASSERT_LT(pixel(image, x, y)[0], 100) << x << ", " << y;
            else
                ASSERT_EQ(pixel(image, x, y), white) << x << ", " << y;
        }
}

TEST(Render, PosesTurnAndMoveInstances) {
    SceneObject bar = mesh_at(box({-4e-3, -1e-3, -1e-3}, {4e-3, 1e-3, 1e-3}), {-10e-3, 0.0, 0.0});
    bar.poses.push_back({{10e-3, 0.0, 5e-3}, Quat(Eigen::AngleAxisd(0.5 * std::numbers::pi, Vec3::UnitY()))});
    bar.colours.push_back(red);
    const Image image = render(scene_of({bar}), parallel_camera(40e-3), 400, 400, 4);  // 0.1 mm a pixel
    std::size_t bluish = 0, reddish = 0;
    for (std::size_t y = 0; y < 400; ++y)
        for (std::size_t x = 0; x < 400; ++x) {
            const auto p = pixel(image, x, y);
            if (p == white) continue;
            const bool lying = x >= 60 && x < 140 && y >= 190 && y < 210, standing = x >= 290 && x < 310 && y >= 110 && y < 190;
            ASSERT_TRUE(lying || standing) << x << ", " << y;
            bluish += p[2] > p[0];
            reddish += p[0] > p[2];
        }
    EXPECT_EQ(bluish, 1600u);
    EXPECT_EQ(reddish, 1600u);
}

TEST(Render, NearerThingsHideFartherOnes) {
    const Scene scene = scene_of({sphere_at({0.0, 0.0, 0.0}, 1.0, blue), sphere_at({0.0, -3.0, 0.0}, 0.5, red)});
    const Image image = render(scene, parallel_camera(4.0), 100, 100, 4);
    EXPECT_GT(pixel(image, 50, 50)[0], pixel(image, 50, 50)[2]);
    EXPECT_GT(pixel(image, 50, 30)[2], pixel(image, 50, 30)[0]);
}

TEST(Render, ASurfaceFacingTheCameraShowsItsOwnColour) {
    const Colour own = {0.2f, 0.4f, 0.6f};
    const Image image = render(scene_of({mesh_at(box({-1.0, -0.1, -1.0}, {1.0, 0.1, 1.0}), Vec3::Zero(), own)}), parallel_camera(1.0), 20, 20, 16);
    const Colour shown = linear_colour(pixel(image, 10, 10));
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(shown[k] / own[k], 1.0, 0.1);  // what Lighting promises: «nearly its own colour»
}

TEST(Render, VertexColoursAreInterpolated) {
    SceneObject plate = mesh_at(box({-1.0, -0.1, -1.0}, {1.0, 0.1, 1.0}), Vec3::Zero());
    for (const Vec3& vertex : plate.mesh.vertices) plate.vertex_colours.push_back(vertex.x() < 0.0 ? Colour{0.0f, 0.0f, 0.0f} : Colour{0.8f, 0.8f, 0.8f});
    const Image image = render(scene_of({plate}), parallel_camera(2.0), 100, 100, 4);
    const auto light = [&image](std::size_t x) { return static_cast<double>(linear_colour(pixel(image, x, 50))[1]); };
    EXPECT_LT(light(5), light(30));
    EXPECT_LT(light(30), light(60));
    EXPECT_NEAR(light(50) / light(99), 0.5, 0.05);
}

TEST(Render, GlassDarkensALittleAndLeavesPelletsVisible) {
    SceneObject pane = mesh_at(box({-1.0, -2.0, -1.0}, {1.0, -1.9, 1.0}), Vec3::Zero());
    pane.glass = true;
    pane.colours.clear();
    const std::vector<SceneObject> without = {sphere_at(Vec3::Zero(), 0.5)};
    std::vector<SceneObject> with = without;
    with.push_back(pane);
    const Image clear = render(scene_of(without), parallel_camera(4.0), 100, 100, 16), glazed = render(scene_of(with), parallel_camera(4.0), 100, 100, 16);
    EXPECT_EQ(pixel(clear, 30, 30), white);
    EXPECT_LT(pixel(glazed, 30, 30)[0], 255);  // paper behind glass
    EXPECT_GT(pixel(glazed, 30, 30)[0], 230);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(pixel(glazed, 50, 50)[k], pixel(clear, 50, 50)[k], 25);
    std::size_t edge = 0;  // the pane's border, at pixels 25 and 75, is drawn as a line
    for (std::size_t x = 22; x < 29; ++x) edge += pixel(glazed, x, 50)[0] < 215;
    EXPECT_GE(edge, 1u);
    EXPECT_EQ(pixel(glazed, 10, 50), white);
}

TEST(Render, ThingsShadeTheInvisibleGround) {
    Scene scene = scene_of({sphere_at({0.0, 0.0, 1.0}, 1.0)});
    scene.ground = true;
    const Camera camera{{0.0, -8.0, 6.0}, {0.0, 0.0, 0.5}, Vec3::UnitZ(), 0.4, 0.0};
    const Image image = render(scene, camera, 160, 120, 16);
    const Image bare = render(scene_of(scene.objects), camera, 160, 120, 16);
    std::size_t shaded = 0;
    for (std::size_t i = 0; i < image.rgb.size(); i += 3) shaded += bare.rgb[i] == 255 && image.rgb[i] < 220;
    EXPECT_GT(shaded, 300u);
    EXPECT_GE(pixel(image, 2, 2)[0], 250);  // far away the paper stays white
}

Scene many_things() {
    const testing::Bed bed = testing::bed_in_tube(150);
    SceneObject pellets;
    pellets.mesh = bed.header.shapes[0].surface_body;
    pellets.spheres = {{{0.0, 0.0, 0.002}, 0.001}};
    for (std::size_t i = 0; i < bed.frame.positions.size(); ++i) {
        pellets.poses.push_back({bed.frame.positions[i], bed.frame.orientations[i]});
        pellets.colours.push_back(mix(blue, red, static_cast<double>(i) / 150.0));
    }
    Scene scene = scene_of({pellets});
    for (const WallShape& wall : bed.header.walls) {
        scene.objects.push_back(mesh_at(wall.mesh, Vec3::Zero()));
        scene.objects.back().glass = true;
    }
    scene.ground = true;
    return scene;
}

TEST(Render, BytesDoNotDependOnTheNumberOfThreads) {
    const Scene scene = many_things();
    const Camera camera{{0.0, -0.12, 0.04}, {0.0, 0.0, 0.01}, Vec3::UnitZ(), 0.4, 0.0};
    const int before = thread_count();
    std::vector<Image> images;
    for (const int threads : {1, 2, 3}) {
        set_thread_count(threads);
        images.push_back(render(scene, camera, 230, 300, 8));  // more rows than one band holds
    }
    set_thread_count(before);
    EXPECT_EQ(images[0].rgb, images[1].rgb);
    EXPECT_EQ(images[0].rgb, images[2].rgb);
}

TEST(Render, MoreSamplesConvergeToTheSamePicture) {
    const Scene scene = many_things();
    const Camera camera{{0.0, -0.12, 0.04}, {0.0, 0.0, 0.01}, Vec3::UnitZ(), 0.4, 0.0};
    const Image few = render(scene, camera, 80, 60, 16), many = render(scene, camera, 80, 60, 256);
    double difference = 0.0;
    for (std::size_t i = 0; i < few.rgb.size(); ++i) difference += std::abs(few.rgb[i] - many.rgb[i]);
    // 256 rays are sixteen packets with hardly any noise, so this bounds the noise of the default 16: 2 of 255 on average.
    EXPECT_LT(difference / static_cast<double>(few.rgb.size()), 2.0);
    EXPECT_GT(difference, 0.0);
}

TEST(Render, AConvexBodyWithFacetsCastsNoShadowOnItself) {
    // A lone cylinder of 16 facets with smooth normals: everywhere the full key light and the full open sky, as for the round cylinder.
    const float grey = 0.5f;
    const Camera camera = parallel_camera(2.0);
    const Image image = render(scene_of({mesh_at(testing::cylinder(2.0, 6.0, 16), Vec3::Zero(), {grey, grey, grey})}), camera, 200, 200, 64);
    detail::Lighting light = detail::studio(camera);
    for (std::size_t x = 10; x < 190; ++x) {
        const double across = (static_cast<double>(x) - 99.5) / 100.0;
        const detail::Vec3f normal = Vec3(across, -std::sqrt(1.0 - across * across), 0.0).cast<float>();
        const float towards_key = std::max(0.0f, normal.dot(light.to_key));
        const float half_way = normal.dot((light.to_key - detail::Vec3f::UnitY()).normalized());
        const float expected = grey * (light.key_strength * towards_key + detail::open_sky(light, normal)) +
                               (towards_key > 0.0f ? light.gloss * std::pow(std::max(0.0f, half_way), 32.0f) : 0.0f);
        double shown = 0.0;
        for (std::size_t y = 80; y < 120; ++y) shown += pixel(image, x, y)[1] / 40.0;
        // The polygon's normals turn by up to 0.5° less or more than the circle's, and its width is 2 % less: 2 of 255.
        EXPECT_NEAR(shown, 255.0 * srgb_from_linear(static_cast<double>(expected)), 2.0) << x;
    }
}

TEST(Render, RefusesWhatCannotBeDrawn) {
    const Camera camera = parallel_camera(1.0);
    const Scene good = scene_of({sphere_at(Vec3::Zero(), 0.1)});
    EXPECT_THROW(render({}, camera, 10, 10), Error);
    EXPECT_THROW(render(good, camera, 0, 10), Error);
    EXPECT_THROW(render(good, camera, 10, 0), Error);
    EXPECT_THROW(render(good, camera, 10, 10, 0), Error);
    Scene bad = good;
    bad.objects[0].poses.clear();
    bad.objects[0].colours.clear();
    EXPECT_THROW(render(bad, camera, 10, 10), Error);  // nothing left to draw
    bad = good;
    bad.objects[0].colours.clear();
    EXPECT_THROW(render(bad, camera, 10, 10), Error);
    bad = good;
    bad.objects[0].spheres[0].radius = -1.0;
    EXPECT_THROW(render(bad, camera, 10, 10), Error);
    bad = good;
    bad.objects[0].poses[0].position.x() = std::nan("");
    EXPECT_THROW(render(bad, camera, 10, 10), Error);
    bad = scene_of({mesh_at(box({0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}), Vec3::Zero())});
    bad.objects[0].mesh.faces[0][0] = 99;
    EXPECT_THROW(render(bad, camera, 10, 10), Error);
    bad = scene_of({mesh_at(box({0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}), Vec3::Zero())});
    bad.objects[0].vertex_colours.resize(3);
    EXPECT_THROW(render(bad, camera, 10, 10), Error);
}

TEST(Render, SlowGradientsAreDitheredAndWholeBytesAreNot) {
    Scene scene = scene_of({sphere_at(Vec3::Zero(), 0.1)});
    const auto mean_of_corner = [&scene](double level) {
        const auto grey = static_cast<float>(linear_from_srgb(level / 255.0));
        scene.background = {grey, grey, grey};
        const Image image = render(scene, parallel_camera(4.0), 200, 200, 1);
        double sum = 0.0;
        for (std::size_t y = 0; y < 64; ++y)
            for (std::size_t x = 0; x < 64; ++x) sum += pixel(image, x, y)[1];
        return sum / 4096.0;
    };
    EXPECT_NEAR(mean_of_corner(100.5), 100.5, 0.03);  // even pattern of 4096 pixels: a few hundredths of a level
    EXPECT_NEAR(mean_of_corner(200.25), 200.25, 0.03);
    EXPECT_DOUBLE_EQ(mean_of_corner(255.0), 255.0);
}

TEST(Render, TriangleWithoutAreaDoesNoHarm) {
    TriangleMesh mesh = box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
    mesh.faces.push_back({0, 0, 1});
    const Image image = render(scene_of({mesh_at(mesh, Vec3::Zero())}), parallel_camera(2.0), 40, 40, 4);
    EXPECT_EQ(pixels_unlike(image, white), 400u);
}

}  // namespace
}  // namespace pelletlab::report
