#include "solver/detail/wall_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <unordered_map>

#include "core/error.hpp"

namespace pelletlab::solver::detail {

namespace {

constexpr double weld_tolerance = 1e-9;  ///< of the box diagonal: STL files in float repeat vertices with the same bits
constexpr std::size_t most_places = 16;

struct CellHash {
    std::size_t operator()(const std::array<std::int64_t, 3>& c) const {
        return static_cast<std::size_t>(c[0] * 73856093LL ^ c[1] * 19349663LL ^ c[2] * 83492791LL);
    }
};

/// Index of the first vertex within the tolerance, for each vertex; vertices of the result are unique.
std::vector<std::uint32_t> weld(const std::vector<Vec3>& all, double tolerance, std::vector<Vec3>& unique) {
    std::unordered_map<std::array<std::int64_t, 3>, std::vector<std::uint32_t>, CellHash> cells;
    std::vector<std::uint32_t> index(all.size());
    for (std::size_t v = 0; v < all.size(); ++v) {
        std::array<std::int64_t, 3> c{};
        for (int k = 0; k < 3; ++k) c[static_cast<std::size_t>(k)] = static_cast<std::int64_t>(std::floor(all[v][k] / (4.0 * tolerance)));
        std::uint32_t found = UINT32_MAX;
        for (std::int64_t x = -1; x <= 1 && found == UINT32_MAX; ++x)
            for (std::int64_t y = -1; y <= 1 && found == UINT32_MAX; ++y)
                for (std::int64_t z = -1; z <= 1 && found == UINT32_MAX; ++z) {
                    const auto cell = cells.find({c[0] + x, c[1] + y, c[2] + z});
                    if (cell == cells.end()) continue;
                    for (const std::uint32_t u : cell->second)
                        if ((unique[u] - all[v]).norm() <= tolerance) {
                            found = u;
                            break;
                        }
                }
        if (found == UINT32_MAX) {
            found = static_cast<std::uint32_t>(unique.size());
            unique.push_back(all[v]);
            cells[c].push_back(found);
        }
        index[v] = found;
    }
    return index;
}

void note_place(WallReport& report, const Vec3& place) {
    if (report.odd_places.size() < most_places) report.odd_places.push_back(place);
}

void take_faces(const TriangleMesh& mesh, const std::vector<std::uint32_t>& index, WallMesh& wall) {
    std::map<std::array<std::uint32_t, 3>, bool> seen;
    for (const Triangle& face : mesh.faces) {
        const Triangle f{index[face[0]], index[face[1]], index[face[2]]};
        const Vec3 &a = wall.vertices[f[0]], &b = wall.vertices[f[1]], &c = wall.vertices[f[2]];
        const Vec3 area = (b - a).cross(c - a);
        const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
        if (f[0] == f[1] || f[1] == f[2] || f[2] == f[0] || !(area.norm() > 1e-12 * longest * longest)) {
            ++wall.report.degenerate_faces;
            continue;
        }
        std::array<std::uint32_t, 3> key{f[0], f[1], f[2]};
        std::sort(key.begin(), key.end());
        if (!seen.emplace(key, true).second) {
            ++wall.report.double_faces;
            continue;
        }
        if (area.norm() < 1e-4 * longest * longest) {
            ++wall.report.slivers;
            note_place(wall.report, (a + b + c) / 3.0);
        }
        wall.faces.push_back(f);
        wall.normals.push_back(area.normalized());
    }
}

void find_edges(WallMesh& wall) {
    std::map<std::array<std::uint32_t, 2>, std::vector<std::array<std::uint32_t, 2>>> sides;  // edge → (face, corner)
    for (std::uint32_t f = 0; f < wall.faces.size(); ++f)
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t a = wall.faces[f][k], b = wall.faces[f][(k + 1) % 3];
            sides[{std::min(a, b), std::max(a, b)}].push_back({f, k});
        }
    wall.edges_of_face.resize(wall.faces.size());
    std::vector<std::vector<Vec3>> spokes(wall.vertices.size());
    wall.border_vertex.assign(wall.vertices.size(), 0);
    for (const auto& [ends, users] : sides) {
        WallMesh::Edge edge;
        edge.vertex = ends;
        edge.first_side = static_cast<std::uint32_t>(wall.sides.size());
        edge.side_count = static_cast<std::uint32_t>(users.size());
        const Vec3 along = (wall.vertices[ends[1]] - wall.vertices[ends[0]]).normalized();
        for (const auto& [face, corner] : users) {
            const Vec3 inward = wall.corner(face, static_cast<int>((corner + 2) % 3)) - wall.vertices[ends[0]];
            wall.sides.push_back((inward - along * along.dot(inward)).normalized());
            wall.edges_of_face[face][corner] = static_cast<std::uint32_t>(wall.edges.size());
        }
        spokes[ends[0]].push_back(along);
        spokes[ends[1]].push_back(-along);
        if (edge.border()) wall.border_vertex[ends[0]] = wall.border_vertex[ends[1]] = 1;
        if (users.size() == 1) ++wall.report.border_edges;
        if (users.size() > 2) {
            ++wall.report.crowded_edges;
            note_place(wall.report, 0.5 * (wall.vertices[ends[0]] + wall.vertices[ends[1]]));
        }
        if (users.size() == 2) {
            const bool forward_0 = wall.faces[users[0][0]][users[0][1]] == ends[0], forward_1 = wall.faces[users[1][0]][users[1][1]] == ends[0];
            if (forward_0 == forward_1) ++wall.report.turned_joins;
        }
        wall.edges.push_back(edge);
    }
    wall.spokes_first.assign(1, 0);
    for (const auto& list : spokes) {
        wall.spokes.insert(wall.spokes.end(), list.begin(), list.end());
        wall.spokes_first.push_back(static_cast<std::uint32_t>(wall.spokes.size()));
    }
}

/// Union of faces over joins flatter than the feature angle. The bend is measured between the sides of the edge, so windings play no role.
void find_patches(WallMesh& wall) {
    std::vector<std::uint32_t> parent(wall.faces.size());
    std::iota(parent.begin(), parent.end(), 0U);
    const auto root = [&](std::uint32_t f) {
        while (parent[f] != f) f = parent[f] = parent[parent[f]];
        return f;
    };
    std::vector<std::array<std::uint32_t, 2>> faces_of_edge(wall.edges.size(), {UINT32_MAX, UINT32_MAX});
    for (std::uint32_t f = 0; f < wall.faces.size(); ++f)
        for (const std::uint32_t e : wall.edges_of_face[f]) faces_of_edge[e][faces_of_edge[e][0] == UINT32_MAX ? 0 : 1] = f;
    for (std::size_t e = 0; e < wall.edges.size(); ++e) {
        const WallMesh::Edge& edge = wall.edges[e];
        if (edge.side_count != 2) continue;
        if (-wall.sides[edge.first_side].dot(wall.sides[edge.first_side + 1]) < wall.cos_feature_angle) continue;
        const std::uint32_t a = root(faces_of_edge[e][0]), b = root(faces_of_edge[e][1]);
        parent[std::max(a, b)] = std::min(a, b);
    }
    std::vector<std::uint32_t> number(wall.faces.size(), UINT32_MAX);
    wall.patch.resize(wall.faces.size());
    for (std::uint32_t f = 0; f < wall.faces.size(); ++f) {
        std::uint32_t& n = number[root(f)];
        if (n == UINT32_MAX) n = wall.patch_count++;
        wall.patch[f] = n;
    }
}

void find_planes(WallMesh& wall) {
    for (std::uint32_t f = 0; f < wall.faces.size(); ++f) {
        const Vec3 a = wall.corner(f, 0), b = wall.corner(f, 1) - a, c = wall.corner(f, 2) - a, n = b.cross(c);
        wall.planes.push_back({a, wall.normals[f], c.cross(n) / n.squaredNorm(), n.cross(b) / n.squaredNorm()});
    }
}

/// Vertices that lie inside border edges: cracks that a welded mesh would not have. Quadratic in the border, which is short.
void count_t_junctions(WallMesh& wall) {
    std::vector<std::uint32_t> border;
    for (std::uint32_t v = 0; v < wall.vertices.size(); ++v)
        if (wall.border_vertex[v]) border.push_back(v);
    if (border.size() > 20000) return;
    for (const WallMesh::Edge& edge : wall.edges) {
        if (edge.side_count != 1) continue;
        const Vec3 a = wall.vertices[edge.vertex[0]], ab = wall.vertices[edge.vertex[1]] - a;
        for (const std::uint32_t v : border) {
            const Vec3 av = wall.vertices[v] - a;
            const double t = av.dot(ab) / ab.squaredNorm();
            if (v == edge.vertex[0] || v == edge.vertex[1] || t <= 0.0 || t >= 1.0 || (av - t * ab).norm() > 1e-7 * wall.size) continue;
            ++wall.report.t_junctions;
            note_place(wall.report, wall.vertices[v]);
        }
    }
}

/// A hit on a border whose point also belongs to a face that comes closer is no minimum: T-junctions and cracks.
bool lies_on_closer_face(const WallMesh& mesh, const Hit& hit, const std::vector<Hit>& hits) {
    const bool on_border = (hit.kind == FeatureKind::edge && mesh.edges[mesh.edges_of_face[hit.face][hit.corner]].border()) ||
                           (hit.kind == FeatureKind::vertex && mesh.border_vertex[mesh.faces[hit.face][hit.corner]]);
    if (!on_border) return false;
    return std::any_of(hits.begin(), hits.end(), [&](const Hit& other) {
        return other.distance2 < hit.distance2 * (1.0 - 1e-12) && closest_point(mesh, other.face, hit.point).distance2 < 1e-14 * mesh.size * mesh.size;
    });
}

/// A local minimum of the distance: one point, although every face that meets there reports it.
struct Minimum {
    Hit hit;
    double distance;
    Vec3 direction;  ///< unit, from the wall to the centre
    Vec3 sum;        ///< of its own direction and the weighted ones of the minima merged into it
};

/// Scratch of keep_contacts.
struct Minima {
    std::vector<Minimum> all;
    std::vector<std::array<std::uint32_t, 2>> patches;  ///< (minimum, patch of one of its faces)
    std::vector<std::uint32_t> kept;

