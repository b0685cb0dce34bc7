#include "shapegen/detail/few_spheres.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/random.hpp"
#include "shapegen/detail/match_moments.hpp"
#include "shapegen/detail/medial_balls.hpp"
#include "shapegen/detail/seeding.hpp"
#include "shapegen/detail/settle.hpp"
#include "shapegen/detail/true_loss.hpp"

namespace pelletlab::shapegen::detail {

namespace {

constexpr std::uint64_t random_starts = 2;
constexpr std::uint32_t most_trials = 12;
constexpr std::size_t few_points = 2500;  // enough to tell which start is best

class FewSearch {
public:
    FewSearch(const SampleBlocks& coarse, const SampleBlocks& fine, const ModeContext& context, std::size_t points, const RelocationSettings& settings,
              const MatchSettings& match)
        : coarse_(coarse), fine_(fine), context_(context), points_(points), settings_(settings), match_(match) {}

    FewSpheresResult run(std::size_t count) {
        for (std::size_t n = 1; n <= count; ++n) {
            const std::vector<Sphere> fewer = result_.spheres;
            const double loss_of_fewer = result_.loss;
            best_ = std::numeric_limits<double>::infinity();
            if (n > 1) {
                const std::vector<Sphere> grown = with_ball_at_largest_gap(fewer);
                refine(grown);
                search(grown);
                refine(with_one_cut_in_two(fewer));
                for (std::uint64_t k = 0; k < random_starts; ++k) search(random_balls(n, k));
            }
            search(seed_by_gaps(coarse_, context_.distance, {n, settings_.min_radius, settings_.largest_radius, settings_.tolerance}));
            for (int axis = 0; axis < 3; ++axis) {
                std::vector<Sphere> row = row_along(axis, n);
                if (!row.empty()) refine(std::move(row));
            }
            finish();
            if (n > 1 && result_.loss > loss_of_fewer) {  // one more sphere that does not show is no worse
                result_.spheres = fewer;
                result_.spheres.push_back(hidden_in(fewer));
                result_.loss = loss_of_fewer;
            }
            if (n < count) result_.fewer.push_back(result_.spheres);
        }
        return std::move(result_);
    }

private:
    // Both keep what these spheres become if that is better than what is kept: minimising as they are, or after a search for better places.
    void refine(std::vector<Sphere> spheres) {
        throw_if_interrupted();
        SymmetricLoss loss(fine_, context_.distance, spheres, context_.moments, std::min(points_, few_points));
        result_.iterations += polish(spheres, loss, context_, 30, 1e-3).iterations;
        match_moments(spheres, context_.moments, match_);
        const double loss_now = true_loss(spheres, fine_, context_.distance, few_points);
        if (loss_now >= best_) return;
        best_ = loss_now;
        result_.spheres = std::move(spheres);
    }

    // The last stage of the mode mean for the best start, where that leads to something better.
    void finish() {
        std::vector<Sphere> spheres = result_.spheres;
        const MinimiserResult polished = fit_mean(spheres, context_, fine_, points_);
        result_.iterations += polished.iterations;
        result_.converged = polished.converged;
        match_moments(spheres, context_.moments, match_);
        const double before = true_loss(result_.spheres, fine_, context_.distance, fine_.size());
        result_.loss = true_loss(spheres, fine_, context_.distance, fine_.size());
        if (result_.loss < before) {
            result_.spheres = std::move(spheres);
        } else {
            result_.loss = before;
        }
    }

    void search(std::vector<Sphere> spheres) {
        throw_if_interrupted();
        RelocationSettings settings = settings_;
        settings.trials = std::min(settings.trials, most_trials);
        settle_all(spheres, settings.slack);
        const RelocationResult moved = relocate(spheres, coarse_, context_.distance, settings);
        result_.iterations += moved.iterations;
        result_.relocations += moved.accepted;
        refine(std::move(spheres));
    }

    Sphere ball_at(std::size_t k) const {
        const Vec3 &p = coarse_.points[k], &n = coarse_.normals[k];
        const double r =
            std::max({settings_.min_radius, 2.0 * settings_.tolerance, medial_radius(context_.distance, p, n, settings_.largest_radius, settings_.tolerance)});
        return {p - r * n, r};
    }

    std::vector<Sphere> with_ball_at_largest_gap(std::vector<Sphere> spheres) const {
        GapLoss loss(coarse_, spheres);
        loss.evaluate(pack(spheres), nullptr, nullptr);
        const auto worst = std::max_element(loss.gaps().begin(), loss.gaps().end());
        spheres.push_back(ball_at(static_cast<std::size_t>(worst - loss.gaps().begin())));
        return spheres;
    }

