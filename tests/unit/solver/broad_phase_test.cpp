#include "solver/detail/broad_phase.hpp"

#include <gtest/gtest.h>

#include "core/random.hpp"

namespace pelletlab::solver::detail {
namespace {

Bodies scattered(std::size_t n, double size, std::uint64_t seed) {
    Bodies b;
    b.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
        RandomStream random(seed, i);
        const double x = random.uniform(0.0, size), y = random.uniform(0.0, size), z = random.uniform(0.0, size);
        b.set_position(i, {x, y, z});
        b.set_template(i, random.uniform() < 0.3 ? 1 : 0);
    }
    return b;
}

std::vector<BodyTemplate> two_sizes() {
    std::vector<BodyTemplate> t(2);
    t[0].bounding_radius = 0.05;
    t[1].bounding_radius = 0.02;
    return t;
}

void expect_same_as_brute_force(const Bodies& b, double skin) {
    const auto templates = two_sizes();
    const NeighbourRows rows = find_neighbours(b, templates, skin);
    std::vector<std::uint32_t> first{0}, partner;
    for (std::size_t i = 0; i < b.size(); ++i) {
        for (std::size_t j = i + 1; j < b.size(); ++j) {
            const double reach = templates[b.template_of(i)].bounding_radius + templates[b.template_of(j)].bounding_radius + skin;
            if ((b.position(i) - b.position(j)).squaredNorm() < reach * reach) partner.push_back(static_cast<std::uint32_t>(j));
        }
        first.push_back(static_cast<std::uint32_t>(partner.size()));
    }
    EXPECT_EQ(rows.first, first);
    EXPECT_EQ(rows.partner, partner);
}

TEST(BroadPhase, EqualsBruteForceInADenseCloud) {
    expect_same_as_brute_force(scattered(800, 1.0, 1), 0.01);
}

TEST(BroadPhase, EqualsBruteForceWhenAFewBodiesAreVeryFarAway) {
    Bodies b = scattered(300, 0.5, 2);
    b.set_position(7, {1e6, 0.1, 0.2});
    b.set_position(9, {0.1, 0.2, -4e5});
    expect_same_as_brute_force(b, 0.02);
}

TEST(BroadPhase, NoBodiesAndOneBodyHaveNoNeighbours) {
    EXPECT_TRUE(find_neighbours(scattered(0, 1.0, 1), two_sizes(), 0.1).partner.empty());
    EXPECT_TRUE(find_neighbours(scattered(1, 1.0, 1), two_sizes(), 0.1).partner.empty());
}

}  // namespace
}  // namespace pelletlab::solver::detail
