#include "observables/detail/clipped_volume.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "core/parallel.hpp"

namespace pelletlab::observables::detail {

namespace {

constexpr int sphere_subdivisions = 4;  // of an octahedron: 8 · 4⁴ faces

double volume_of(const TriangleMesh& mesh) {
    double volume = 0.0;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) volume += mesh.corner(f, 0).dot(mesh.corner(f, 1).cross(mesh.corner(f, 2))) / 6.0;
    return volume;
}

/// Index of the interval of ascending `edges` that holds [low, high] whole; edges.size() when none does.
std::size_t interval_around(const std::vector<double>& edges, double low, double high) {
    const auto upper = static_cast<std::size_t>(std::lower_bound(edges.begin(), edges.end(), high) - edges.begin());
    return upper > 0 && upper < edges.size() && edges[upper - 1] <= low ? upper - 1 : edges.size();
}

/// Octahedron, subdivided onto the sphere, then scaled to the sphere's volume.
TriangleMesh sphere_polyhedron(double radius) {
    TriangleMesh mesh;
    mesh.vertices = {Vec3::UnitX(), -Vec3::UnitX(), Vec3::UnitY(), -Vec3::UnitY(), Vec3::UnitZ(), -Vec3::UnitZ()};
    mesh.faces = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    for (int round = 0; round < sphere_subdivisions; ++round) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        const auto middle = [&](std::uint32_t a, std::uint32_t b) {
            const auto [found, is_new] = middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh.vertices.size()));
            if (is_new) mesh.vertices.push_back((mesh.vertices[a] + mesh.vertices[b]).normalized());
            return found->second;
        };
        std::vector<Triangle> finer;
        for (const auto& [a, b, c] : mesh.faces) {
            const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
        }
        mesh.faces = std::move(finer);
    }
    const double scale = radius * std::cbrt(4.0 / 3.0 * std::numbers::pi / volume_of(mesh));
    for (Vec3& vertex : mesh.vertices) vertex *= scale;
    return mesh;
}

double cross_xy(const Vec3& a, const Vec3& b) {
    return a.x() * b.y() - a.y() * b.x();
}

void add_triangle_part(PlaneMoments& sum, const Vec3& p, const Vec3& q) {
    const double area = 0.5 * cross_xy(p, q);
    sum.area += area;
    sum.x += area * (p.x() + q.x()) / 3.0;
    sum.y += area * (p.y() + q.y()) / 3.0;
}

PlaneMoments whole_polygon(std::span<const Vec3> polygon) {
    PlaneMoments sum;
    for (std::size_t k = 0; k < polygon.size(); ++k) add_triangle_part(sum, polygon[k], polygon[(k + 1) % polygon.size()]);
    return sum;
}

void add_sector(PlaneMoments& sum, const Vec3& p, const Vec3& q, double radius) {
    const double angle = std::atan2(cross_xy(p, q), p.x() * q.x() + p.y() * q.y()), cube = radius * radius * radius / 3.0;
    const double lp = p.head<2>().norm(), lq = q.head<2>().norm();
    sum.area += 0.5 * radius * radius * angle;
    sum.x += cube * (q.y() / lq - p.y() / lp);
    sum.y += cube * (p.x() / lp - q.x() / lq);
}

void add_edge(PlaneMoments& sum, const Vec3& p, const Vec3& q, double radius) {
    const double dx = q.x() - p.x(), dy = q.y() - p.y(), a = dx * dx + dy * dy;
    const double pp = p.x() * p.x() + p.y() * p.y() - radius * radius, b = p.x() * dx + p.y() * dy;
    const double discriminant = b * b - a * pp;
    if (a == 0.0) return;
    if (discriminant <= 0.0) return add_sector(sum, p, q, radius);  // the edge's line misses the circle
    const double root = std::sqrt(discriminant), enter = std::clamp((-b - root) / a, 0.0, 1.0), leave = std::clamp((-b + root) / a, 0.0, 1.0);
    if (!(leave > enter)) return add_sector(sum, p, q, radius);
    const Vec3 in = enter > 0.0 ? Vec3(p + enter * (q - p)) : p, out = leave < 1.0 ? Vec3(p + leave * (q - p)) : q;
    if (enter > 0.0) add_sector(sum, p, in, radius);
    add_triangle_part(sum, in, out);
    if (leave < 1.0) add_sector(sum, out, q, radius);
}

