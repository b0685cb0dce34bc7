// Parametric bodies by one line of text: «cylinder:diameter=3.12mm,height=2.96mm,rim_radius=0.2mm».
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/triangle_mesh.hpp"

namespace pelletlab::meshes {

/// A body that a text can name, with the keys it knows.
struct NamedBody {
    std::string name;     ///< «trilobe»
    std::string example;  ///< the text with all keys at their defaults: «trilobe:lobe_diameter=1mm,lobe_offset=0.5mm,height=3mm»
    std::string what;     ///< one sentence
};

/// All of them, in a fixed order: cylinder, capsule, ring, trilobe, quadrulobe, sphere, scan, box.
const std::vector<NamedBody>& named_bodies();

/// The closed mesh of the body, axis z, centre in the origin; keys not given keep their defaults. Every body also takes `facets` (of the largest circle; 128).
/// The mesh has the volume of the true body (the scan has no other than its mesh): radii are scaled by that little.
/// A cylinder takes one of rim_radius, bevel, dome_height. Throws Error(bad_input) for an unknown body or key (with a suggestion), a value without a unit
/// or of another dimension, a key given twice, and sizes that make no body.
TriangleMesh make_named_body(std::string_view text);

}  // namespace pelletlab::meshes