    bool share_a_patch(std::uint32_t a, std::uint32_t b) const {
        for (const auto& [m, patch] : patches)
            if (m == a && std::find(patches.begin(), patches.end(), std::array<std::uint32_t, 2>{b, patch}) != patches.end()) return true;
        return false;
    }
};

/// Share of the shallower minimum b in the direction of the contact whose deepest minimum is a. Two faces that meet in a valley leave their feet at distances
/// s_a = (d_b - d_a cos) / sin and s_b = (d_a - d_b cos) / sin from the valley; with the share (overlap_b s_b) / (overlap_a s_a) the direction turns
/// continuously from one face to the other: b enters and leaves with share 0, and both count alike where both are as deep.
double share_of(double radius, double d_a, double d_b, double cosine) {
    const double s_a = d_b - d_a * cosine, s_b = d_a - d_b * cosine;
    if (!(s_a > 0.0 && s_b > 0.0)) return 0.0;
    return std::min(1.0, (radius - d_b) * s_b / ((radius - d_a) * s_a));
}

}  // namespace

WallMesh make_wall_mesh(const TriangleMesh& mesh, double feature_angle, const std::string& name) {
    if (mesh.empty()) throw bad_input("wall «" + name + "» has no triangles", "give it a mesh");
    for (const Vec3& v : mesh.vertices)
        if (!v.allFinite()) throw bad_input("wall «" + name + "» has a vertex that is not a number", "repair the mesh");
    for (const Triangle& f : mesh.faces)
        for (const std::uint32_t v : f)
            if (v >= mesh.vertices.size()) throw bad_input("wall «" + name + "» has a face with a vertex that does not exist", "repair the mesh");
    WallMesh wall;
    wall.cos_feature_angle = std::cos(feature_angle);
    wall.size = bounding_box(mesh).diagonal().norm();
    const std::vector<std::uint32_t> index = weld(mesh.vertices, std::max(weld_tolerance * wall.size, 1e-300), wall.vertices);
    take_faces(mesh, index, wall);
    if (wall.faces.empty()) throw bad_input("wall «" + name + "» has no triangle with an area", "repair the mesh");
    find_edges(wall);
    find_patches(wall);
    find_planes(wall);
    count_t_junctions(wall);
    wall.report.faces = wall.faces.size();
    wall.report.patches = wall.patch_count;
    return wall;
}

