#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "meshes/detail/openvdb_distances.hpp"
#include "meshes/signed_distance.hpp"

namespace pelletlab::meshes {
namespace {

constexpr double rim_share = 0.25;     // of the body's smallest edge, on every side of its box
constexpr double rim_voxels = 3.0;     // at least
constexpr double most_voxels = 512e6;  // 2 GiB of floats
constexpr std::size_t most_samples = 2000000;
constexpr std::size_t most_band_samples = 5000;  // the exact query at all of them would take longer than the band itself
constexpr double band_voxels = 4.0;
constexpr double safety = 1.5;       // the worst point of a cell need not be its middle
constexpr double band_safety = 2.0;  // nor is the worst cell of a band among those asked

/// A dense block of distances at the points origin + voxel · (i, j, k).
class GridDistance final : public SignedDistance {
public:
    GridDistance(const TriangleMesh& mesh, double voxel, GridFill fill, std::shared_ptr<const SignedDistance> exact);
    double value(const Vec3& p) const override;
    Vec3 gradient(const Vec3& p) const override { return sample(p).gradient; }
    DistanceSample sample(const Vec3& p) const override;
    double error_bound() const override { return error_bound_; }

private:
    /// Where a point falls: its cell and the place in it, after moving it to the nearest point of the box.
    struct Cell {
        const float* corner;
        double u, v, w;
        Vec3 outside;  ///< [m], from the box to the point; zero within
    };
    Cell locate(const Vec3& p) const;
    double interpolate(const Cell& cell) const;
    void fill_exactly(const SignedDistance& exact);
    void fill_band(const SignedDistance& exact);
    double measure_error(const SignedDistance& exact) const;
    std::size_t points() const { return nx_ * ny_ * nz_; }
    Vec3 point(std::size_t i, std::size_t j, std::size_t k) const {
        return origin_ + voxel_ * Vec3(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k));
    }

    double voxel_ = 0.0, inverse_voxel_ = 0.0;
    Vec3 origin_ = Vec3::Zero();
    GridFill fill_;
    std::size_t nx_ = 0, ny_ = 0, nz_ = 0;                      ///< points along each axis
    std::vector<float> distance_;                               ///< [m], x runs fastest
    double trusted_ = std::numeric_limits<double>::infinity();  ///< [m], larger interpolated values are asked of the exact query
    std::shared_ptr<const SignedDistance> exact_;               ///< kept with a band only
    double error_bound_ = 0.0;
};

GridDistance::GridDistance(const TriangleMesh& mesh, double voxel, GridFill fill, std::shared_ptr<const SignedDistance> exact)
    : voxel_(voxel), inverse_voxel_(1.0 / voxel), fill_(fill) {
    const Box box = bounding_box(mesh);
    const double smallest = box.sizes().minCoeff();
    if (!(voxel > 0.0) || !(voxel <= 0.25 * smallest))
        throw bad_input("the voxel of a distance grid must be positive and at most a quarter of the body's smallest extent, " + std::to_string(smallest * 1e3) +
                            " mm, but it is " + std::to_string(voxel * 1e3) + " mm",
                        "choose about 1/40 of the extent");
    const double rim = std::max(rim_share * smallest, rim_voxels * voxel);
    // Whole voxels, centred on the body, so that a symmetric body gets a symmetric grid.
    std::array<std::size_t, 3> count{};
    double total = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
        const double cells = std::ceil((box.sizes()[axis] + 2.0 * rim) * inverse_voxel_);
        total *= cells + 1.0;
        if (!(total <= most_voxels))
            throw bad_input("a distance grid of voxels of " + std::to_string(voxel * 1e3) + " mm would need more than 512 million of them",
                            "choose a larger voxel");
        count[static_cast<std::size_t>(axis)] = static_cast<std::size_t>(cells) + 1;
        origin_[axis] = box.center()[axis] - 0.5 * cells * voxel;
    }
    nx_ = count[0];
    ny_ = count[1];
    nz_ = count[2];
    exact_ = exact ? std::move(exact) : exact_signed_distance(mesh);  // which also refuses open meshes
    if (fill == GridFill::exact_query) {
        fill_exactly(*exact_);
        error_bound_ = measure_error(*exact_);
        exact_.reset();
    } else {
        if (fill == GridFill::openvdb)
            distance_ = detail::openvdb_distances(mesh, {origin_, voxel_, count}, band_voxels);
        else
            fill_band(*exact_);
        trusted_ = (band_voxels - std::sqrt(3.0)) * voxel_;  // then all corners of the cell lie in the band
        error_bound_ = measure_error(*exact_);
    }
}

