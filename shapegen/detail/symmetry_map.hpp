// A clump with symmetry has few unknowns: one sphere of each orbit. This maps them to all spheres, and slopes and metrics back.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/rigid_template.hpp"
#include "shapegen/detail/gap_loss.hpp"
#include "shapegen/symmetry.hpp"

namespace pelletlab::shapegen::detail {

/// A finite group of rotations and reflections about the origin, and the kinds of places that it leaves: a sphere in general position comes |G| times,
/// one on a mirror plane half as often, …
struct SymmetryGroup {
    struct Place {
        Mat3 onto = Mat3::Identity();    ///< projector onto the plane, line or point that the place is
        std::vector<std::size_t> moves;  ///< elements that give the different images; the first is the identity
        int dimension = 3;
    };
    std::vector<Mat3> elements;  ///< the identity first
    std::vector<Place> places;   ///< the general one first, falling by the number of images

    /// Closure of the generators. Throws Error(bad_input) when it has more than 96 elements (an axis and mirrors that do not belong together).
    static SymmetryGroup of(const Symmetry& symmetry);

    /// Can that many spheres be made of whole orbits? The centre holds one sphere at most.
    bool can_hold(std::uint32_t spheres) const;

    /// Nearest point to p on any copy of that place, brought to the place itself.
    Vec3 brought_to(const Vec3& p, std::size_t place) const;

    /// Does p lie in the part of space that the group's copies of it fill once?
    bool in_domain(const Vec3& p) const;
};

/// One sphere of each orbit, with its place.
struct Generator {
    std::size_t place = 0;
    Sphere sphere;
};

class SymmetryMap {
public:
    SymmetryMap(const SymmetryGroup& group, std::vector<std::size_t> place_of_generator);

    std::size_t generators() const { return place_.size(); }
    std::size_t spheres() const { return owner_.size(); }
    std::vector<Sphere> expand(std::span<const Sphere> generators) const;
    /// The first image of every orbit, moved onto its place, with the smallest radius of the orbit.
    std::vector<Sphere> first_of(std::span<const Sphere> all) const;

    VectorXd expand(const VectorXd& generators) const;
    VectorXd reduce(const VectorXd& gradient_of_all) const;  ///< chain rule
    BlockMetric reduce(const BlockMetric& of_all) const;

private:
    const SymmetryGroup& group_;
    std::vector<std::size_t> place_;
    std::vector<std::size_t> owner_;  // generator of each sphere; orbits follow one another
    std::vector<std::size_t> move_;   // element of each sphere
};

}  // namespace pelletlab::shapegen::detail