    // The sphere with the largest share of the loss becomes two, a little apart along the direction in which its gaps lie.
    std::vector<Sphere> with_one_cut_in_two(std::vector<Sphere> spheres) const {
        GapLoss loss(coarse_, spheres);
        loss.evaluate(pack(spheres), nullptr, nullptr);
        std::vector<double> share(spheres.size(), 0.0);
        std::vector<Mat3> spread(spheres.size(), Mat3::Zero());
        for (std::size_t k = 0; k < coarse_.size(); ++k) {
            const std::uint32_t owner = loss.nearest()[k];
            const double square = loss.gaps()[k] * loss.gaps()[k];
            const Vec3 way = (coarse_.points[k] - spheres[owner].centre).normalized();
            share[owner] += square;
            if (loss.gaps()[k] > 0.0) spread[owner] += square * way * way.transpose();
        }
        const auto most = static_cast<std::size_t>(std::max_element(share.begin(), share.end()) - share.begin());
        const Vec3 along = Eigen::SelfAdjointEigenSolver<Mat3>(spread[most]).eigenvectors().col(2);
        Sphere other = spheres[most];
        spheres[most].centre += 0.15 * other.radius * along;
        other.centre -= 0.15 * other.radius * along;
        spheres.push_back(other);
        return spheres;
    }

    std::vector<Sphere> random_balls(std::size_t count, std::uint64_t start) const {
        RandomStream random(settings_.seed, 0xfe3000000000u + 1000 * start + count);
        std::vector<Sphere> spheres;
        for (std::size_t k = 0; k < count; ++k)
            spheres.push_back(ball_at(std::min(coarse_.size() - 1, static_cast<std::size_t>(random.uniform() * static_cast<double>(coarse_.size())))));
        return spheres;
    }

    // Spheres side by side on a principal axis of the body, as large as the body allows, then together so large that they have its volume (Favier et al. 1999;
    // key favier1999). None when the axis leaves the body there.
    std::vector<Sphere> row_along(int axis, std::size_t count) const {
        const Vec3 along = Eigen::SelfAdjointEigenSolver<Mat3>(context_.moments.covariance).eigenvectors().col(axis);
        double low = std::numeric_limits<double>::infinity(), high = -low;
        for (const Vec3& p : coarse_.points) {
            low = std::min(low, along.dot(p));
            high = std::max(high, along.dot(p));
        }
        std::vector<Sphere> spheres;
        for (std::size_t k = 0; k < count; ++k) {
            const Vec3 centre = (low + (high - low) * (static_cast<double>(k) + 0.5) / static_cast<double>(count)) * along;
            const double depth = -context_.distance.value(centre);
            if (depth <= 0.0) return {};
            spheres.push_back({centre, std::max(depth, settings_.min_radius)});
        }
        match_moments(spheres, context_.moments, {true, false, settings_.min_radius, 0.0});
        return spheres;
    }

    Sphere hidden_in(const std::vector<Sphere>& spheres) const {
        Sphere inner = *std::max_element(spheres.begin(), spheres.end(), [](const Sphere& a, const Sphere& b) { return a.radius < b.radius; });
        inner.radius = std::max(0.5 * inner.radius, std::min(settings_.min_radius, 0.99 * inner.radius));
        return inner;
    }

    void settle_all(std::vector<Sphere>& spheres, double& slack) {
        GapLoss loss(coarse_, spheres);
        loss.evaluate(pack(spheres), nullptr, nullptr);
        slack = 2.0 * std::sqrt(loss.gap_part());
        loss.contain({&context_.distance, slack});
        result_.iterations += settle(loss, {60, 1e-3, context_.min_radius, 0.05}).iterations;
        loss.copy_spheres(spheres);
    }

    const SampleBlocks &coarse_, &fine_;
    const ModeContext& context_;
    std::size_t points_;
    RelocationSettings settings_;
    MatchSettings match_;
    double best_ = std::numeric_limits<double>::infinity();
    FewSpheresResult result_;
};

}  // namespace

FewSpheresResult fit_few(std::size_t count, const SampleBlocks& coarse, const SampleBlocks& fine, const ModeContext& context, std::size_t points,
                         const RelocationSettings& settings, const MatchSettings& match) {
    return FewSearch(coarse, fine, context, points, settings, match).run(count);
}

}  // namespace pelletlab::shapegen::detail
