// The inside of beds whose geometry is a formula: clipped volumes, plate, orientation, overlaps.
#include <gtest/gtest.h>

#include "observables/bed.hpp"
#include "observables/detail/clipped_volume.hpp"
#include "observables/detail/convex_overlap.hpp"
#include "tests/unit/observables/documented.hpp"
#include "tests/unit/observables/synthetic.hpp"

using namespace pelletlab;
using namespace pelletlab::observables;
using namespace pelletlab::synthetic;

namespace {

const Observable& find(const Observables& observables, const std::string& name) {
    for (const Observable& o : observables.values)
        if (o.name == name) return o;
    throw std::runtime_error("no observable " + name);
}

std::vector<double> clip(const PelletShape& pellet, const Frame& frame, const detail::TubeCells& cells) {
    const Trajectory trajectory = trajectory_of(pellet, {frame});
    std::vector<std::size_t> bodies;
    for (std::size_t k = 0; k < frame.positions.size(); ++k) bodies.push_back(k);
    return detail::clipped_volumes(trajectory.head, frame, bodies, cells);
}

/// Area of the square |x|, |y| ≤ a inside a circle of radius r about its centre.
double square_in_circle(double a, double r) {
    if (r <= a) return pi * r * r;
    if (r >= a * std::sqrt(2.0)) return 4.0 * a * a;
    const double beyond = r * r * std::acos(a / r) - a * std::sqrt(r * r - a * a);  // one segment
    return pi * r * r - 4.0 * beyond;
}

}  // namespace

TEST(ClippedVolume, BoxInRingsAndSlices) {
    // A box 4 × 4 × 2 mm around the axis, z from 1 to 3 mm.
    Frame frame;
    add_body(frame, {0.0, 0.0, 2e-3});
    const detail::TubeCells cells{{0.0, 1e-3, 2e-3, 2.5e-3, 5e-3}, {0.0, 0.5e-3, 1.25e-3, 2.75e-3, 4e-3}};
    const std::vector<double> volume = clip(box_pellet(2e-3, 1e-3), frame, cells);
    const double thickness[] = {0.0, 0.25e-3, 1.5e-3, 0.25e-3};
    for (std::size_t slice = 0; slice < 4; ++slice)
        for (std::size_t ring = 0; ring < 4; ++ring) {
            const double area = square_in_circle(2e-3, cells.radii[ring + 1]) - square_in_circle(2e-3, cells.radii[ring]);
            EXPECT_NEAR(volume[cells.index(ring, slice)], area * thickness[slice], 1e-12 * 32e-9) << ring << " " << slice;
        }
}

TEST(ClippedVolume, SphereInACoaxialCylinder) {
    // V(ρ < r) = 4π/3 (R³ − (R² − r²)^(3/2)); the polyhedron of 2048 faces differs by less than 0.3 % of the whole in any part.
    const double big = 2e-3;
    Frame frame;
    add_body(frame, {0.0, 0.0, 5e-3});
    const detail::TubeCells cells{{0.0, 0.5e-3, 1.0e-3, 1.5e-3, 3e-3}, {0.0, 10e-3}};
    const std::vector<double> volume = clip(sphere_pellet(big), frame, cells);
    const double whole = 4.0 / 3.0 * pi * big * big * big;
    const auto within = [&](double r) { return r >= big ? whole : 4.0 / 3.0 * pi * (big * big * big - std::pow(big * big - r * r, 1.5)); };
    double sum = 0.0;
    for (std::size_t ring = 0; ring < 4; ++ring) {
        EXPECT_NEAR(volume[ring], within(cells.radii[ring + 1]) - within(cells.radii[ring]), 0.003 * whole) << ring;
        sum += volume[ring];
    }
    EXPECT_NEAR(sum, whole, 1e-12 * whole) << "its volume is exact";
}

