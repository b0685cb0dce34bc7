#include "shapegen/detail/column_overlap.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/parallel.hpp"

namespace pelletlab::shapegen::detail {

namespace {

struct Crossing {
    double z;
    int turn;  // +1 enters the mesh going up, −1 leaves it
};

struct Run {
    double begin, end;
};

struct Grid {
    double x0, y0, step;
    int nx, ny;
    double x(int i) const { return x0 + step * (i + 0.5); }
    double y(int j) const { return y0 + step * (j + 0.5); }
    int first_column(double value, double origin) const { return static_cast<int>(std::ceil((value - origin) / step - 0.5)); }
};

// Twice the area left of the directed edge a → b at (x, y); computed the same way, up to the sign, for both triangles of an edge.
double edge_side(const Vec3& a, const Vec3& b, double x, double y) {
    const bool swap = a.x() != b.x() ? a.x() > b.x() : a.y() > b.y();
    const Vec3& p = swap ? b : a;
    const Vec3& q = swap ? a : b;
    const double side = (q.x() - p.x()) * (y - p.y()) - (q.y() - p.y()) * (x - p.x());
    return swap ? -side : side;
}

// Of two triangles at an edge exactly one owns the points on it.
bool owns_edge(const Vec3& a, const Vec3& b) {
    return a.y() != b.y() ? a.y() < b.y() : a.x() > b.x();
}

// Entries sorted by a small number, side by side in one list.
template <class Entry>
struct Bins {
    std::vector<std::pair<std::uint32_t, Entry>> loose;
    std::vector<std::uint32_t> start;
    std::vector<Entry> sorted;

