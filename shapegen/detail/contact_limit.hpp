// «At most so many spheres touch a plane at once»: many contacts on one face add their stiffness, and cost time steps and work.
#pragma once

#include "shapegen/detail/modes.hpp"

namespace pelletlab::shapegen::detail {

struct ContactLimit {
    std::size_t most = 0;  ///< 0: no limit
    double press = 0.0;    ///< how deep the plane is pressed in
};

/// Normals of the mesh's flat faces, then directions spread evenly: those in which contacts are counted.
std::vector<Vec3> plane_directions(const TriangleMesh& mesh, std::size_t spread);

/// Spheres within `press` of the foremost one in that direction.
std::size_t plane_contacts(std::span<const Sphere> spheres, const Vec3& normal, double press);

/// Polishes again with the spheres that touch beyond the limit held back.
MinimiserResult fit_within_contacts(std::vector<Sphere>& spheres, const ModeContext& context, const ContactLimit& limit, const SampleBlocks& samples,
                                    std::size_t points);

/// Makes the spheres that still touch too many at once smaller, as little as it takes, until no plane in the directions of plane_directions() touches more.
/// False when the minimum radius does not let them. A common offset of all radii afterwards changes nothing about it.
bool hold_contacts(std::vector<Sphere>& spheres, const ModeContext& context, const ContactLimit& limit);

}  // namespace pelletlab::shapegen::detail
