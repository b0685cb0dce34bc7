#include "packing/detail/lattice.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/random.hpp"

namespace pelletlab::packing::detail {

namespace {

// Streams of random numbers: one a pellet and purpose.
constexpr std::uint64_t choice_streams = std::uint64_t{1} << 40, move_streams = std::uint64_t{2} << 40;

struct Stacking {
    bool alternate;  ///< ABAB; else AAAA
    bool on_hole;    ///< the axis passes through a hole of layer A, not through a site
};
constexpr std::array stackings{Stacking{true, false}, Stacking{true, true}, Stacking{false, false}, Stacking{false, true}};

std::vector<Vec3> hexagonal_lattice(const CentreRegion& region, double spacing, const Stacking& stacking) {
    std::vector<Vec3> sites;
    const double closest_layers = stacking.alternate ? spacing * std::sqrt(2.0 / 3.0) : spacing;
    const auto layers = static_cast<int>(std::floor(region.length / closest_layers * (1.0 + 1e-12))) + 1;
    const double layer_distance = layers > 1 ? region.length / (layers - 1) : 0.0;
    const double row_distance = spacing * std::sqrt(0.75);
    const Eigen::Vector2d hole(0.5 * spacing, row_distance / 3.0);
    const int reach = static_cast<int>(std::ceil(region.radius / row_distance)) + 2;
    for (int layer = 0; layer < layers; ++layer) {
        Eigen::Vector2d shift = stacking.on_hole ? hole : Eigen::Vector2d::Zero();
        if (stacking.alternate && layer % 2 == 1) shift += stacking.on_hole ? Eigen::Vector2d(-hole) : hole;
        for (int row = -reach; row <= reach; ++row)
            for (int column = -2 * reach; column <= 2 * reach; ++column) {
                const Vec3 site(column * spacing + 0.5 * (row & 1) * spacing + shift.x(), row * row_distance + shift.y(), layer * layer_distance);
                if (region.holds(site)) sites.push_back(site);
            }
    }
    return sites;
}

/// Centres sorted into cubes of the sphere diameter, so that only the 27 cubes around a centre can hold a neighbour.
class CellList {
public:
    CellList(const CentreRegion& region, double diameter, std::vector<Vec3>& centres) : diameter_(diameter), centres_(centres) {
        origin_ = Vec3(-region.radius, -region.radius, 0.0);
        const Vec3 size(2.0 * region.radius, 2.0 * region.radius, region.length);
        for (int k = 0; k < 3; ++k) count_[k] = static_cast<int>(size[k] / diameter) + 1;
        cells_.resize(static_cast<std::size_t>(count_[0]) * static_cast<std::size_t>(count_[1]) * static_cast<std::size_t>(count_[2]));
        for (std::uint32_t i = 0; i < centres.size(); ++i) cells_[cell_of(centres[i])].push_back(i);
    }

    bool has_room(std::uint32_t self, const Vec3& centre) const {
        const Eigen::Vector3i middle = index_of(centre);
        const Eigen::Vector3i from = (middle.array() - 1).max(0).matrix(), to = (middle.array() + 1).min(count_.array() - 1).matrix();
        for (int i = from[0]; i <= to[0]; ++i)
            for (int j = from[1]; j <= to[1]; ++j)
                for (int k = from[2]; k <= to[2]; ++k)
                    for (const std::uint32_t other : cells_[flat(i, j, k)])
                        if (other != self && (centres_[other] - centre).squaredNorm() < diameter_ * diameter_) return false;
        return true;
    }

