// Contacts in a stored frame: who touches whom, and the elastic force that the overlaps carry.
#pragma once

#include <optional>
#include <vector>

#include "core/observables.hpp"
#include "core/trajectory.hpp"
#include "observables/bed.hpp"

namespace pelletlab::observables {

/// What turns overlaps δ into forces. Hertz: F = 4/3 E* √R* δ^(3/2) with 1/R* = 1/r₁ + 1/r₂ (a wall is flat: R* = r); linear: F = k δ.
struct ContactStiffness {
    bool hertz = true;
    double pellets = 0.0;       ///< E* [Pa] or k [N/m] between pellets
    std::vector<double> walls;  ///< the same, one a wall of the trajectory
};

/// 1/E* = (1 − ν₁²)/E₁ + (1 − ν₂²)/E₂ with E = 2 G (1 + ν) [Pa].
double effective_modulus(double shear_modulus_1, double poisson_ratio_1, double shear_modulus_2, double poisson_ratio_2);

/// How the shell and the floor of a tube touch: as the stored triangles, or as the cylinder and plane of the geometry.
enum class TubeSurface { triangles, exact };

/// Of the last frame, pellets as their clump's spheres (what the solver moved; positions must be good to a small part of an overlap, which no camera's are):
/// touching neighbours, sphere contacts and wall contacts per pellet, pellets with fewer than two contacts; distribution of neighbours. With `stiffness` also
/// the elastic normal forces: mean, 95th percentile and maximum over touching pairs of |Σ F n| of the pair's sphere contacts, its distribution over the mean,
/// and what the wall «floor» carries. Damping, friction and cohesion are not in it: they need the velocities at contact and the history of each contact, which
/// a frame does not hold. A sphere counts once a wall, where it is deepest. Methods tube.contacts, tube.contact_forces. Throws Error(bad_input) for a
/// trajectory without a frame or a shape without spheres.
void add_frame_contacts(Observables& result, const FrameSource& trajectory, const TubeGeometry& tube, TubeSurface surface,
                        const std::optional<ContactStiffness>& stiffness);

}  // namespace pelletlab::observables
