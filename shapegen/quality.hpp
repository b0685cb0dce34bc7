// How well a union of spheres reproduces a body: definitions of ../docs/quality.md, figures by the exact distance query.
#pragma once

#include <span>

#include "core/clump_template.hpp"
#include "core/triangle_mesh.hpp"
#include "meshes/signed_distance.hpp"

namespace pelletlab::shapegen {

/// All in the frame of the mesh. `exact` is the exact distance of `body`. The figures of the surface (surface_report.hpp) are left open.
FitQuality measure_quality(std::span<const Sphere> spheres, const TriangleMesh& body, const meshes::SignedDistance& exact);

}  // namespace pelletlab::shapegen