void GridDistance::fill_exactly(const SignedDistance& exact) {
    distance_.resize(points());
    parallel_for(ny_ * nz_, 4, [&](std::size_t row) {
        float* out = distance_.data() + row * nx_;
        for (std::size_t i = 0; i < nx_; ++i) out[i] = static_cast<float>(exact.value(point(i, row % ny_, row / ny_)));
    });
}

// A distance changes by no more than the way gone: far from the surface most points of a row need no query.
void GridDistance::fill_band(const SignedDistance& exact) {
    const double width = band_voxels * voxel_;
    distance_.resize(points());
    parallel_for(ny_ * nz_, 4, [&](std::size_t row) {
        float* out = distance_.data() + row * nx_;
        for (std::size_t i = 0; i < nx_;) {
            const double d = exact.value(point(i, row % ny_, row / ny_));
            const double outside_band = std::abs(d) - width;
            out[i++] = static_cast<float>(outside_band > 0.0 ? std::copysign(width, d) : d);
            for (double next = voxel_; next < outside_band && i < nx_; next += voxel_) out[i++] = static_cast<float>(std::copysign(width, d));
        }
    });
}

GridDistance::Cell GridDistance::locate(const Vec3& p) const {
    const Vec3 upper(static_cast<double>(nx_ - 1), static_cast<double>(ny_ - 1), static_cast<double>(nz_ - 1));
    const Vec3 q = (p - origin_) * inverse_voxel_;
    const Vec3 inside = q.cwiseMax(0.0).cwiseMin(upper);
    const auto i = std::min(static_cast<std::size_t>(inside.x()), nx_ - 2), j = std::min(static_cast<std::size_t>(inside.y()), ny_ - 2),
               k = std::min(static_cast<std::size_t>(inside.z()), nz_ - 2);
    return {distance_.data() + (k * ny_ + j) * nx_ + i, inside.x() - static_cast<double>(i), inside.y() - static_cast<double>(j),
            inside.z() - static_cast<double>(k), (q - inside) * voxel_};
}

double GridDistance::value(const Vec3& p) const {
    const double interpolated = interpolate(locate(p));
    return std::abs(interpolated) < trusted_ ? interpolated : exact_->value(p);
}

double GridDistance::interpolate(const Cell& cell) const {
    const auto along_x = [&](const float* c) { return c[0] + cell.u * (static_cast<double>(c[1]) - c[0]); };
    const std::size_t row = nx_, layer = nx_ * ny_;
    const double a = along_x(cell.corner), b = along_x(cell.corner + row), c = along_x(cell.corner + layer), d = along_x(cell.corner + layer + row);
    const double low = a + cell.v * (b - a), high = c + cell.v * (d - c);
    return low + cell.w * (high - low) + cell.outside.norm();
}

