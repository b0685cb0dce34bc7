// Sphere sets as other programs make them, so that a fit can be compared at equal N. They are written from the published descriptions, on the exact
// distance instead of voxels or vertices where the original has those: they can only gain by that.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/rigid_template.hpp"
#include "core/triangle_mesh.hpp"
#include "meshes/signed_distance.hpp"

namespace pelletlab::shapegen::baselines {

struct BaselineSettings {
    std::uint32_t sphere_count = 24;  ///< wished; a method may end with fewer
    std::uint64_t seed = 1;
    double overlap = 0.6;               ///< euclidean map: a sphere blocks (1 − overlap) of its radius
    double cell_fraction = 1.0 / 64.0;  ///< euclidean map and OpenVDB: cell / smallest extent of the body
};

/// OpenVDB's fillWithSpheres (overlapping spheres of a narrow-band level set; largest first).
std::vector<Sphere> openvdb_fill(const TriangleMesh& body, const BaselineSettings& settings);

/// Favier et al. (1999), Engineering Computations 16:467–480 (key favier1999): spheres on the longest principal axis, evenly spaced, each as large as fits.
/// Made for bodies of revolution.
std::vector<Sphere> favier(const TriangleMesh& body, const meshes::SignedDistance& exact, const BaselineSettings& settings);

/// Ferellec & McDowell (2010), Granular Matter 12:459–467 (key ferellec2010): surface points in random order, each not yet within d_min of a sphere gives
/// the largest inscribed sphere that touches the surface there. d_min is found by bisection so that as many spheres come out as wished, or a few less.
std::vector<Sphere> ferellec_mcdowell(const TriangleMesh& body, const meshes::SignedDistance& exact, const BaselineSettings& settings);

/// The Euclidean map of CLUMP (Angelidakis et al. 2021, SoftwareX 15:100735; key angelidakis2021): the largest sphere that fits beside the shrunken cores of
/// those before it, again and again.
std::vector<Sphere> euclidean_map(const TriangleMesh& body, const meshes::SignedDistance& exact, const BaselineSettings& settings);

/// The same spheres after one common radius offset that gives their union that volume [m³]: the one-line trick that every method may use.
std::vector<Sphere> volume_matched(std::span<const Sphere> spheres, double volume);

struct Method {
    std::string id;    ///< «ferellec»: what a user types
    std::string name;  ///< «Ferellec & McDowell 2010»
};

/// All of them, in a fixed order.
const std::vector<Method>& methods();

/// One of them by its id, deterministic. At most as many spheres as wished, at least one. Throws Error(usage) for an unknown id, Error(bad_input) for settings
/// out of range and for a body in which the method finds no place for a sphere.
std::vector<Sphere> baseline(const std::string& id, const TriangleMesh& body, const meshes::SignedDistance& exact, const BaselineSettings& settings);

}  // namespace pelletlab::shapegen::baselines
