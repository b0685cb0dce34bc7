#include "report/pictures.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"
#include "report/image.hpp"
#include "small_scenes.hpp"

namespace pelletlab::report {
namespace {

using testing::Bed;
using testing::pixel;

constexpr Srgb white = {255, 255, 255};

PictureSettings small_picture() {
    PictureSettings settings;
    settings.width = 300;
    settings.samples = 4;
    return settings;
}

/// Pixels with a clear colour of their own: pellets and the colour bar, not glass, shadows or text.
std::size_t coloured(const Image& image, std::size_t from_x, std::size_t to_x) {
    std::size_t count = 0;
    for (std::size_t y = 0; y < image.height; ++y)
        for (std::size_t x = from_x; x < to_x; ++x) {
            const auto p = pixel(image, x, y);
            count += std::max({p[0], p[1], p[2]}) - std::min({p[0], p[1], p[2]}) > 50;
        }
    return count;
}

std::size_t inked_rows(const Image& image, std::size_t from_y, std::size_t to_y) {
    std::size_t count = 0;
    for (std::size_t y = from_y; y < to_y; ++y)
        for (std::size_t x = 0; x < image.width; ++x) count += pixel(image, x, y)[0] < 150;
    return count;
}

TEST(Pictures, TubeShowsPelletsTitleAndColourBar) {
    const Bed bed = testing::bed_in_tube();
    const Image image = picture_of_tube(bed.header, bed.frame, small_picture());
    EXPECT_EQ(image.width, 300u);
    EXPECT_GT(coloured(image, 30, 225), 3000u);
    EXPECT_GT(coloured(image, 240, 300), 300u);                                  // the bar
    EXPECT_GT(inked_rows(image, 8, 18), 50u);                                    // the title
    for (std::size_t x = 0; x < 300; ++x) EXPECT_EQ(pixel(image, x, 1), white);  // the margin stays free
}

TEST(Pictures, TubeCanShowSpheresOtherValuesAndOtherSides) {
    const Bed bed = testing::bed_in_tube();
    const PictureSettings plain = small_picture();
    const Image usual = picture_of_tube(bed.header, bed.frame, plain);
    PictureSettings spheres = plain;
    spheres.draw_spheres = true;
    EXPECT_NE(picture_of_tube(bed.header, bed.frame, spheres).rgb, usual.rgb);
    PictureSettings turned = plain;
    turned.azimuth = 1.0;
    EXPECT_NE(picture_of_tube(bed.header, bed.frame, turned).rgb, usual.rgb);
    PelletValues values;
    values.label = "contacts";
    for (std::size_t i = 0; i < bed.frame.positions.size(); ++i) values.value.push_back(static_cast<double>(i % 7));
    EXPECT_NE(picture_of_tube(bed.header, bed.frame, values, plain).rgb, usual.rgb);
}

TEST(Pictures, TubeHeightIsColouredOverTheGivenRange) {
    const Bed bed = testing::bed_in_tube();
    PictureSettings settings = small_picture();
    settings.range = ValueRange{0.5, 0.6};  // far above the bed: all pellets take the darkest colour
    const Image image = picture_of_tube(bed.header, bed.frame, settings);
    std::size_t greenish = 0;
    for (std::size_t y = 0; y < image.height; ++y)
        for (std::size_t x = 30; x < 225; ++x) greenish += pixel(image, x, y)[1] > pixel(image, x, y)[2] + 30;
    EXPECT_EQ(greenish, 0u);
}

TEST(Pictures, DrumLooksThroughItsFrontPlate) {
    const Bed bed = testing::bed_in_drum();
    const Image image = picture_of_drum(bed.header, bed.frame, small_picture());
    EXPECT_GT(coloured(image, 10, 225), 2000u);
    EXPECT_GT(coloured(image, 240, 300), 300u);
    Bed open = bed;  // the plate at y = −10 mm, nearest the camera, must not matter
    open.header.walls.pop_back();
    open.frame.wall_poses.pop_back();
    EXPECT_EQ(picture_of_drum(open.header, open.frame, small_picture()).rgb, image.rgb);
    Bed no_back = bed;  // while the other plate does
    no_back.header.walls.erase(no_back.header.walls.begin() + 1);
    no_back.frame.wall_poses.pop_back();
    EXPECT_NE(picture_of_drum(no_back.header, no_back.frame, small_picture()).rgb, image.rgb);
}

TEST(Pictures, DrumIsSeenWithXToTheRight) {
    Bed bed = testing::bed_in_drum(1);
    bed.frame.positions[0] = {0.012, 0.0, 0.0};
    const Image image = picture_of_drum(bed.header, bed.frame, small_picture());
    EXPECT_EQ(coloured(image, 10, 120), 0u);
    EXPECT_GT(coloured(image, 120, 225), 50u);
}

TEST(Pictures, RestingDrumCanBeDrawn) {
    Bed bed = testing::bed_in_drum();
    for (Vec3& velocity : bed.frame.velocities) velocity.setZero();
    EXPECT_NO_THROW(picture_of_drum(bed.header, bed.frame, small_picture()));
}

TEST(Pictures, FramesThatDoNotFitAreRefused) {
    const Bed good = testing::bed_in_drum();
    const PictureSettings settings = small_picture();
    Bed bad = good;
    bad.frame.orientations.pop_back();
    EXPECT_THROW(picture_of_drum(bad.header, bad.frame, settings), Error);
    bad = good;
    bad.frame.velocities.pop_back();
    EXPECT_THROW(picture_of_drum(bad.header, bad.frame, settings), Error);
    bad = good;
    bad.frame.wall_poses.pop_back();
    EXPECT_THROW(picture_of_drum(bad.header, bad.frame, settings), Error);
    EXPECT_THROW(picture_of_tube(bad.header, bad.frame, settings), Error);
    bad = good;
    bad.header.shape_of_body[3] = 5;
    EXPECT_THROW(picture_of_tube(bad.header, bad.frame, settings), Error);
    EXPECT_THROW(picture_of_tube(good.header, Frame{}, settings), Error);
    PictureSettings tiny = settings;
    tiny.width = 50;
    EXPECT_THROW(picture_of_tube(good.header, good.frame, tiny), Error);
}

FieldMap map_of(const char* name, double (*value)(double, double)) {
    FieldMap map;
    map.name = name;
    map.unit = "m/s";
    map.horizontal_axis = "x";
    map.vertical_axis = "z";
    map.spacing = 2e-3;
    map.columns = map.rows = 20;
    map.origin_horizontal = map.origin_vertical = -19e-3;
    map.window = {1.0, 2.0};
    for (std::size_t r = 0; r < map.rows; ++r)
        for (std::size_t c = 0; c < map.columns; ++c) {
            const double x = map.origin_horizontal + map.spacing * static_cast<double>(c), z = map.origin_vertical + map.spacing * static_cast<double>(r);
            map.value.push_back(std::hypot(x, z) < 19e-3 && z < 0.0 ? value(x, z) : not_known);
        }
    return map;
}

Observables flow() {
    Observables observables;
    observables.case_name = "drum";
    observables.maps = {map_of("speed", [](double x, double z) { return 5.0 * std::hypot(x, z); }), map_of("vx", [](double, double z) { return 5.0 * z; }),
                        map_of("vz", [](double x, double) { return -5.0 * x; })};
    return observables;
}

TEST(Pictures, MapShowsCellsBelowAndPaperAbove) {
    PictureSettings settings = small_picture();
    settings.width = 600;
    const Image image = picture_of_map(flow(), "speed", settings);
    std::size_t upper = 0, lower = 0;
    for (std::size_t y = 60; y < image.height - 60; ++y)
        for (std::size_t x = 90; x < 470; ++x) {
            const auto p = pixel(image, x, y);
            (y < image.height / 2 - 10 ? upper : lower) += std::max({p[0], p[1], p[2]}) - std::min({p[0], p[1], p[2]}) > 50;
        }
    EXPECT_EQ(upper, 0u);
    EXPECT_GT(lower, 20000u);
}

TEST(Pictures, MapHasArrowsOnlyWithVelocities) {
    Observables with = flow(), without = flow();
    without.maps.resize(1);
    EXPECT_NE(picture_of_map(with, "speed", small_picture()).rgb, picture_of_map(without, "speed", small_picture()).rgb);
    with.maps[1].spacing *= 2.0;  // another grid: not these arrows
    EXPECT_EQ(picture_of_map(with, "speed", small_picture()).rgb, picture_of_map(without, "speed", small_picture()).rgb);
}

TEST(Pictures, MapDrawsTheDrumWhenItsDiameterIsGiven) {
    PictureSettings settings = small_picture();
    const Image bare = picture_of_map(flow(), "speed", settings);
    settings.circle_diameter = 0.038;
    const Image ringed = picture_of_map(flow(), "speed", settings);
    std::size_t changed = 0;
    for (std::size_t i = 0; i < bare.rgb.size(); ++i) changed += bare.rgb[i] != ringed.rgb[i];
    EXPECT_GT(changed, 300u);
}

TEST(Pictures, UnknownMapNamesTheNearest) {
    try {
        picture_of_map(flow(), "sped", small_picture());
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_NE(error.remedy().find("speed"), std::string::npos);
    }
    Observables broken = flow();
    broken.maps[0].value.pop_back();
    EXPECT_THROW(picture_of_map(broken, "speed", small_picture()), Error);
}

TEST(Pictures, MapWithoutAnyDataStillHasAxes) {
    Observables empty = flow();
    for (double& value : empty.maps[0].value) value = not_known;
    EXPECT_NO_THROW(picture_of_map(empty, "speed", small_picture()));
}

TEST(Pictures, ClumpIsColouredByItsDistance) {
    const TriangleMesh body = testing::cylinder(0.003, 0.003, 32);
    const std::vector<Sphere> spheres = {{{0.0, 0.0, -0.0005}, 0.0012}, {{0.0, 0.0, 0.0005}, 0.0012}};
    const auto constant = [](double value) { return [value](std::span<const Vec3> p) { return std::vector<double>(p.size(), value); }; };
    PictureSettings settings = small_picture();
    settings.range = ValueRange{-1e-4, 1e-4};
    const auto hue = [&](double value) {  // red minus blue over the right half
        const Image image = picture_of_clump(body, spheres, constant(value), settings);
        double sum = 0.0;
        for (std::size_t y = 0; y < image.height; ++y)
            for (std::size_t x = 125; x < 230; ++x) sum += pixel(image, x, y)[0] - pixel(image, x, y)[2];
        return sum;
    };
    EXPECT_GT(hue(1e-4), 1e5);
    EXPECT_LT(hue(-1e-4), -1e5);
    const std::vector<double> all(sphere_surfaces(spheres).vertices.size(), 1e-4);
    EXPECT_EQ(picture_of_clump(body, spheres, all, settings).rgb, picture_of_clump(body, spheres, constant(1e-4), settings).rgb);
}

TEST(Pictures, ClumpAsksOnlyForPointsThatCanShow) {
    const TriangleMesh body = testing::cylinder(0.003, 0.003, 32);
    const std::vector<Sphere> spheres = {{{0.0, 0.0, 0.0}, 0.0012}, {{0.0, 0.0, 0.0}, 0.0005}};  // the second one is hidden in the first
    std::size_t asked = 0;
    picture_of_clump(
        body, spheres,
        [&asked](std::span<const Vec3> p) {
            asked = p.size();
            return std::vector<double>(p.size(), 0.0);
        },
        small_picture());
    EXPECT_EQ(asked, sphere_surfaces(spheres).vertices.size() / 2);
}

TEST(Pictures, ClumpRefusesMissingParts) {
    const TriangleMesh body = testing::cylinder(0.003, 0.003, 32);
    const std::vector<Sphere> spheres = {{{0.0, 0.0, 0.0}, 0.0012}};
    const std::vector<double> short_list(5, 0.0);
    EXPECT_THROW(picture_of_clump(body, spheres, short_list, small_picture()), Error);
    EXPECT_THROW(picture_of_clump(TriangleMesh{}, spheres, short_list, small_picture()), Error);
    EXPECT_THROW(picture_of_clump(body, {}, short_list, small_picture()), Error);
    EXPECT_THROW(picture_of_clump(
                     body, spheres, [](std::span<const Vec3>) { return std::vector<double>(); }, small_picture()),
                 Error);
}

}  // namespace
}  // namespace pelletlab::report
