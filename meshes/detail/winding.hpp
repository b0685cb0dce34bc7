// Generalised winding number of a point: how often the surface goes round it, 1 inside and 0 outside a closed, outward-oriented body.
#pragma once

#include "core/triangle_mesh.hpp"

namespace pelletlab::meshes::detail {

/// Solid angle of a triangle seen from p, divided by 4π (Van Oosterom & Strackee 1983).
double solid_angle_fraction(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

/// Sum over all triangles for which use(face) holds.
template <class Use>
double winding_number(const TriangleMesh& mesh, const Vec3& p, const Use& use) {
    double sum = 0.0;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
        if (use(f)) sum += solid_angle_fraction(p, mesh.corner(f, 0), mesh.corner(f, 1), mesh.corner(f, 2));
    return sum;
}

}  // namespace pelletlab::meshes::detail