/// The part of a polygon on one side of the plane z = level.
void cut(const std::vector<Vec3>& polygon, double level, bool keep_above, std::vector<Vec3>& part) {
    part.clear();
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        const Vec3 &p = polygon[k], &q = polygon[(k + 1) % polygon.size()];
        const double hp = keep_above ? p.z() - level : level - p.z(), hq = keep_above ? q.z() - level : level - q.z();
        if (hp >= 0.0) part.push_back(p);
        if ((hp > 0.0 && hq < 0.0) || (hp < 0.0 && hq > 0.0)) {
            Vec3 at = p + (q - p) * (hp / (hp - hq));
            at.z() = level;
            part.push_back(at);
        }
    }
}

/// Sums over the cells; `above` is the projected area that lies in a slice (or over the last one): it fills all slices below it.
struct Sums {
    std::vector<double> inside, above;
};

class Clipper {
public:
    Clipper(const TubeCells& cells, Sums& sums) : cells_(cells), sums_(sums) {}

    void add(const Vec3& a, const Vec3& b, const Vec3& c) {
        const Vec3 normal = (b - a).cross(c - a);
        if (std::abs(normal.z()) <= 1e-12 * normal.norm()) return;  // upright: covers no area
        const double slope_x = -normal.x() / normal.z(), slope_y = -normal.y() / normal.z();
        const std::vector<double>& heights = cells_.heights;
        const double low = std::min({a.z(), b.z(), c.z()}), high = std::max({a.z(), b.z(), c.z()});
        if (high <= heights.front()) return;
        triangle_.assign({a, b, c});
        auto slice = static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, std::upper_bound(heights.begin(), heights.end(), low) - heights.begin() - 1));
        for (; slice < heights.size() && (slice == 0 || heights[slice] < high || heights[slice] <= low); ++slice) {
            const std::vector<Vec3>* polygon = &triangle_;
            if (low < heights[slice]) {
                cut(*polygon, heights[slice], true, first_);
                polygon = &first_;
            }
            if (slice + 1 < heights.size() && high > heights[slice + 1]) {
                cut(*polygon, heights[slice + 1], false, second_);
                polygon = &second_;
            }
            if (polygon->size() >= 3) add_to_slice(*polygon, slice, a.z() - heights[slice] - slope_x * a.x() - slope_y * a.y(), slope_x, slope_y);
            if (heights[slice] <= low && (slice + 1 >= heights.size() || high <= heights[slice + 1])) break;  // all of it was in this slice
        }
    }

private:
    /// z − floor of the slice = constant + slope_x x + slope_y y over the polygon.
    void add_to_slice(const std::vector<Vec3>& polygon, std::size_t slice, double constant, double slope_x, double slope_y) {
        Vec3 middle = Vec3::Zero();
        for (const Vec3& p : polygon) middle += p / static_cast<double>(polygon.size());
        double size = 0.0;
        for (const Vec3& p : polygon) size = std::max(size, (p - middle).head<2>().squaredNorm());
        size = std::sqrt(size);
        const double centre = middle.head<2>().norm(), nearest = centre - size, furthest = centre + size;
        const bool beyond = slice + 1 >= cells_.heights.size();
        double inside_before = 0.0, area_before = 0.0;
        // The first circle that holds any of it: the ring inside that circle is the first with a part.
        const auto reached = std::upper_bound(cells_.radii.begin(), cells_.radii.end(), std::max(0.0, nearest)) - cells_.radii.begin();
        for (auto edge = static_cast<std::size_t>(reached); edge < cells_.radii.size(); ++edge) {
            const double radius = cells_.radii[edge];
            const PlaneMoments moments = radius >= furthest ? whole_polygon(polygon) : polygon_in_circle(polygon, radius);
            const double area = moments.area, inside = constant * moments.area + slope_x * moments.x + slope_y * moments.y;
            if (edge > 0) {
                const std::size_t ring = edge - 1;
                if (!beyond) sums_.inside[cells_.index(ring, slice)] += inside - inside_before;
                sums_.above[slice * cells_.rings() + ring] += area - area_before;
            }
            inside_before = inside;
            area_before = area;
            if (radius >= furthest) break;  // further rings hold nothing of it
        }
    }

    const TubeCells& cells_;
    Sums& sums_;
    std::vector<Vec3> triangle_, first_, second_;
};

}  // namespace