    void move(std::uint32_t self, const Vec3& centre) {
        const std::size_t before = cell_of(centres_[self]), after = cell_of(centre);
        centres_[self] = centre;
        if (before == after) return;
        std::vector<std::uint32_t>& cell = cells_[before];
        cell.erase(std::find(cell.begin(), cell.end(), self));
        cells_[after].push_back(self);
    }

private:
    Eigen::Vector3i index_of(const Vec3& p) const {
        Eigen::Vector3i index;
        for (int k = 0; k < 3; ++k) index[k] = std::clamp(static_cast<int>((p[k] - origin_[k]) / diameter_), 0, count_[k] - 1);
        return index;
    }
    std::size_t flat(int i, int j, int k) const {
        return (static_cast<std::size_t>(k) * static_cast<std::size_t>(count_[1]) + static_cast<std::size_t>(j)) * static_cast<std::size_t>(count_[0]) +
               static_cast<std::size_t>(i);
    }
    std::size_t cell_of(const Vec3& p) const {
        const Eigen::Vector3i index = index_of(p);
        return flat(index[0], index[1], index[2]);
    }

    double diameter_;
    std::vector<Vec3>& centres_;
    Vec3 origin_;
    Eigen::Vector3i count_;
    std::vector<std::vector<std::uint32_t>> cells_;
};

/// Hard-sphere Monte Carlo (Metropolis et al. 1953): one move after the other, so the outcome depends on the streams alone.
void melt(std::vector<Vec3>& centres, const CentreRegion& region, double diameter, std::uint64_t seed, int sweeps) {
    CellList cells(region, diameter, centres);
    std::vector<RandomStream> streams;
    for (std::uint64_t i = 0; i < centres.size(); ++i) streams.emplace_back(seed, move_streams + i);
    double reach = 0.25 * diameter;  // of a move along each axis
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        std::size_t accepted = 0;
        for (std::uint32_t i = 0; i < centres.size(); ++i) {
            RandomStream& random = streams[i];
            const double dx = random.uniform(-reach, reach), dy = random.uniform(-reach, reach), dz = random.uniform(-reach, reach);
            const Vec3 target = centres[i] + Vec3(dx, dy, dz);
            if (!region.holds(target) || !cells.has_room(i, target)) continue;
            cells.move(i, target);
            ++accepted;
        }
        // Steps that succeed four times in ten travel furthest.
        reach *= static_cast<double>(accepted) > 0.4 * static_cast<double>(centres.size()) ? 1.1 : 0.9;
        reach = std::clamp(reach, 1e-3 * diameter, 2.0 * diameter);
    }
}

/// Widest lattice with at least `count` sites; the closest one when none has.
std::vector<Vec3> widest_lattice(const CentreRegion& region, double diameter, std::uint32_t count) {
    const double wide = std::max({2.0 * region.radius, region.length, diameter});
    for (double spacing = wide; spacing > diameter; spacing *= 0.99) {
        const double cells_of_this_size = (region.radius / spacing + 1.0) * (region.radius / spacing + 1.0) * 4.0 * (region.length / spacing + 1.0) * 2.0;
        if (cells_of_this_size < count) continue;  // far too few sites
        std::vector<Vec3> sites = densest_lattice(region, spacing);
        if (sites.size() >= count) return sites;
    }
    return densest_lattice(region, diameter);
}

}  // namespace

std::vector<Vec3> densest_lattice(const CentreRegion& region, double spacing) {
    std::vector<Vec3> best;
    for (const Stacking& stacking : stackings) {
        std::vector<Vec3> sites = hexagonal_lattice(region, spacing, stacking);
        if (sites.size() > best.size()) best = std::move(sites);
    }
    return best;
}

std::vector<Vec3> scattered_centres(const CentreRegion& region, double diameter, std::uint32_t count, std::uint64_t seed, int sweeps) {
    std::vector<Vec3> sites = widest_lattice(region, diameter, count);
    if (sites.size() < count) return sites;
    // A random choice of the sites: those with the smallest keys.
    std::vector<std::pair<std::uint64_t, std::uint32_t>> keys(sites.size());
    for (std::uint32_t i = 0; i < sites.size(); ++i) keys[i] = {RandomStream(seed, choice_streams + i).bits(), i};
    std::sort(keys.begin(), keys.end());
    std::vector<Vec3> centres(count);
    for (std::uint32_t i = 0; i < count; ++i) centres[i] = sites[keys[i].second];
    melt(centres, region, diameter, seed, sweeps);
    return centres;
}

}  // namespace pelletlab::packing::detail
