// Symmetry of a body: found in its mesh, or given; the fit can impose it on the clump exactly.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/triangle_mesh.hpp"
#include "core/vec.hpp"
#include "meshes/signed_distance.hpp"

namespace pelletlab::shapegen {

/// Rotations by 360°/fold about an axis and reflections in planes, all through one centre (the body's centre of mass).
struct Symmetry {
    std::uint32_t fold = 1;  ///< 1: no rotation
    Vec3 axis = Vec3::UnitZ();
    std::vector<Vec3> mirrors;  ///< normals of the mirror planes; what they generate together is imposed as well

    bool trivial() const { return fold <= 1 && mirrors.empty(); }
};

/// What a mesh has.
struct FoundSymmetry {
    Symmetry symmetry;        ///< fold 1 … 12 about one of the principal axes; for a body of revolution fold is 1 and `revolution` is set
    bool revolution = false;  ///< about symmetry.axis: any number of spheres in a ring will do
    double residual = 0.0;    ///< [m], largest distance of the moved surface from the surface, over the symmetries found
};

/// Tries the principal axes of inertia (for three equal moments: the axes of the mesh's frame) and the planes through them; a motion belongs to the
/// body when it moves no vertex and no middle of a triangle farther than `tolerance` [m] off the surface; 0: 1/300 of the smallest extent.
FoundSymmetry find_symmetry(const TriangleMesh& body, const meshes::SignedDistance& exact, double tolerance = 0.0);

/// The same with the ring of a body of revolution chosen for that many spheres, so that rings are about as far apart as their spheres.
Symmetry symmetry_for(const FoundSymmetry& found, std::uint32_t sphere_count);

/// «4-fold about (0, 0, 1), 1 mirror plane»
std::string describe(const Symmetry& symmetry);

}  // namespace pelletlab::shapegen