    void add(std::size_t bin, const Entry& entry) { loose.emplace_back(static_cast<std::uint32_t>(bin), entry); }
    void sort(std::size_t bins) {
        start.assign(bins + 1, 0);
        for (const auto& [bin, entry] : loose) ++start[bin + 1];
        for (std::size_t k = 0; k < bins; ++k) start[k + 1] += start[k];
        std::vector<std::uint32_t> next(start.begin(), start.end() - 1);
        sorted.resize(loose.size());
        for (const auto& [bin, entry] : loose) sorted[next[bin]++] = entry;
        loose.clear();
    }
    std::span<Entry> of(std::size_t bin) { return std::span(sorted).subspan(start[bin], start[bin + 1] - start[bin]); }
};

// Crossings of the columns x = grid.x(i) with the triangles that span it.
void collect_crossings(const TriangleMesh& mesh, const Grid& grid, int begin, int end, Bins<Crossing>& columns) {
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        Vec3 a = mesh.corner(f, 0), b = mesh.corner(f, 1), c = mesh.corner(f, 2);
        const double area = (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
        if (area == 0.0) continue;
        const int turn = area > 0.0 ? -1 : 1;  // a face looking up is left through
        if (area < 0.0) std::swap(b, c);
        const auto [x_low, x_high] = std::minmax({a.x(), b.x(), c.x()});
        const auto [y_low, y_high] = std::minmax({a.y(), b.y(), c.y()});
        const int i0 = std::max(begin, grid.first_column(x_low, grid.x0)), j0 = std::max(0, grid.first_column(y_low, grid.y0));
        for (int i = i0; i < end && grid.x(i) <= x_high; ++i) {
            for (int j = j0; j < grid.ny && grid.y(j) <= y_high; ++j) {
                const double x = grid.x(i), y = grid.y(j);
                const double wa = edge_side(b, c, x, y), wb = edge_side(c, a, x, y), wc = edge_side(a, b, x, y);
                const bool inside = (wa > 0.0 || (wa == 0.0 && owns_edge(b, c))) && (wb > 0.0 || (wb == 0.0 && owns_edge(c, a))) &&
                                    (wc > 0.0 || (wc == 0.0 && owns_edge(a, b)));
                if (!inside) continue;
                const double z = (wa * a.z() + wb * b.z() + wc * c.z()) / (wa + wb + wc);
                columns.add(static_cast<std::size_t>((i - begin) * grid.ny + j), {z, turn});
            }
        }
    }
    columns.sort(static_cast<std::size_t>((end - begin) * grid.ny));
}

void mesh_runs(std::span<Crossing> crossings, std::vector<Run>& runs) {
    runs.clear();
    std::sort(crossings.begin(), crossings.end(), [](const Crossing& p, const Crossing& q) { return p.z != q.z ? p.z < q.z : p.turn > q.turn; });
    int winding = 0;
    for (const Crossing& crossing : crossings) {
        const int before = winding;
        winding += crossing.turn;
        if (before <= 0 && winding > 0) runs.push_back({crossing.z, crossing.z});
        if (before > 0 && winding <= 0) runs.back().end = crossing.z;
    }
}

// Runs of the spheres in the columns (x, grid.y(j)); those of a column become its union, from below.
void collect_runs(std::span<const Sphere> spheres, const Grid& grid, double x, Bins<Run>& row) {
    for (const Sphere& s : spheres) {
        const double left = s.radius * s.radius - (x - s.centre.x()) * (x - s.centre.x());
        if (left <= 0.0) continue;
        const double chord = std::sqrt(left);
        for (int j = std::max(0, grid.first_column(s.centre.y() - chord, grid.y0)); j < grid.ny && grid.y(j) < s.centre.y() + chord; ++j) {
            const double square = left - (grid.y(j) - s.centre.y()) * (grid.y(j) - s.centre.y());
            if (square <= 0.0) continue;
            const double half = std::sqrt(square);
            row.add(static_cast<std::size_t>(j), {s.centre.z() - half, s.centre.z() + half});
        }
    }
    row.sort(static_cast<std::size_t>(grid.ny));
}

std::span<Run> merged(std::span<Run> runs) {
    std::sort(runs.begin(), runs.end(), [](const Run& p, const Run& q) { return p.begin < q.begin; });
    std::size_t kept = 0;
    for (const Run& run : runs) {
        if (kept > 0 && run.begin <= runs[kept - 1].end) {
            runs[kept - 1].end = std::max(runs[kept - 1].end, run.end);
        } else {
            runs[kept++] = run;
        }
    }
    return runs.first(kept);
}

double length(std::span<const Run> runs) {
    double sum = 0.0;
    for (const Run& run : runs) sum += run.end - run.begin;
    return sum;
}

double common_length(std::span<const Run> a, std::span<const Run> b) {
    double sum = 0.0;
    for (std::size_t i = 0, j = 0; i < a.size() && j < b.size();) {
        sum += std::max(0.0, std::min(a[i].end, b[j].end) - std::max(a[i].begin, b[j].begin));
        a[i].end < b[j].end ? ++i : ++j;
    }
    return sum;
}

}  // namespace

OverlapVolumes column_overlap(const TriangleMesh& mesh, std::span<const Sphere> spheres, int columns) {
    Box box = bounding_box(mesh);
    for (const Sphere& s : spheres) {
        box.extend(Vec3(s.centre.array() - s.radius));
        box.extend(Vec3(s.centre.array() + s.radius));
    }
    Grid grid{};
    grid.step = std::max(box.sizes().x(), box.sizes().y()) / columns;
    // Symmetric bodies have edges on the middle lines: an odd shift keeps columns off them.
    grid.x0 = box.min().x() - 0.3719 * grid.step;
    grid.y0 = box.min().y() - 0.2847 * grid.step;
    grid.nx = static_cast<int>(box.sizes().x() / grid.step) + 2;
    grid.ny = static_cast<int>(box.sizes().y() / grid.step) + 2;

    constexpr std::size_t slab = 32;
    const auto sum = parallel_reduce(
        static_cast<std::size_t>(grid.nx), slab, OverlapVolumes{},
        [&](std::size_t begin, std::size_t end) {
            const int i0 = static_cast<int>(begin), i1 = static_cast<int>(end);
            Bins<Crossing> crossings;
            collect_crossings(mesh, grid, i0, i1, crossings);
            OverlapVolumes volumes;
            std::vector<Run> mesh_part;
            Bins<Run> row;
            for (int i = i0; i < i1; ++i) {
                collect_runs(spheres, grid, grid.x(i), row);
                for (int j = 0; j < grid.ny; ++j) {
                    mesh_runs(crossings.of(static_cast<std::size_t>((i - i0) * grid.ny + j)), mesh_part);
                    const std::span<const Run> sphere_part = merged(row.of(static_cast<std::size_t>(j)));
                    const double in_mesh = length(mesh_part), in_spheres = length(sphere_part), common = common_length(mesh_part, sphere_part);
                    volumes.mesh += in_mesh;
                    volumes.spheres += in_spheres;
                    volumes.missing += in_mesh - common;
                    volumes.outside += in_spheres - common;
                }
            }
            return volumes;
        },
        [](OverlapVolumes a, const OverlapVolumes& b) {
            a.mesh += b.mesh;
            a.spheres += b.spheres;
            a.missing += b.missing;
            a.outside += b.outside;
            return a;
        });
    const double area = grid.step * grid.step;
    return {sum.mesh * area, sum.spheres * area, sum.missing * area, sum.outside * area};
}

}  // namespace pelletlab::shapegen::detail
