// The search for very few spheres: several starts for each number of them, up to the number wanted.
#pragma once

#include <cstdint>
#include <vector>

#include "shapegen/detail/match_moments.hpp"
#include "shapegen/detail/modes.hpp"
#include "shapegen/detail/relocation.hpp"

namespace pelletlab::shapegen::detail {

/// Up to so many spheres the search is this one, from up to nine starts for each number up to that.
constexpr std::size_t few_spheres = 8;

struct FewSpheresResult {
    std::vector<Sphere> spheres;
    std::vector<std::vector<Sphere>> fewer;  ///< the best of 1, 2, … count − 1, on which they were built
    double loss = 0.0;                       ///< true_loss() of them
    bool converged = false;
    std::uint32_t iterations = 0, relocations = 0;
};

/// Best of 1, 2, … count spheres in the mode mean, moments matched, by true_loss(). Each number starts from the best of one less, with the ball added where its
/// gap is largest or with its worst sphere cut in two; from farthest-point seeds; from medial balls at random points; and from rows along the principal axes.
/// The minimiser's own loss only bounds the depth inside, and can leave a good start for a worse one (four spheres of a cylinder): what it makes counts where
/// the true loss fell. Where all that is worse than one sphere less, the new one hides inside another. So the loss never grows with the number.
/// `settings.slack` is found for each number.
FewSpheresResult fit_few(std::size_t count, const SampleBlocks& coarse, const SampleBlocks& fine, const ModeContext& context, std::size_t points,
                         const RelocationSettings& settings, const MatchSettings& match);

}  // namespace pelletlab::shapegen::detail
