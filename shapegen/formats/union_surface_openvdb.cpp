#include <openvdb/openvdb.h>
#include <openvdb/tools/Dense.h>
#include <openvdb/tools/VolumeToMesh.h>

#include <algorithm>
#include <cmath>
#include <mutex>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "shapegen/formats/union_surface.hpp"

namespace pelletlab::shapegen::formats {

namespace {

constexpr double band = 3.0;        // half width of the sampled band in cells: dual contouring looks at the two cells beside the surface
constexpr double most_cells = 6e8;  // 2.4 GB of floats

/// The distance in cells on a box of grid points, cut at ±band.
struct Samples {
    Vec3 origin = Vec3::Zero();  ///< [m], point (0, 0, 0)
    double spacing = 0.0;        ///< [m]
    Eigen::Array3i size = Eigen::Array3i::Zero();
    std::vector<float> value;  ///< x slowest, z fastest: the layout of openvdb::tools::LayoutZYX

    std::size_t row(int i, int j) const {
        return (static_cast<std::size_t>(i) * static_cast<std::size_t>(size[1]) + static_cast<std::size_t>(j)) * static_cast<std::size_t>(size[2]);
    }
};

Samples empty_samples(std::span<const Sphere> spheres, double spacing) {
    Box box;
    for (const Sphere& s : spheres) {
        box.extend(s.centre - Vec3::Constant(s.radius));
        box.extend(s.centre + Vec3::Constant(s.radius));
    }
    Samples samples;
    samples.spacing = spacing;
    samples.origin = box.min() - Vec3::Constant((band + 2.0) * spacing);
    const Vec3 cells = (box.sizes() / spacing).array() + 2.0 * (band + 2.0) + 1.0;
    if (!(cells.prod() < most_cells)) throw bad_input("the surface cells are too small: there would be more than 6e8 of them", "use a larger cell for the STL");
    samples.size = cells.array().ceil().cast<int>();
    samples.value.assign(samples.row(samples.size[0] - 1, samples.size[1] - 1) + static_cast<std::size_t>(samples.size[2]), static_cast<float>(band));
    return samples;
}

/// Lowers the values of one plane i of grid points to the distance of this sphere where that is smaller.
void add_sphere(Samples& samples, const Sphere& sphere, int i) {
    const double h = samples.spacing;
    const Vec3 c = (sphere.centre - samples.origin) / h;
    const double r = sphere.radius / h, outer = r + band, inner = std::max(r - band, 0.0);
    const double dx2 = (i - c.x()) * (i - c.x());
    if (dx2 > outer * outer) return;
    const double reach = std::sqrt(outer * outer - dx2);
    const int first = std::max(0, static_cast<int>(std::ceil(c.y() - reach))),
              last = std::min(samples.size[1] - 1, static_cast<int>(std::floor(c.y() + reach)));
    for (int j = first; j <= last; ++j) {
        const double d2 = dx2 + (j - c.y()) * (j - c.y());
        const double half = std::sqrt(std::max(outer * outer - d2, 0.0));
        float* row = samples.value.data() + samples.row(i, j);
        const int begin = std::max(0, static_cast<int>(std::ceil(c.z() - half))),
                  end = std::min(samples.size[2] - 1, static_cast<int>(std::floor(c.z() + half)));
        for (int k = begin; k <= end; ++k) {
            const double dz = k - c.z();
            const double squared = d2 + dz * dz;
            const double distance = squared < inner * inner ? -band : std::max(std::sqrt(squared) - r, -band);
            row[k] = std::min(row[k], static_cast<float>(distance));
        }
    }
}

Samples sample(std::span<const Sphere> spheres, double spacing) {
    Samples samples = empty_samples(spheres, spacing);
    parallel_for(static_cast<std::size_t>(samples.size[0]), 1, [&](std::size_t i) {
        for (const Sphere& sphere : spheres) add_sphere(samples, sphere, static_cast<int>(i));
    });
    return samples;
}

struct Quads {
    std::vector<Vec3> vertices;
    std::vector<openvdb::Vec4I> faces;
};

Quads contour(const Samples& samples) {
    static std::once_flag once;
    std::call_once(once, [] { openvdb::initialize(); });
    const openvdb::CoordBBox box(openvdb::Coord(0), openvdb::Coord(samples.size[0] - 1, samples.size[1] - 1, samples.size[2] - 1));
    // Dense reads the array only; its constructor takes a pointer to mutable data.
    const openvdb::tools::Dense<float, openvdb::tools::LayoutZYX> dense(box, const_cast<float*>(samples.value.data()));
    const openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(static_cast<float>(band));
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    openvdb::tools::copyFromDense(dense, *grid, 0.0F);
    std::vector<openvdb::Vec3s> points;
    std::vector<openvdb::Vec3I> triangles;
    Quads quads;
    openvdb::tools::volumeToMesh(*grid, points, triangles, quads.faces, 0.0, 0.0, true);
    for (const openvdb::Vec3I& t : triangles) quads.faces.emplace_back(t[0], t[1], t[2], openvdb::util::INVALID_IDX);
    for (const openvdb::Vec3s& p : points) quads.vertices.push_back(samples.origin + Vec3(p[0], p[1], p[2]) * samples.spacing);
    return quads;
}

/// The point of the union's surface near p, found by steps along the gradient of the distance; p itself if that would lead far away.
Vec3 projected(std::span<const Sphere> spheres, const Vec3& p, double spacing) {
    Vec3 q = p;
    for (int step = 0; step < 30; ++step) {
        const Sphere* nearest = &spheres.front();
        double distance = std::numeric_limits<double>::infinity();
        for (const Sphere& s : spheres) {
            const double d = (q - s.centre).norm() - s.radius;
            if (d < distance) {
                distance = d;
                nearest = &s;
            }
        }
        if (std::abs(distance) < 1e-9 * spacing) break;
        const Vec3 arm = q - nearest->centre;
        const double length = arm.norm();
        if (length < 1e-3 * nearest->radius) return p;
        q = nearest->centre + arm * (nearest->radius / length);
    }
    return (q - p).norm() < 1.5 * spacing ? q : p;
}

/// Quads cut along their shorter diagonal.
TriangleMesh triangulated(const Quads& quads) {
    TriangleMesh mesh;
    mesh.vertices = quads.vertices;
    for (const openvdb::Vec4I& q : quads.faces) {
        if (q[3] == openvdb::util::INVALID_IDX) {
            mesh.faces.push_back({q[0], q[1], q[2]});
            continue;
        }
        const bool first = (mesh.vertices[q[0]] - mesh.vertices[q[2]]).squaredNorm() <= (mesh.vertices[q[1]] - mesh.vertices[q[3]]).squaredNorm();
        if (first) {
            mesh.faces.push_back({q[0], q[1], q[2]});
            mesh.faces.push_back({q[0], q[2], q[3]});
        } else {
            mesh.faces.push_back({q[1], q[2], q[3]});
            mesh.faces.push_back({q[1], q[3], q[0]});
        }
    }
    return mesh;
}

/// Every directed edge occurs once, and so does its opposite.
bool closed(const TriangleMesh& mesh) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
    edges.reserve(3 * mesh.faces.size());
    for (const Triangle& face : mesh.faces)
        for (std::size_t k = 0; k < 3; ++k) edges.emplace_back(face[k], face[(k + 1) % 3]);
    std::sort(edges.begin(), edges.end());
    if (std::adjacent_find(edges.begin(), edges.end()) != edges.end()) return false;
    return std::all_of(edges.begin(), edges.end(), [&](const auto& edge) {
        return edge.first != edge.second && std::binary_search(edges.begin(), edges.end(), std::pair{edge.second, edge.first});
    });
}

double signed_volume(const TriangleMesh& mesh) {
    double six = 0.0;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) six += mesh.corner(f, 0).dot(mesh.corner(f, 1).cross(mesh.corner(f, 2)));
    return six / 6.0;
}

