#include "solver/detail/broad_phase.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/parallel.hpp"

namespace pelletlab::solver::detail {

namespace {

/// Bodies sorted by cell (a counting sort keeps the order of bodies within a cell).
struct Grid {
    Vec3 origin = Vec3::Zero();
    double cell = 1.0;
    std::array<std::int64_t, 3> count{1, 1, 1};
    const std::vector<std::uint32_t>& first;
    const std::vector<std::uint32_t>& member;

    std::array<std::int64_t, 3> cell_of(const Vec3& p) const {
        std::array<std::int64_t, 3> c{};
        for (int k = 0; k < 3; ++k) {
            const auto u = static_cast<std::size_t>(k);
            c[u] = std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor((p[k] - origin[k]) / cell)), 0, count[u] - 1);
        }
        return c;
    }
    std::size_t index(const std::array<std::int64_t, 3>& c) const { return static_cast<std::size_t>((c[2] * count[1] + c[1]) * count[0] + c[0]); }
};

Grid make_grid(const Bodies& bodies, double smallest_cell, NeighbourScratch& s) {
    Grid grid{Vec3::Zero(), 1.0, {1, 1, 1}, s.first, s.member};
    Box box;
    const std::size_t n = bodies.size();
    for (std::size_t i = 0; i < n; ++i) box.extend(bodies.position(i));
    grid.origin = box.min();
    grid.cell = smallest_cell;
    const double most_cells = 8.0 * static_cast<double>(n) + 64.0;
    for (;;) {  // bodies that are scattered over a huge space get larger cells, so memory stays proportional to the bodies
        double total = 1.0;
        for (int k = 0; k < 3; ++k) total *= std::floor(box.sizes()[k] / grid.cell) + 1.0;
        if (total <= most_cells) break;
        grid.cell *= 1.26;
    }
    for (std::size_t k = 0; k < 3; ++k) grid.count[k] = static_cast<std::int64_t>(std::floor(box.sizes()[static_cast<int>(k)] / grid.cell)) + 1;
    s.cell_of_body.resize(n);
    s.first.assign(static_cast<std::size_t>(grid.count[0] * grid.count[1] * grid.count[2]) + 1, 0);
    parallel_for(n, 2048, [&](std::size_t i) { s.cell_of_body[i] = static_cast<std::uint32_t>(grid.index(grid.cell_of(bodies.position(i)))); });
    for (std::size_t i = 0; i < n; ++i) ++s.first[s.cell_of_body[i] + 1];
    for (std::size_t c = 1; c < s.first.size(); ++c) s.first[c] += s.first[c - 1];
    s.next.assign(s.first.begin(), s.first.end() - 1);
    s.member.resize(n);
    for (std::size_t i = 0; i < n; ++i) s.member[s.next[s.cell_of_body[i]]++] = static_cast<std::uint32_t>(i);
    return grid;
}

}  // namespace

void find_neighbours(const Bodies& bodies, const std::vector<BodyTemplate>& templates, double skin, NeighbourRows& rows, NeighbourScratch& scratch) {
    const std::size_t n = bodies.size();
    rows.first.assign(n + 1, 0);
    rows.partner.clear();
    if (n < 2) return;
    double largest = 0.0;
    for (const BodyTemplate& t : templates) largest = std::max(largest, t.bounding_radius);
    const Grid grid = make_grid(bodies, 2.0 * largest + skin, scratch);

    constexpr std::size_t grain = 512;
    scratch.found.resize((n + grain - 1) / grain);
    parallel_blocks(n, grain, [&](std::size_t begin, std::size_t end) {
        std::vector<std::uint32_t>& list = scratch.found[begin / grain];
        list.clear();
        for (std::size_t i = begin; i < end; ++i) {
            const std::size_t start = list.size();
            const Vec3 p = bodies.position(i);
            const std::uint32_t id = bodies.id(i);
            const double reach = templates[bodies.template_of(i)].bounding_radius + skin;
            const auto c = grid.cell_of(p);
            for (std::int64_t z = std::max<std::int64_t>(c[2] - 1, 0); z <= std::min(c[2] + 1, grid.count[2] - 1); ++z) {
                for (std::int64_t y = std::max<std::int64_t>(c[1] - 1, 0); y <= std::min(c[1] + 1, grid.count[1] - 1); ++y) {
                    // Cells of one row follow each other in memory.
                    const std::size_t from = grid.index({std::max<std::int64_t>(c[0] - 1, 0), y, z});
                    const std::size_t to = grid.index({std::min(c[0] + 1, grid.count[0] - 1), y, z});
                    for (std::uint32_t m = grid.first[from]; m < grid.first[to + 1]; ++m) {
                        const std::uint32_t j = grid.member[m];
                        if (bodies.id(j) <= id) continue;
                        const double distance = reach + templates[bodies.template_of(j)].bounding_radius;
                        if ((bodies.position(j) - p).squaredNorm() < distance * distance) list.push_back(j);
                    }
                }
            }
            std::sort(list.begin() + static_cast<std::ptrdiff_t>(start), list.end(),
                      [&](std::uint32_t a, std::uint32_t b) { return bodies.id(a) < bodies.id(b); });
            rows.first[i + 1] = static_cast<std::uint32_t>(list.size() - start);
        }
    });
    for (std::size_t i = 0; i < n; ++i) rows.first[i + 1] += rows.first[i];
    rows.partner.reserve(rows.first[n]);
    for (const auto& list : scratch.found) rows.partner.insert(rows.partner.end(), list.begin(), list.end());
}

}  // namespace pelletlab::solver::detail
