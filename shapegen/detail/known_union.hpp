// A union of spheres with what all its figures need, computed once.
#pragma once

#include <span>
#include <vector>

#include "core/error.hpp"
#include "shapegen/detail/outer_surface.hpp"
#include "shapegen/detail/union_boundary.hpp"
#include "shapegen/quality.hpp"
#include "shapegen/surface_report.hpp"

namespace pelletlab::shapegen::detail {

struct KnownUnion {
    /// Throws Error(bad_input) without spheres.
    explicit KnownUnion(std::span<const Sphere> spheres_mesh)
        : spheres((spheres_mesh.empty() ? throw bad_input("there are no spheres to judge", "give at least one") : spheres_mesh)),
          boundary(union_boundary(spheres)),
          outer(spheres) {}

    std::span<const Sphere> spheres;
    std::vector<ExposedPart> boundary;
    OuterSurface outer;
};

FitQuality measure_quality(const KnownUnion& known, const TriangleMesh& body, const meshes::SignedDistance& exact);
SurfaceReport measure_surface(const KnownUnion& known, const TriangleMesh& body, const meshes::SignedDistance& exact, const SurfaceReportSettings& settings);

}  // namespace pelletlab::shapegen::detail
