#include "observables/detail/tester_cloud.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace pelletlab::observables::detail {

namespace {

constexpr double company = 1.5;          // distance of neighbours, in equivalent diameters
constexpr std::size_t company_size = 3;  // fewer than that: loose
constexpr double at_rest_on_baffle = 0.2;

/// Centres sorted into cells of the neighbour distance.
class CellList {
public:
    CellList(const std::vector<Vec3>& points, double cell) : points_(points), cell_(cell) {
        Box box;
        for (const Vec3& p : points) box.extend(p);
        origin_ = points.empty() ? Vec3(Vec3::Zero()) : Vec3(box.min());
        for (int k = 0; k < 3; ++k) size_[static_cast<std::size_t>(k)] = points.empty() ? 1 : static_cast<std::size_t>(box.sizes()[k] / cell) + 1;
        first_.assign(size_[0] * size_[1] * size_[2] + 1, 0);
        for (const Vec3& p : points) ++first_[index(p) + 1];
        for (std::size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
        members_.resize(points.size());
        std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
        for (std::size_t i = 0; i < points.size(); ++i) members_[next[index(points[i])]++] = i;
    }

    std::size_t neighbours(std::size_t i) const {
        std::size_t found = 0;
        const std::array<std::size_t, 3> at = cell_of(points_[i]);
        std::array<std::size_t, 3> low{}, high{};
        for (std::size_t k = 0; k < 3; ++k) low[k] = at[k] > 0 ? at[k] - 1 : 0, high[k] = std::min(size_[k] - 1, at[k] + 1);
        for (std::size_t x = low[0]; x <= high[0]; ++x)
            for (std::size_t y = low[1]; y <= high[1]; ++y)
                for (std::size_t z = low[2]; z <= high[2]; ++z) {
                    const std::size_t c = (z * size_[1] + y) * size_[0] + x;
                    for (std::size_t m = first_[c]; m < first_[c + 1]; ++m)
                        found += members_[m] != i && (points_[members_[m]] - points_[i]).squaredNorm() <= cell_ * cell_ ? 1 : 0;
                }
        return found;
    }

private:
    std::array<std::size_t, 3> cell_of(const Vec3& p) const {
        std::array<std::size_t, 3> at{};
        for (int k = 0; k < 3; ++k) at[static_cast<std::size_t>(k)] = static_cast<std::size_t>((p[k] - origin_[k]) / cell_);
        return at;
    }
    std::size_t index(const Vec3& p) const {
        const std::array<std::size_t, 3> at = cell_of(p);
        return (at[2] * size_[1] + at[1]) * size_[0] + at[0];
    }

    const std::vector<Vec3>& points_;
    double cell_;
    Vec3 origin_;
    std::array<std::size_t, 3> size_{};
    std::vector<std::size_t> first_, members_;
};

}  // namespace

void add_end_view(std::vector<double>& volume, const ViewGrid& grid, const TrajectoryHeader& header, const Frame& frame,
                  const std::vector<PelletPoints>& shapes) {
    for (std::size_t body = 0; body < frame.positions.size(); ++body) {
        if (!frame.is_seen(body)) continue;
        const PelletPoints& shape = shapes[header.shape_of_body[body]];
        const Pose pose{frame.positions[body], frame.orientations[body]};
        const double each = shape.volume / static_cast<double>(shape.points_body.size());
        for (const Vec3& point : shape.points_body) {
            const Vec3 p = pose.to_world(point);
            std::size_t cell = 0;
            if (grid.locate(p.x(), p.z(), cell)) volume[cell] += each;
        }
    }
}

double loose_share(const TrajectoryHeader& header, const Frame& frame, const std::vector<PelletPoints>& shapes) {
    std::vector<Vec3> centres;
    double diameter = 0.0;
    for (std::size_t body = 0; body < frame.positions.size(); ++body) {
        if (!frame.is_seen(body)) continue;
        centres.push_back(frame.positions[body]);
        diameter += shapes[header.shape_of_body[body]].equivalent_diameter;
    }
    if (centres.empty()) return not_known;
    const CellList cells(centres, company * diameter / static_cast<double>(centres.size()));
    std::size_t loose = 0;
    for (std::size_t i = 0; i < centres.size(); ++i) loose += cells.neighbours(i) < company_size ? 1 : 0;
    return static_cast<double>(loose) / static_cast<double>(centres.size());
}

Vec3 centre_of_pellets(const TrajectoryHeader& header, const Frame& frame, const std::vector<PelletPoints>& shapes) {
    Vec3 sum = Vec3::Zero();
    double volume = 0.0;
    for (std::size_t body = 0; body < frame.positions.size(); ++body) {
        if (!frame.is_seen(body)) continue;
        const double v = shapes[header.shape_of_body[body]].volume;
        sum += v * frame.positions[body];
        volume += v;
    }
    return volume > 0.0 ? Vec3(sum / volume) : Vec3::Constant(not_known);
}

std::size_t carried_by_baffle(const Frame& frame, const TesterGeometry& tester, double angle) {
    // A drum that turns about −y is mirrored first, x → −x: then the baffle always goes down, left, up, right.
    const double mirror = tester.rotation_speed < 0.0 ? -1.0 : 1.0, omega = std::abs(tester.rotation_speed);
    const double out_x = -std::sin(angle), out_z = -std::cos(angle), ahead_x = -std::cos(angle), ahead_z = std::sin(angle);
    const double slow = at_rest_on_baffle * omega * tester.radius;
    std::size_t carried = 0;
    for (std::size_t body = 0; body < frame.positions.size(); ++body) {
        if (!frame.is_tracked(body)) continue;
        const double x = mirror * frame.positions[body].x(), z = frame.positions[body].z();
        const double out = x * out_x + z * out_z, ahead = x * ahead_x + z * ahead_z;
        if (out < tester.radius - tester.baffle_height || ahead < 0.0 || ahead > tester.baffle_height) continue;
        // ω × p of a turn about +y: (ω z, −ω x).
        const double u = mirror * frame.velocities[body].x() - omega * z, w = frame.velocities[body].z() + omega * x;
        carried += std::hypot(u, frame.velocities[body].y(), w) < slow ? 1 : 0;
    }
    return carried;
}

double release_angle(std::span<const double> angle, std::span<const double> load, double share) {
    std::vector<double> at, pellets;
    for (std::size_t k = 0; k < angle.size(); ++k)
        if (std::isfinite(load[k])) at.push_back(angle[k]), pellets.push_back(load[k]);
    if (pellets.size() < 2) return not_known;
    const auto top = static_cast<std::size_t>(std::max_element(pellets.begin(), pellets.end()) - pellets.begin());
    if (pellets[top] < 1.0) return not_known;
    const double level = share * pellets[top];
    for (std::size_t step = 1; step < pellets.size(); ++step) {
        const std::size_t k = (top + step) % pellets.size(), before = (top + step - 1) % pellets.size();
        if (pellets[k] > level) continue;
        const double from = at[before] + (before < top ? 2.0 * std::numbers::pi : 0.0), to = at[k] + (k < top ? 2.0 * std::numbers::pi : 0.0);
        return from + (to - from) * (pellets[before] - level) / (pellets[before] - pellets[k]);
    }
    return not_known;
}

}  // namespace pelletlab::observables::detail
