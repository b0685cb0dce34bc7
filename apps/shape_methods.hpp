// Where the spheres of a clump come from: our fit, the study's hand-made shapes, or the method of another program.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/rigid_template.hpp"
#include "core/triangle_mesh.hpp"
#include "meshes/signed_distance.hpp"

namespace pelletlab::apps {

inline const std::string fit_method = "fit";

struct NamedMethod {
    std::string id;    ///< «fit», «shape4», «openvdb»
    std::string name;  ///< «study's Shape 4, hand-made»
};

/// Our fit first, then Shapes 1–4, then the baselines.
const std::vector<NamedMethod>& all_methods();

/// Error(usage) with a suggestion for an unknown id.
const NamedMethod& find_method(const std::string& id);

/// True for shape1 … shape4: their number of spheres is theirs, and they belong to one body.
bool is_study_shape(const std::string& id);

/// Spheres of any method but the fit, in the frame of the mesh. Throws Error(bad_input) for a study's shape on another body than its cylinder.
std::vector<Sphere> spheres_of_method(const std::string& id, const TriangleMesh& body, const meshes::SignedDistance& exact, std::uint32_t sphere_count,
                                      std::uint64_t seed);

/// True when the body is the study's cylinder, 3.12 x 2.96 mm, in any pose, up to 1 %.
bool is_study_cylinder(const TriangleMesh& body);

}  // namespace pelletlab::apps
