#include "solver/detail/broad_phase.hpp"

#include <gtest/gtest.h>

#include "core/random.hpp"
#include "solver/detail/body_order.hpp"

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

NeighbourRows neighbours(const Bodies& b, const std::vector<BodyTemplate>& templates, double skin) {
    NeighbourRows rows;
    NeighbourScratch scratch;
    find_neighbours(b, templates, skin, rows, scratch);
    return rows;
}

void expect_same_as_brute_force(const Bodies& b, double skin) {
    const auto templates = two_sizes();
    const NeighbourRows rows = neighbours(b, templates, skin);
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

TEST(BroadPhase, ReorderedBodiesHaveTheSameNeighboursByTheirIds) {
    const auto templates = two_sizes();
    Bodies b = scattered(500, 1.0, 3);
    const NeighbourRows straight = neighbours(b, templates, 0.01);
    const std::vector<std::uint32_t> order = hilbert_order(b, 0.1);
    std::vector<std::uint8_t> seen(b.size(), 0);
    for (const std::uint32_t i : order) ++seen[i];
    EXPECT_EQ(seen, std::vector<std::uint8_t>(b.size(), 1));
    const std::vector<Vec3> before = [&] {
        std::vector<Vec3> p;
        for (std::size_t i = 0; i < b.size(); ++i) p.push_back(b.position(i));
        return p;
    }();
    b.reorder(order);
    double steps = 0.0, steps_before = 0.0;
    for (std::size_t i = 0; i < b.size(); ++i) {
        EXPECT_EQ(b.position(b.place_of(i)), before[i]);
        if (i > 0) steps += (b.position(i) - b.position(i - 1)).norm(), steps_before += (before[i] - before[i - 1]).norm();
    }
    EXPECT_LT(steps, 0.25 * steps_before);  // neighbours in memory are neighbours in space
    const NeighbourRows moved = neighbours(b, templates, 0.01);
    for (std::uint32_t id = 0; id < b.size(); ++id) {
        const std::uint32_t i = b.place_of(id);
        std::vector<std::uint32_t> ids;
        for (std::uint32_t k = moved.first[i]; k < moved.first[i + 1]; ++k) ids.push_back(b.id(moved.partner[k]));
        EXPECT_EQ(ids, std::vector<std::uint32_t>(straight.partner.begin() + straight.first[id], straight.partner.begin() + straight.first[id + 1]));
    }
}

TEST(BroadPhase, NoBodiesAndOneBodyHaveNoNeighbours) {
    EXPECT_TRUE(neighbours(scattered(0, 1.0, 1), two_sizes(), 0.1).partner.empty());
    EXPECT_TRUE(neighbours(scattered(1, 1.0, 1), two_sizes(), 0.1).partner.empty());
}

}  // namespace
}  // namespace pelletlab::solver::detail
