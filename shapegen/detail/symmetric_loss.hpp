// Both directions of the fit at once, the quantity that the quality report calls rms²: half the mean of φ_U² over the body's surface plus half the mean
// of φ_B² over the union's exposed surface (other shares on demand), and penalties that hold volume and moments of inertia.
//
// With the union's surface moving at normal speed v (v = n·dc + dr on each sphere), the integral I = ∫ f dA, f = φ_B², changes by
//     dI = Σ_spheres ∫ (∂f/∂n + 2 f / r) v dA − Σ_creases ∮ f tan(β/2) (v_i + v_j) ds,
// β the angle between the normals of the two spheres of a crease (it follows from div V on each patch and V·(ν_i + ν_j) on each crease).
#pragma once

#include <vector>

#include "meshes/signed_distance.hpp"
#include "shapegen/detail/gap_loss.hpp"
#include "shapegen/detail/match_moments.hpp"
#include "shapegen/detail/union_boundary.hpp"

namespace pelletlab::shapegen::detail {

/// What the loss charges. Penalties are relative to the square of the body's size: at weight 1 an error of 1e-3 weighs as much as gaps of 1e-3.
struct SymmetricTerms {
    GapShape gaps;
    double second = 1.0;         ///< share of the second direction, 0 … 2; the first one has the rest
    double volume = 1.0;         ///< × (V_union / V_body − 1)²
    double inertia = 0.01;       ///< × Σ (spread_union / spread_body − 1)²: lightly, few spheres cannot have the body's inertia
    double volume_reward = 0.0;  ///< × (1 − V_union): for spheres that must not poke out
    struct Level {               ///< these spheres touch one plane: × mean (n·c + r − their mean)²
        std::vector<std::uint32_t> spheres;
        Vec3 normal = Vec3::UnitZ();
        double weight = 1.0;
    };
    std::vector<Level> levels;
    struct Below {  ///< this sphere stays below a plane: × (n·c + r − level)² where that is above 0
        std::uint32_t sphere = 0;
        Vec3 normal = Vec3::UnitZ();
        double level = 0.0;
        double weight = 1.0;
    };
    std::vector<Below> below;
};

class SymmetricLoss {
public:
    /// `points` are spread over the union's exposed surface, about; `body` has volume 1 and its centre in the origin.
    SymmetricLoss(const SampleBlocks& samples, const meshes::SignedDistance& distance, std::span<const Sphere> spheres, const BodyMoments& body,
                  std::size_t points);

    void charge_by(const SymmetricTerms& terms);

    /// s² (E / s²)^(2/p) with E the mean charge of both directions, which is the mean square for p = 2, plus the penalties.
    double evaluate(const VectorXd& x, VectorXd& gradient, BlockMetric* metric);

    double first() const { return first_; }    ///< of the last evaluation: (weighted) mean φ_U² over the body's surface
    double second() const { return second_; }  ///< mean φ_B² over the union's surface
    double union_volume() const { return union_volume_; }
    double largest() const { return largest_; }  ///< |φ| of both directions, at the points

private:
    struct Part;
    struct Directions {  // Fibonacci points of the unit sphere
        std::vector<float> x, y, z;
    };
    Part one_sphere(const Sphere& sphere, const ExposedPart& part, std::span<const Sphere> spheres, const Directions& directions) const;

    GapLoss gap_loss_;
    const meshes::SignedDistance& distance_;
    Mat3 axes_;    // principal axes of the body
    Vec3 spread_;  // its covariance along them
    std::vector<Directions> tables_;
    std::vector<std::size_t> table_of_;  // of each sphere, fixed so that the loss stays one function
    double add_penalties(const std::vector<Sphere>& spheres, const std::vector<ExposedPart>& boundary, const std::vector<Part>& parts, VectorXd& gradient,
                         BlockMetric* metric);
    double add_levels(const std::vector<Sphere>& spheres, VectorXd& gradient, BlockMetric* metric) const;

    SymmetricTerms terms_;
    double first_ = 0.0, second_ = 0.0, union_volume_ = 0.0, largest_ = 0.0;
};

}  // namespace pelletlab::shapegen::detail