TEST(ClippedVolume, TiltedBoxesKeepTheirVolumeWhereverTheCutsLie) {
    Frame frame;
    RandomStream random(1, 0);
    for (int k = 0; k < 40; ++k) add_body(frame, {random.uniform(-8e-3, 8e-3), random.uniform(-8e-3, 8e-3), random.uniform(3e-3, 20e-3)}, random.rotation());
    detail::TubeCells fine, coarse{{0.0, 20e-3}, {0.0, 25e-3}};
    for (int k = 0; k <= 37; ++k) fine.radii.push_back(20e-3 * k / 37.0);
    for (int k = 0; k <= 61; ++k) fine.heights.push_back(25e-3 * k / 61.0);
    const std::vector<double> parts = clip(box_pellet(2e-3, 1e-3), frame, fine);
    double sum = 0.0, smallest = 0.0;
    for (const double part : parts) {
        sum += part;
        smallest = std::min(smallest, part);
    }
    EXPECT_NEAR(sum, 40 * 32e-9, 1e-11 * 40 * 32e-9);
    EXPECT_NEAR(clip(box_pellet(2e-3, 1e-3), frame, coarse)[0], 40 * 32e-9, 1e-11 * 40 * 32e-9);
    EXPECT_GE(smallest, -1e-11 * 32e-9);
    // What lies above the last slice fills it but is not counted.
    const detail::TubeCells low{{0.0, 20e-3}, {0.0, 8e-3, 9e-3}};
    double below = 0.0;
    for (std::size_t slice = 0; slice < fine.slices(); ++slice)
        for (std::size_t ring = 0; ring < fine.rings(); ++ring)
            if (fine.heights[slice + 1] <= 8e-3 + 1e-12) below += parts[fine.index(ring, slice)];
    const double in_first = clip(box_pellet(2e-3, 1e-3), frame, low)[0];
    EXPECT_GT(in_first, below);
    EXPECT_LT(in_first, below + pi * 400e-6 * 25e-3 / 61.0);
}

TEST(BedStructure, BricksFillTheirTube) {
    // A wall of bricks without gaps, wider than the tube: rings away from the wall are full to rounding, slices above the bed are empty.
    Frame frame;
    for (int layer = 0; layer < 5; ++layer)
        for (int i = -10; i <= 10; ++i)
            for (int j = -10; j <= 10; ++j) add_body(frame, {i * 2e-3, j * 2e-3, (layer + 0.5) * 1e-3});
    const Observables bed = measure_tube_bed(trajectory_of(box_pellet(1e-3, 0.5e-3), {frame}), {20e-3, 0.0, 1e-3});
    expect_documented(bed);
    const Profile &axial = bed.profiles[0], &radial = bed.profiles[1];
    ASSERT_EQ(radial.name, "packing_fraction_radial");
    for (std::size_t k = 0; k < radial.axis.size(); ++k) {
        if (radial.axis[k] < 18.0) {
            EXPECT_NEAR(radial.value[k], 1.0, 1e-9) << radial.axis[k];
        }
    }
    for (std::size_t k = 0; k < axial.axis.size(); ++k) {
        if (axial.axis[k] > 4.8 && axial.axis[k] < 5.2) continue;
        EXPECT_NEAR(axial.value[k], axial.axis[k] < 5.0 ? axial.value[0] : 0.0, 1e-9);
    }
    EXPECT_NEAR(find(bed, "packing_fraction_core_clipped").value, axial.value[0], 1e-9);
    EXPECT_NEAR(find(bed, "packing_fraction_interior").value, 1.0, 1e-3);  // rings that straddle the layer's edge count by their middle
    EXPECT_NEAR(find(bed, "bed_height_plate").value, 5.0, 1e-9);
    EXPECT_NEAR(find(bed, "plate_tilt").value, 0.0, 1e-9);
    EXPECT_NEAR(find(bed, "wall_layer_axis_alignment").value, 1.0, 1e-12);
    EXPECT_NEAR(find(bed, "wall_layer_axis_radial").value, 0.0, 1e-12);
    // Bricks share faces and fill no common volume; those across the wall stick out.
    EXPECT_NEAR(find(bed, "true_overlap_volume_share").value, 0.0, 1e-9);
    EXPECT_GT(find(bed, "wall_overlap_volume_share").value, 0.01);
}

