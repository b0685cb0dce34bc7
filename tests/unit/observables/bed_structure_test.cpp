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

/// A cylinder as a prism of `facets` sides with its vertices on the circle, one of them at x = radius, axis z; its side is meshed in `layers`, which a convex
/// body must not notice.
PelletShape cylinder_pellet(double radius, double height, std::uint32_t facets, std::uint32_t layers = 1) {
    PelletShape shape = box_pellet(radius, 0.5 * height);
    TriangleMesh& mesh = shape.surface_body;
    mesh = {};
    for (std::uint32_t layer = 0; layer <= layers; ++layer)
        for (std::uint32_t k = 0; k < facets; ++k) {
            const double angle = 2.0 * pi * k / facets;
            mesh.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), height * (static_cast<double>(layer) / layers - 0.5));
        }
    for (std::uint32_t k = 0; k < facets; ++k) {
        const std::uint32_t next = (k + 1) % facets, top = layers * facets;
        for (std::uint32_t layer = 0; layer < layers; ++layer) {
            const std::uint32_t low = layer * facets, high = low + facets;
            mesh.faces.push_back({low + k, low + next, high + next});
            mesh.faces.push_back({low + k, high + next, high + k});
        }
        if (k >= 1 && k + 1 < facets) {
            mesh.faces.push_back({0, k + 1, k});
            mesh.faces.push_back({top, top + k, top + k + 1});
        }
    }
    MassProperties& mass = shape.rigid.mass_properties;
    mass.principal_inertia =
        mass.mass * Vec3((3.0 * radius * radius + height * height) / 12.0, (3.0 * radius * radius + height * height) / 12.0, 0.5 * radius * radius);
    mass.volume = 0.5 * facets * std::sin(2.0 * pi / facets) * radius * radius * height;
    shape.rigid.bounding_radius = std::hypot(radius, 0.5 * height);
    return shape;
}