double chosen_spacing(std::span<const Sphere> spheres, double voxel) {
    Box box;
    double smallest = std::numeric_limits<double>::infinity();
    for (const Sphere& s : spheres) {
        if (!s.centre.allFinite() || !std::isfinite(s.radius) || !(s.radius > 0.0)) throw bad_input("a sphere has no finite centre and positive radius", {});
        box.extend(s.centre - Vec3::Constant(s.radius));
        box.extend(s.centre + Vec3::Constant(s.radius));
        smallest = std::min(smallest, s.radius);
    }
    const double longest = box.sizes().maxCoeff();
    if (voxel == 0.0) voxel = std::max(std::min(longest / 128.0, smallest / 3.0), longest / 400.0);
    if (!std::isfinite(voxel) || !(voxel > 0.0)) throw bad_input("the cell of the surface must be positive", "leave it away for an automatic one");
    if (voxel > 0.5 * smallest)
        throw bad_input("the surface cells are too coarse for the smallest sphere of the clump",
                        "use at most half of its radius, or leave the cell size away; drop slivers from the clump");
    return voxel;
}

}  // namespace

double union_distance(std::span<const Sphere> spheres, const Vec3& p) {
    double distance = std::numeric_limits<double>::infinity();
    for (const Sphere& s : spheres) distance = std::min(distance, (p - s.centre).norm() - s.radius);
    return distance;
}

UnionSurface union_surface(std::span<const Sphere> spheres, double voxel) {
    if (spheres.empty()) throw bad_input("no spheres to make a surface of", {});
    double spacing = chosen_spacing(spheres, voxel);
    // Two sheets that touch inside one cell can give an edge with four triangles; a slightly finer grid then cuts elsewhere.
    for (int attempt = 0; attempt < 6; ++attempt, spacing *= 0.96) {
        Quads quads = contour(sample(spheres, spacing));
        parallel_for(quads.vertices.size(), 256, [&](std::size_t v) { quads.vertices[v] = projected(spheres, quads.vertices[v], spacing); });
        UnionSurface surface;
        surface.mesh = triangulated(quads);
        surface.voxel = spacing;
        surface.volume = signed_volume(surface.mesh);
        if (surface.volume < 0.0) {
            for (Triangle& face : surface.mesh.faces) std::swap(face[1], face[2]);
            surface.volume = -surface.volume;
        }
        if (surface.mesh.empty() || !closed(surface.mesh)) continue;
        const auto largest = [&](std::size_t n, const auto& point) {
            return parallel_reduce(
                n, 1024, 0.0,
                [&](std::size_t begin, std::size_t end) {
                    double most = 0.0;
                    for (std::size_t i = begin; i < end; ++i) most = std::max(most, std::abs(union_distance(spheres, point(i))));
                    return most;
                },
                [](double a, double b) { return std::max(a, b); });
        };
        const TriangleMesh& mesh = surface.mesh;
        surface.vertex_distance = largest(mesh.vertices.size(), [&](std::size_t v) { return mesh.vertices[v]; });
        surface.centre_distance =
            largest(mesh.faces.size(), [&](std::size_t f) { return Vec3((mesh.corner(f, 0) + mesh.corner(f, 1) + mesh.corner(f, 2)) / 3.0); });
        return surface;
    }
    throw numerical_failure("no closed surface of the union of spheres came out", "give another cell size");
}

}  // namespace pelletlab::shapegen::formats
