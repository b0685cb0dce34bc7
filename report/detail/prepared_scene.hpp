// The scene as the tracer wants it: checked, scaled to unit size in single precision, with normals for smooth shading and edges of glass.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "report/render.hpp"

namespace pelletlab::report::detail {

using Vec3f = Eigen::Vector3f;

struct PreparedObject {
    std::vector<Vec3f> vertices;
    std::vector<Triangle> faces;
    std::vector<std::array<Vec3f, 3>> corner_normals;  ///< (faces), unit length
    std::vector<Eigen::Vector4f> spheres;              ///< centre, radius
    std::vector<std::array<Vec3f, 2>> edges;           ///< glass only: borders and creases
    std::vector<Colour> vertex_colours;
    bool glass = false;
};

struct PreparedInstance {
    std::uint32_t object = 0;
    Eigen::Matrix3f rotation = Eigen::Matrix3f::Identity();
    Vec3f translation = Vec3f::Zero();
    Colour colour{};
};

struct PreparedScene {
    std::vector<PreparedObject> objects;
    std::vector<PreparedInstance> opaque, glass;
    Vec3 centre = Vec3::Zero();  ///< [m], becomes the origin
    double scale = 1.0;          ///< [1/m], makes the diagonal of everything 2
    double line_radius = 0.0;    ///< of glass edges, scaled

    Vec3 scaled(const Vec3& p_world) const { return (p_world - centre) * scale; }
};

/// `line_radius` in metres. Throws Error(bad_input) as render() says.
PreparedScene prepare(const Scene& scene, double line_radius);

/// Unit normals per face and corner: the angle-weighted mean over the faces round the vertex that meet this face flatter than crease_angle [rad].
std::vector<std::array<Vec3f, 3>> corner_normals(const TriangleMesh& mesh, double crease_angle);

/// Edges with one face, or whose two faces meet more sharply than crease_angle [rad]; as pairs of vertex indices, lower index first, sorted.
std::vector<std::array<std::uint32_t, 2>> feature_edges(const TriangleMesh& mesh, double crease_angle);

}  // namespace pelletlab::report::detail
