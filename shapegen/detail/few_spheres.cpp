#include "shapegen/detail/few_spheres.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/random.hpp"
#include "shapegen/detail/medial_balls.hpp"
#include "shapegen/detail/seeding.hpp"
#include "shapegen/detail/settle.hpp"

namespace pelletlab::shapegen::detail {

namespace {

constexpr std::uint64_t random_starts = 3;
constexpr std::uint32_t most_trials = 12;
constexpr std::size_t most_points = 2500;  // enough to tell which start is best

class FewSearch {
public:
    FewSearch(const SampleBlocks& coarse, const SampleBlocks& fine, const ModeContext& context, std::size_t points, const RelocationSettings& settings)
        : coarse_(coarse), fine_(fine), context_(context), points_(points), settings_(settings) {}

    // Keeps what these spheres become if that is better than what is kept.
    void attempt(std::vector<Sphere> spheres) {
        throw_if_interrupted();
        RelocationSettings settings = settings_;
        settings.trials = std::min(settings.trials, most_trials);
        settle_all(coarse_, spheres, settings.slack);
        const RelocationResult moved = relocate(spheres, coarse_, context_.distance, settings);
        result_.iterations += moved.iterations;
        settle_all(fine_, spheres, settings.slack);
        SymmetricLoss loss(fine_, context_.distance, spheres, context_.moments, std::min(points_, most_points));
        const MinimiserResult polished = polish(spheres, loss, context_, 20, 1e-3);
        result_.iterations += polished.iterations;
        if (polished.loss >= best_) return;
        best_ = polished.loss;
        result_.spheres = std::move(spheres);
        result_.relocations = moved.accepted;
    }

    Sphere ball_at(std::size_t k) const {
        const Vec3 &p = coarse_.points[k], &n = coarse_.normals[k];
        const double r =
            std::max({settings_.min_radius, 2.0 * settings_.tolerance, medial_radius(context_.distance, p, n, settings_.largest_radius, settings_.tolerance)});
        return {p - r * n, r};
    }

    // The best of one less and the ball at its largest gap.
    std::vector<Sphere> grown() const {
        std::vector<Sphere> spheres = result_.spheres;
        GapLoss loss(coarse_, spheres);
        loss.evaluate(pack(spheres), nullptr, nullptr);
        const auto worst = std::max_element(loss.gaps().begin(), loss.gaps().end());
        spheres.push_back(ball_at(static_cast<std::size_t>(worst - loss.gaps().begin())));
        return spheres;
    }

    std::vector<Sphere> random_balls(std::size_t count, std::uint64_t start) const {
        RandomStream random(settings_.seed, 0xfe3000000000u + 1000 * start + count);
        std::vector<Sphere> spheres;
        for (std::size_t k = 0; k < count; ++k)
            spheres.push_back(ball_at(std::min(coarse_.size() - 1, static_cast<std::size_t>(random.uniform() * static_cast<double>(coarse_.size())))));
        return spheres;
    }

    FewSpheresResult run(std::size_t count) {
        for (std::size_t n = 1; n <= count; ++n) {
            const std::vector<Sphere> start = n > 1 ? grown() : std::vector<Sphere>{};
            best_ = std::numeric_limits<double>::infinity();
            if (n > 1) attempt(start);
            attempt(seed_by_gaps(coarse_, context_.distance, {n, settings_.min_radius, settings_.largest_radius, settings_.tolerance}));
            for (std::uint64_t k = 0; k < random_starts && n > 1; ++k) attempt(random_balls(n, k));
        }
        return std::move(result_);
    }

private:
    void settle_all(const SampleBlocks& samples, std::vector<Sphere>& spheres, double& slack) {
        GapLoss loss(samples, spheres);
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
    double best_ = 0.0;
    FewSpheresResult result_;
};

}  // namespace

FewSpheresResult fit_few(std::size_t count, const SampleBlocks& coarse, const SampleBlocks& fine, const ModeContext& context, std::size_t points,
                         const RelocationSettings& settings) {
    return FewSearch(coarse, fine, context, points, settings).run(count);
}

}  // namespace pelletlab::shapegen::detail