PlaneMoments polygon_in_circle(std::span<const Vec3> polygon, double radius) {
    PlaneMoments sum;
    for (std::size_t k = 0; k < polygon.size(); ++k) add_edge(sum, polygon[k], polygon[(k + 1) % polygon.size()], radius);
    return sum;
}

double TubeCells::volume(std::size_t ring, std::size_t slice) const {
    return std::numbers::pi * (radii[ring + 1] * radii[ring + 1] - radii[ring] * radii[ring]) * (heights[slice + 1] - heights[slice]);
}

bool can_be_clipped(const TrajectoryHeader& header) {
    return std::all_of(header.shapes.begin(), header.shapes.end(),
                       [](const PelletShape& shape) { return !shape.surface_body.empty() || shape.rigid.spheres.size() == 1; });
}

std::vector<double> clipped_volumes(const TrajectoryHeader& header, const Frame& frame, std::span<const std::size_t> bodies, const TubeCells& cells) {
    std::vector<TriangleMesh> surfaces;
    std::vector<double> whole, reach;  // volume of each, and distance of its furthest vertex
    for (const PelletShape& shape : header.shapes) {
        surfaces.push_back(shape.surface_body.empty() ? sphere_polyhedron(shape.rigid.spheres.front().radius) : shape.surface_body);
        if (shape.surface_body.empty())
            for (Vec3& vertex : surfaces.back().vertices) vertex += shape.rigid.spheres.front().centre;
        whole.push_back(volume_of(surfaces.back()));
        reach.push_back(0.0);
        for (const Vec3& vertex : surfaces.back().vertices) reach.back() = std::max(reach.back(), vertex.norm());
    }
    const Sums empty{std::vector<double>(cells.cells(), 0.0), std::vector<double>(cells.rings() * (cells.slices() + 1), 0.0)};
    Sums sums = parallel_reduce(
        bodies.size(), std::max<std::size_t>(64, bodies.size() / 16 + 1), empty,
        [&](std::size_t begin, std::size_t end) {
            Sums part = empty;
            Clipper clipper(cells, part);
            std::vector<Vec3> vertices;
            for (std::size_t k = begin; k < end; ++k) {
                const std::size_t body = bodies[k];
                const std::uint32_t shape = header.shape_of_body[body];
                const TriangleMesh& surface = surfaces[shape];
                const Vec3& centre = frame.positions[body];
                const double out = reach[shape], distance = centre.head<2>().norm();
                if (centre.z() + out <= cells.heights.front() || centre.z() - out >= cells.heights.back() || distance - out >= cells.radii.back()) continue;
                // Inside one cell there is nothing to cut.
                const std::size_t ring = interval_around(cells.radii, std::max(0.0, distance - out), distance + out);
                const std::size_t slice = interval_around(cells.heights, centre.z() - out, centre.z() + out);
                if (ring < cells.rings() && slice < cells.slices()) {
                    part.inside[cells.index(ring, slice)] += whole[shape];
                    continue;
                }
                const Mat3 rotation = frame.orientations[body].toRotationMatrix();
                vertices.clear();
                for (const Vec3& vertex : surface.vertices) vertices.push_back(rotation * vertex + frame.positions[body]);
                for (const Triangle& face : surface.faces) clipper.add(vertices[face[0]], vertices[face[1]], vertices[face[2]]);
            }
            return part;
        },
        [](Sums total, const Sums& part) {
            for (std::size_t i = 0; i < total.inside.size(); ++i) total.inside[i] += part.inside[i];
            for (std::size_t i = 0; i < total.above.size(); ++i) total.above[i] += part.above[i];
            return total;
        });
    for (std::size_t ring = 0; ring < cells.rings(); ++ring) {
        double covered = 0.0;  // by what lies above the slice
        for (std::size_t slice = cells.slices(); slice-- > 0;) {
            covered += sums.above[(slice + 1) * cells.rings() + ring];
            sums.inside[cells.index(ring, slice)] += covered * (cells.heights[slice + 1] - cells.heights[slice]);
        }
    }
    return sums.inside;
}

}  // namespace pelletlab::observables::detail