TEST(ConvexOverlap, BoxesAlongAnAxisAndTurned) {
    const PelletShape box = box_pellet(1.0, 0.5);
    ASSERT_TRUE(detail::is_convex(box.surface_body, 1e-9));
    const detail::ConvexBody body = detail::convex_body(box.surface_body);
    EXPECT_EQ(body.planes.size(), 6u);
    // Shifted by 0.9 upward and 0.3 sideways: 0.1 deep, common volume 1.7 · 2 · 0.1.
    const detail::ConvexBody above = detail::moved(body, {Vec3(0.3, 0.0, 0.9), Quat::Identity()});
    EXPECT_NEAR(detail::penetration(body, above, 0.1), 0.1, 1e-3);
    EXPECT_NEAR(detail::common_volume(body, above), 1.7 * 2.0 * 0.1, 1e-12);
    // Turned by 45° about y, the edge of the upper box digs 0.2 into the face: a prism of cross-section 0.2² and length 2.
    const Quat turn(Eigen::AngleAxisd(0.25 * pi, Vec3::UnitY()));
    const double reach = 1.5 / std::sqrt(2.0);  // of the lowest edge below the centre
    const detail::ConvexBody edge = detail::moved(body, {Vec3(-0.5 / std::sqrt(2.0), 0.0, 0.5 - 0.2 + reach), turn});
    EXPECT_NEAR(detail::penetration(body, edge, 0.1), 0.2, 2e-3);
    EXPECT_NEAR(detail::common_volume(body, edge), 0.04 * 2.0, 1e-12);
    // Apart by 0.3 along the diagonal: the gap is certain beyond 0.1 and the search stops.
    const detail::ConvexBody apart = detail::moved(body, {Vec3(2.3, 0.0, 0.0), Quat::Identity()});
    EXPECT_LT(detail::penetration(body, apart, 0.1), -0.1);
    EXPECT_NEAR(detail::penetration(body, apart, 1.0), -0.3, 1e-3);
    EXPECT_NEAR(detail::common_volume(body, apart), 0.0, 1e-15);
}

TEST(BedStructure, OverlapsOfSpheresAreTheirLenses) {
    // Two spheres of 2 mm radius, 3.6 mm apart, standing in the middle of the tube; a third sticks 0.3 mm into the floor.
    const double r = 2e-3;
    Frame frame;
    add_body(frame, {0.0, 0.0, r});
    add_body(frame, {3.6e-3, 0.0, r});
    add_body(frame, {-8e-3, 0.0, r - 0.3e-3});
    const Observables bed = measure_tube_bed(trajectory_of(sphere_pellet(r), {frame}), {20e-3, 0.0, 1e-3});
    EXPECT_NEAR(find(bed, "true_overlap_depth_max").value, 0.4, 1e-9);
    const double lens = pi * 0.4e-3 * 0.4e-3 * (3.6e-3 * 3.6e-3 + 4.0 * r * 3.6e-3) / (12.0 * 3.6e-3), whole = 3.0 * 4.0 / 3.0 * pi * r * r * r;
    EXPECT_NEAR(find(bed, "true_overlap_volume_share").value, lens / whole, 1e-9);
    EXPECT_NEAR(find(bed, "true_neighbours_per_pellet").value, 2.0 / 3.0, 1e-12);
    EXPECT_NEAR(find(bed, "wall_overlap_depth_max").value, 0.3, 1e-9);
    const double cap = pi * 0.3e-3 * 0.3e-3 * (3.0 * r - 0.3e-3) / 3.0;
    EXPECT_NEAR(find(bed, "wall_overlap_volume_share").value, cap / whole, 3e-3 * cap / whole + 2e-5);  // the polyhedron's cap
}