/// Volume of two infinite cylinders of radius r whose axes cross at right angles at distance s: ∫ 2 √(r² − z²) 2 √(r² − (z − s)²) dz, midpoint rule in an
/// angle that takes the roots away.
double crossing_volume(double r, double s) {
    constexpr int steps = 20000;
    const double middle = 0.5 * s, half = r - 0.5 * s;
    double sum = 0.0;
    for (int k = 0; k < steps; ++k) {
        const double t = pi * ((k + 0.5) / steps - 0.5), z = middle + half * std::sin(t);
        sum += 4.0 * std::sqrt(r * r - z * z) * std::sqrt(r * r - (z - s) * (z - s)) * half * std::cos(t) * pi / steps;
    }
    return sum;
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
    EXPECT_EQ(body.faces.size(), 6u);
    EXPECT_EQ(body.vertices.size(), 8u);
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

TEST(ConvexOverlap, CylindersThatCross) {
    // Two cylinders of radius 1 with crossing axes 1.8 apart. Prisms of 256 sides lie within 7.5e-5 of the circle: of a cut 0.2 deep that is 4e-4 a body, and
    // volumes go with the square of the depth.
    const detail::ConvexBody body = detail::convex_body(cylinder_pellet(1.0, 4.0, 256, 5).surface_body);
    EXPECT_EQ(body.faces.size(), 258u);
    EXPECT_EQ(body.vertices.size(), 512u) << "vertices inside edges and faces are left out";
    const Quat along_x(Eigen::AngleAxisd(0.5 * pi, Vec3::UnitY())), along_y(Eigen::AngleAxisd(0.5 * pi, Vec3::UnitX()));
    EXPECT_NEAR(crossing_volume(1.0, 1e-9), 16.0 / 3.0, 1e-6) << "Steinmetz";
    for (const double distance : {1.8, 1.2}) {
        const detail::ConvexBody lower = detail::moved(body, {Vec3::Zero(), along_x}), upper = detail::moved(body, {Vec3(0.3, -0.2, distance), along_y});
        EXPECT_NEAR(detail::penetration(lower, upper, 0.1), 2.0 - distance, 3e-4);
        EXPECT_NEAR(detail::common_volume(lower, upper) / crossing_volume(1.0, distance), 1.0, 2e-3) << distance;
        EXPECT_NEAR(detail::common_volume(lower, upper), detail::common_volume(upper, lower), 1e-12);
    }
    // Whole crossing: prisms of 256 sides hold 1e-4 less than cylinders each.
    EXPECT_NEAR(detail::common_volume(detail::moved(body, {Vec3::Zero(), along_x}), detail::moved(body, {Vec3::Zero(), along_y})), 16.0 / 3.0,
                3e-4 * 16.0 / 3.0);
}

TEST(ConvexOverlap, ACommonFaceCountsOnce) {
    const detail::ConvexBody body = detail::convex_body(cylinder_pellet(1.0, 2.0, 64).surface_body);
    const double area = 32.0 * std::sin(pi / 32.0);
    // Both stand on one plane and share all side planes; one is shifted along its axis.
    EXPECT_NEAR(detail::common_volume(body, body), 2.0 * area, 1e-9);
    EXPECT_NEAR(detail::common_volume(body, detail::moved(body, {Vec3(0.0, 0.0, 0.5), Quat::Identity()})), 1.5 * area, 1e-5 * area);
    // Stacked: they share a face and no volume.
    EXPECT_NEAR(detail::common_volume(body, detail::moved(body, {Vec3(0.0, 0.0, 2.0), Quat::Identity()})), 0.0, 1e-5 * area);
}

TEST(BedStructure, CylindersThroughTheFloorAndTheShell) {
    // Radius 1.5 mm, height 3 mm, in a tube of 26 mm radius: one lies 0.3 mm deep in the floor, one stands 0.25 mm deep in it, one lies along the radius with
    // its flat face 0.4 mm through the shell. Prism of 256 sides: 7.5e-5 of the radius.
    const double r = 1.5e-3, h = 3e-3, tube = 26e-3;
    const Quat lying(Eigen::AngleAxisd(0.5 * pi, Vec3::UnitY()));  // axis along x
    Frame frame;
    add_body(frame, {0.0, 0.0, r - 0.3e-3}, lying);
    add_body(frame, {-8e-3, 0.0, 0.5 * h - 0.25e-3});
    const PelletShape pellet = cylinder_pellet(r, h, 256);
    const double volume = pellet.rigid.mass_properties.volume;
    const double segment = r * r * std::acos(1.0 - 0.3e-3 / r) - (r - 0.3e-3) * std::sqrt(2.0 * r * 0.3e-3 - 0.3e-3 * 0.3e-3);
    Observables bed = measure_tube_bed(trajectory_of(pellet, {frame}), {tube, 0.0, 1e-3});
    EXPECT_NEAR(find(bed, "wall_overlap_depth_max").value, 0.3, 1e-4);
    EXPECT_NEAR(find(bed, "wall_overlap_depth_mean").value, 0.275, 1e-4);
    const double outside = segment * h + 0.25e-3 * volume / h;
    EXPECT_NEAR(find(bed, "wall_overlap_volume_share").value / (outside / (2.0 * volume)), 1.0, 1e-3);
    EXPECT_EQ(find(bed, "true_overlaps_per_pellet").value, 0.0);

    // Through the shell: the corner of the face's height reaches √(x² + r²) − R; beyond the circle lies a volume that the plane through x = R bounds:
    // ∫ over the face of (x_face − √(R² − y²)), where positive.
    Frame outward;
    add_body(outward, {tube + 0.4e-3 - 0.5 * h, 0.0, 5e-3}, lying);
    bed = measure_tube_bed(trajectory_of(pellet, {outward}), {tube, 0.0, 1e-3});
    EXPECT_NEAR(find(bed, "wall_overlap_depth_max").value, (std::hypot(tube + 0.4e-3, r) - tube) * 1e3, 1e-4);
    double beyond = 0.0;
    constexpr int steps = 4000;
    for (int k = 0; k < steps; ++k) {
        const double t = pi * ((k + 0.5) / steps - 0.5), y = r * std::sin(t);
        beyond += 2.0 * std::sqrt(r * r - y * y) * (tube + 0.4e-3 - std::sqrt(tube * tube - y * y)) * r * std::cos(t) * pi / steps;
    }
    EXPECT_NEAR(find(bed, "wall_overlap_volume_share").value / (beyond / volume), 1.0, 1e-3);
}

TEST(BedStructure, UprightCylindersInALatticeShowTheWall) {
    // Cylinders that stand in rings about the axis, touching the wall with the outermost: a ring at distance ρ from the axis of one cylinder of radius r whose
    // axis is at c cuts the arc 2 ρ acos((ρ² + c² − r²) / (2 ρ c)), so packing against radius is a formula. Prism of 256 sides, rings of d/10.
    const double r = 1.5e-3, h = 3e-3, tube = 15e-3;
    Frame frame;
    std::vector<std::pair<double, int>> rings;
    for (double c = tube - r; c > r; c -= 2.0 * r) {
        const int count = static_cast<int>(std::floor(pi / std::asin(r / c)));
        rings.emplace_back(c, count);
        for (int layer = 0; layer < 6; ++layer)
            for (int k = 0; k < count; ++k)
                add_body(frame, {c * std::cos(2.0 * pi * k / count), c * std::sin(2.0 * pi * k / count), (layer + 0.5) * h},
                         Quat(Eigen::AngleAxisd(2.0 * pi * k / count, Vec3::UnitZ())));
    }
    const Observables bed = measure_tube_bed(trajectory_of(cylinder_pellet(r, h, 256), {frame}), {tube, 0.0, 1e-3});
    expect_documented(bed);
    const Profile& radial = bed.profiles[1];
    ASSERT_EQ(radial.name, "packing_fraction_radial");
    const double step = tube / static_cast<double>(radial.axis.size());
    for (std::size_t k = 0; k < radial.axis.size(); ++k) {
        double solid = 0.0;  // area in the ring, by arcs
        constexpr int arcs = 400;
        for (int i = 0; i < arcs; ++i) {
            const double rho = (static_cast<double>(k) + (i + 0.5) / arcs) * step;
            for (const auto& [c, count] : rings)
                if (std::abs(rho - c) < r) solid += count * 2.0 * rho * std::acos((rho * rho + c * c - r * r) / (2.0 * rho * c)) * step / arcs;
        }
        const double inner = static_cast<double>(k) * step, outer = inner + step;
        EXPECT_NEAR(radial.value[k], solid / (pi * (outer * outer - inner * inner)), 2e-3) << radial.axis[k];
    }
    EXPECT_NEAR(find(bed, "wall_layer_axis_alignment").value, 1.0, 1e-12);
    EXPECT_NEAR(find(bed, "true_overlap_volume_share").value, 0.0, 1e-6);
}