Hit closest_point(const WallMesh& mesh, std::uint32_t face, const Vec3& p) {
    const Vec3 &a = mesh.corner(face, 0), &b = mesh.corner(face, 1), &c = mesh.corner(face, 2);
    const auto hit_at = [&](const Vec3& point, FeatureKind kind, int corner) {
        return Hit{point, (p - point).squaredNorm(), face, kind, static_cast<std::uint8_t>(corner)};
    };
    const Vec3 ab = b - a, ac = c - a, ap = p - a;
    const double d1 = ab.dot(ap), d2 = ac.dot(ap);
    if (d1 <= 0.0 && d2 <= 0.0) return hit_at(a, FeatureKind::vertex, 0);
    const Vec3 bp = p - b;
    const double d3 = ab.dot(bp), d4 = ac.dot(bp);
    if (d3 >= 0.0 && d4 <= d3) return hit_at(b, FeatureKind::vertex, 1);
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return hit_at(a + ab * (d1 / (d1 - d3)), FeatureKind::edge, 0);
    const Vec3 cp = p - c;
    const double d5 = ab.dot(cp), d6 = ac.dot(cp);
    if (d6 >= 0.0 && d5 <= d6) return hit_at(c, FeatureKind::vertex, 2);
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return hit_at(a + ac * (d2 / (d2 - d6)), FeatureKind::edge, 2);
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0.0 && (d4 - d3) >= 0.0 && (d5 - d6) >= 0.0) return hit_at(b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6))), FeatureKind::edge, 1);
    // Inside the face: the foot of the perpendicular, taken along the stored normal so that all triangulations of a plane agree to the last digits.
    const Vec3& n = mesh.normals[face];
    return hit_at(p - n * n.dot(ap), FeatureKind::face, 0);
}