DistanceSample GridDistance::sample(const Vec3& p) const {
    const Cell cell = locate(p);
    const std::size_t row = nx_, layer = nx_ * ny_;
    const float *c0 = cell.corner, *c1 = c0 + row, *c2 = c0 + layer, *c3 = c2 + row;
    const double d0 = static_cast<double>(c0[1]) - c0[0], d1 = static_cast<double>(c1[1]) - c1[0], d2 = static_cast<double>(c2[1]) - c2[0],
                 d3 = static_cast<double>(c3[1]) - c3[0];
    const double a = c0[0] + cell.u * d0, b = c1[0] + cell.u * d1, c = c2[0] + cell.u * d2, d = c3[0] + cell.u * d3;
    const double low = a + cell.v * (b - a), high = c + cell.v * (d - c);
    const double low_x = d0 + cell.v * (d1 - d0), high_x = d2 + cell.v * (d3 - d2);
    DistanceSample result;
    result.value = low + cell.w * (high - low);
    const double way = cell.outside.norm();
    if (!(std::abs(result.value + way) < trusted_)) return exact_->sample(p);
    result.gradient = Vec3(low_x + cell.w * (high_x - low_x), (b - a) + cell.w * ((d - c) - (b - a)), high - low) * inverse_voxel_;
    if (way > 0.0) {
        // Outside, the grid's value changes only along the axes on which the point was not moved.
        result.value += way;
        for (int axis = 0; axis < 3; ++axis)
            if (cell.outside[axis] != 0.0) result.gradient[axis] = cell.outside[axis] / way;
    }
    return result;
}

double GridDistance::measure_error(const SignedDistance& exact) const {
    const std::size_t cells_x = nx_ - 1, cells_y = ny_ - 1, cells = cells_x * cells_y * (nz_ - 1);
    const bool band = fill_ != GridFill::exact_query;
    const auto middle_of = [&](std::size_t cell) {
        return Vec3(point(cell % cells_x, cell / cells_x % cells_y, cell / (cells_x * cells_y)) + Vec3::Constant(0.5 * voxel_));
    };
    std::vector<std::size_t> asked;  // cells of the band; without one, all
    if (band) {
        for (std::size_t cell = 0; cell < cells; ++cell) {
            const std::size_t corner = (cell / (cells_x * cells_y) * ny_ + cell / cells_x % cells_y) * nx_ + cell % cells_x;
            if (std::abs(distance_[corner]) < trusted_) asked.push_back(cell);
        }
    }
    const std::size_t total = band ? asked.size() : cells, limit = band ? most_band_samples : most_samples;
    const std::size_t stride = std::max<std::size_t>(1, (total + limit - 1) / limit);
    struct Largest {
        double at_point = 0.0, in_middle = 0.0;
    };
    const Largest largest = parallel_reduce((total + stride - 1) / stride, 1024, Largest{},
                                            [&](std::size_t begin, std::size_t end) {
                                                Largest most;
                                                for (std::size_t s = begin; s < end; ++s) {
                                                    const Vec3 middle = middle_of(band ? asked[s * stride] : s * stride);
                                                    most.in_middle = std::max(most.in_middle, std::abs(value(middle) - exact.value(middle)));
                                                    if (fill_ != GridFill::openvdb) continue;  // the points are exact
                                                    const Vec3 corner = middle - Vec3::Constant(0.5 * voxel_);
                                                    most.at_point = std::max(most.at_point, std::abs(value(corner) - exact.value(corner)));
                                                }
                                                return most;
                                            },
                                            [](const Largest& a, const Largest& b) {
                                                return Largest{std::max(a.at_point, b.at_point), std::max(a.in_middle, b.in_middle)};
                                            });
    const double rounding = std::numeric_limits<float>::epsilon() * (voxel_ * static_cast<double>(nx_ + ny_ + nz_));
    // A distance changes by at most the way gone, and Σ w_i |x_i − p| over the eight corners is at most √3/2 voxels: no interpolation of exact corners errs
    // more.
    const double interpolation_limit = 0.5 * std::sqrt(3.0) * voxel_;
    const double factor = band ? band_safety : safety;
    return std::min(factor * std::max(largest.in_middle, largest.at_point), interpolation_limit + factor * largest.at_point) + rounding;
}

}  // namespace

std::unique_ptr<SignedDistance> grid_signed_distance(const TriangleMesh& mesh, double voxel_size, GridFill fill, std::shared_ptr<const SignedDistance> exact) {
    if (mesh.empty()) throw bad_input("a mesh without triangles has no distance", "pass the mesh through require_closed_body first");
    return std::make_unique<GridDistance>(mesh, voxel_size, fill, std::move(exact));
}

}  // namespace pelletlab::meshes
