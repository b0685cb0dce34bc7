// The search for very few spheres: several starts for each number of them, up to the number wanted.
#pragma once

#include <cstdint>
#include <vector>

#include "shapegen/detail/modes.hpp"
#include "shapegen/detail/relocation.hpp"

namespace pelletlab::shapegen::detail {

/// Up to so many spheres the search is this one, from up to nine starts for each number up to that.
constexpr std::size_t few_spheres = 8;

struct FewSpheresResult {
    std::vector<Sphere> spheres;
    std::uint32_t iterations = 0, relocations = 0;
};

/// Best of 1, 2, … count spheres by the mean square of both directions. Each number starts from the best of one less, with the ball added where its gap is
/// largest or with its worst sphere cut in two; from farthest-point seeds; from medial balls at random points; and from rows along the principal axes. Where
/// all that is worse than one sphere less, the new one hides inside another: this loss never grows with the number. The mode that
/// comes after it minimises a bound of the depth inside and can lose again (four spheres of a cylinder do). `settings.slack` is found for each number.
FewSpheresResult fit_few(std::size_t count, const SampleBlocks& coarse, const SampleBlocks& fine, const ModeContext& context, std::size_t points,
                         const RelocationSettings& settings);

}  // namespace pelletlab::shapegen::detail