bool touches(const WallMesh& mesh, std::uint32_t face, const Vec3& centre, double radius, Hit& hit) {
    const WallMesh::FacePlane& plane = mesh.planes[face];
    const Vec3 d = centre - plane.a;
    const double height = plane.normal.dot(d);
    if (height * height >= radius * radius) return false;
    const double u = plane.along_b.dot(d), v = plane.along_c.dot(d);
    if (u >= 0.0 && v >= 0.0 && u + v <= 1.0) {
        hit = {centre - plane.normal * height, height * height, face, FeatureKind::face, 0};
        return true;
    }
    hit = closest_point(mesh, face, centre);
    return hit.distance2 < radius * radius;
}

bool is_local_minimum(const WallMesh& mesh, const Hit& hit, const Vec3& centre) {
    if (hit.kind == FeatureKind::face) return true;
    const Vec3 to_centre = centre - hit.point;
    // A little slack: at the border of two regions both hits may pass and are merged, but they must not both fail.
    const double slack = 1e-8 * to_centre.norm();
    if (hit.kind == FeatureKind::edge) {
        const WallMesh::Edge& edge = mesh.edges[mesh.edges_of_face[hit.face][hit.corner]];
        for (std::uint32_t s = edge.first_side; s < edge.first_side + edge.side_count; ++s)
            if (mesh.sides[s].dot(to_centre) > slack) return false;
        return true;
    }
    const std::uint32_t v = mesh.faces[hit.face][hit.corner];
    for (std::uint32_t s = mesh.spokes_first[v]; s < mesh.spokes_first[v + 1]; ++s)
        if (mesh.spokes[s].dot(to_centre) > slack) return false;
    return true;
}

void keep_contacts(const WallMesh& mesh, const Vec3& centre, double radius, std::vector<Hit>& hits) {
    std::sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) { return a.distance2 != b.distance2 ? a.distance2 < b.distance2 : a.face < b.face; });
    thread_local Minima minima;
    minima.all.clear(), minima.patches.clear(), minima.kept.clear();
    for (const Hit& hit : hits) {
        if (!is_local_minimum(mesh, hit, centre) || lies_on_closer_face(mesh, hit, hits)) continue;
        std::uint32_t index = 0;
        while (index < minima.all.size() && !((minima.all[index].hit.point - hit.point).squaredNorm() < 1e-14 * hit.distance2)) ++index;
        if (index == minima.all.size()) {
            const double distance = std::sqrt(hit.distance2);
            const Vec3 direction = distance > 0.0 ? Vec3((centre - hit.point) / distance) : mesh.normals[hit.face];
            minima.all.push_back({hit, distance, direction, direction});
        }
        minima.patches.push_back({index, mesh.patch[hit.face]});
    }
    for (std::uint32_t b = 0; b < minima.all.size(); ++b) {
        const Minimum& minimum = minima.all[b];
        bool merged = false;
        for (const std::uint32_t a : minima.kept) {
            Minimum& contact = minima.all[a];
            const double cosine = contact.direction.dot(minimum.direction);
            if (!(cosine > mesh.cos_feature_angle) || !minima.share_a_patch(a, b)) continue;
            contact.sum += share_of(radius, contact.distance, minimum.distance, cosine) * minimum.direction;
            merged = true;
        }
        if (!merged) minima.kept.push_back(b);
    }
    hits.clear();
    for (const std::uint32_t a : minima.kept) {
        const Minimum& contact = minima.all[a];
        hits.push_back(contact.hit);
        if (contact.sum != contact.direction) hits.back().point = centre - contact.sum.normalized() * contact.distance;
    }
}

}  // namespace pelletlab::solver::detail

namespace pelletlab::solver {

WallReport inspect_wall(const TriangleMesh& mesh, double feature_angle) {
    return detail::make_wall_mesh(mesh, feature_angle, "inspected").report;
}

}  // namespace pelletlab::solver
