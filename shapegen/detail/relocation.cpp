#include "shapegen/detail/relocation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/parallel.hpp"
#include "core/random.hpp"
#include "shapegen/detail/gap_loss.hpp"
#include "shapegen/detail/lbfgs.hpp"
#include "shapegen/detail/medial_balls.hpp"
#include "shapegen/detail/settle.hpp"

namespace pelletlab::shapegen::detail {

namespace {

constexpr std::size_t width = SampleBlocks::width;

// The state of the fit between two trials.
struct Survey {
    double loss = 0.0;
    std::vector<double> gap;                        // one a point
    std::vector<std::uint32_t> nearest;             // one a point
    std::vector<double> removal_cost;               // growth of Σφ² if the sphere vanished and nothing else moved
    std::vector<std::vector<std::uint32_t>> cells;  // blocks in which a sphere is nearest to a point
    std::vector<std::vector<std::uint32_t>> reach;  // blocks in which it is a candidate
    std::vector<double> weight_below;               // running sum of gap⁴, to draw a point from
};

Survey survey(const std::vector<Sphere>& spheres, const SampleBlocks& samples) {
    Survey state;
    GapLoss loss(samples, spheres);
    state.loss = loss.evaluate(pack(spheres), nullptr, nullptr);
    state.gap = loss.gaps();
    state.nearest = loss.nearest();
    state.removal_cost.assign(spheres.size(), 0.0);
    state.cells.resize(spheres.size());
    state.reach.resize(spheres.size());
    state.weight_below.resize(samples.size());
    double running = 0.0;
    for (std::size_t b = 0; b < samples.block_count(); ++b) {
        const auto block = static_cast<std::uint32_t>(b);
        for (const std::uint32_t i : loss.candidates(b)) state.reach[i].push_back(block);
        for (std::size_t k = b * width; k < (b + 1) * width; ++k) {
            const std::uint32_t owner = state.nearest[k];
            double second = std::numeric_limits<double>::infinity();
            for (const std::uint32_t i : loss.candidates(b)) {
                if (i == owner) continue;
                const double limit = second + spheres[i].radius;
                const double squared = (samples.points[k] - spheres[i].centre).squaredNorm();
                if (squared < limit * limit) second = std::sqrt(squared) - spheres[i].radius;
            }
            // Without another candidate the second gap is at least the margin beyond the first.
            if (!std::isfinite(second)) second = state.gap[k] + 2.0 * loss.margin();
            state.removal_cost[owner] += second * second - state.gap[k] * state.gap[k];
            if (state.cells[owner].empty() || state.cells[owner].back() != block) state.cells[owner].push_back(block);
            const double g = std::max(0.0, state.gap[k]);
            running += g * g * g * g;
            state.weight_below[k] = running;
        }
    }
    return state;
}

// Fall of Σφ² if `ball` were added and nothing else moved; the blocks that it changes.
double insertion_gain(const Sphere& ball, const Survey& state, const SampleBlocks& samples, std::vector<std::uint32_t>& touched) {
    touched.clear();
    double gain = 0.0;
    for (std::size_t b = 0; b < samples.block_count(); ++b) {
        const Vec3 m(samples.ball_x[b], samples.ball_y[b], samples.ball_z[b]);
        const double block_gap = (m - ball.centre).norm() - ball.radius - samples.ball_radius[b];
        double largest = 0.0;
        for (std::size_t k = b * width; k < (b + 1) * width; ++k) largest = std::max(largest, state.gap[k]);
        if (block_gap > largest) continue;
        bool changed = false;
        for (std::size_t k = b * width; k < (b + 1) * width; ++k) {
            const double g = (samples.points[k] - ball.centre).norm() - ball.radius;
            if (g >= state.gap[k]) continue;
            gain += state.gap[k] * state.gap[k] - g * g;
            changed = true;
        }
        if (changed) touched.push_back(static_cast<std::uint32_t>(b));
    }
    return gain;
}

void add_owners(const std::vector<std::uint32_t>& blocks, const std::vector<std::uint32_t>& nearest, std::vector<std::uint8_t>& member) {
    for (const std::uint32_t b : blocks) {
        for (std::size_t k = b * width; k < (b + 1) * width; ++k) member[nearest[k]] = 1;
    }
}

}  // namespace

RelocationResult relocate(std::vector<Sphere>& spheres, const SampleBlocks& samples, const meshes::SignedDistance& distance,
                          const RelocationSettings& settings) {
    RelocationResult result;
    const std::size_t n = spheres.size();
    if (n < 2) return result;
    Survey state = survey(spheres, samples);
    result.loss = state.loss;
    std::vector<std::uint32_t> by_cost(n), touched, best_touched;
    const double smallest = std::max(settings.min_radius, 2.0 * settings.tolerance);
    std::uint32_t since_settled = 0;
    for (; result.trials < settings.trials; ++result.trials) {
        throw_if_interrupted();
        RandomStream random(settings.seed, 0x7e1e0000u + result.trials);
        std::iota(by_cost.begin(), by_cost.end(), 0u);
        std::sort(by_cost.begin(), by_cost.end(), [&](std::uint32_t a, std::uint32_t b) { return state.removal_cost[a] < state.removal_cost[b]; });
        const double pool = std::min(static_cast<double>(n), std::max(4.0, 0.25 * static_cast<double>(n)));
        const std::uint32_t idle = by_cost[static_cast<std::size_t>(random.uniform() * random.uniform() * pool)];

        // The best of a few medial balls at points drawn by gap⁴.
        Sphere ball;
        double best_gain = -1.0;
        for (int k = 0; k < 6; ++k) {
            const double target = random.uniform() * state.weight_below.back();
            const auto at =
                static_cast<std::size_t>(std::lower_bound(state.weight_below.begin(), state.weight_below.end(), target) - state.weight_below.begin());
            if (at >= samples.size() || state.nearest[at] == idle) continue;
            const Vec3 &p = samples.points[at], &normal = samples.normals[at];
            const double r = std::max(smallest, medial_radius(distance, p, normal, settings.largest_radius, settings.tolerance));
            const Sphere candidate{p - r * normal, r};
            const double gain = insertion_gain(candidate, state, samples, touched);
            if (gain > best_gain) {
                best_gain = gain;
                ball = candidate;
                best_touched = touched;
            }
        }
        if (best_gain <= 0.0 || best_gain < 0.05 * state.removal_cost[idle]) continue;

        // Who takes part: the two neighbourhoods; which blocks count: all that one of them may reach.
        std::vector<std::uint8_t> member(n, 0);
        member[idle] = 1;
        add_owners(state.cells[idle], state.nearest, member);
        add_owners(best_touched, state.nearest, member);
        // One ring more.
        std::vector<std::uint8_t> wider = member;
        for (std::size_t i = 0; i < n; ++i) {
            if (member[i]) add_owners(state.cells[i], state.nearest, wider);
        }
        std::vector<std::uint32_t> free_spheres, blocks;
        std::vector<std::uint8_t> counted(samples.block_count(), 0);
        for (std::size_t i = 0; i < n; ++i) {
            if (!wider[i]) continue;
            free_spheres.push_back(static_cast<std::uint32_t>(i));
            for (const std::uint32_t b : state.reach[i]) counted[b] = 1;
        }
        for (const std::uint32_t b : best_touched) counted[b] = 1;
        double before = 0.0;
        for (std::size_t b = 0; b < counted.size(); ++b) {
            if (!counted[b]) continue;
            blocks.push_back(static_cast<std::uint32_t>(b));
            for (std::size_t k = b * width; k < (b + 1) * width; ++k) before += state.gap[k] * state.gap[k];
        }
        before /= static_cast<double>(samples.size());

        std::vector<Sphere> trial = spheres;
        trial[idle] = ball;
        GapLoss local(samples, trial, free_spheres, blocks);
        SettleSettings settle_settings;
        settle_settings.iterations = settings.local_iterations;
        settle_settings.tolerance = 2e-3;
        settle_settings.min_radius = settings.min_radius;
        const MinimiserResult settled = settle(local, settle_settings);
        result.iterations += settled.iterations;
        if (settled.loss >= before) continue;
        local.copy_spheres(trial);
        const Survey next = survey(trial, samples);
        if (next.loss >= state.loss) continue;
        spheres = std::move(trial);
        state = next;
        ++result.accepted;
        if (++since_settled == 8) {
            since_settled = 0;
            settle_settings.iterations = 10;
            GapLoss all(samples, spheres);
            result.iterations += settle(all, settle_settings).iterations;
            all.copy_spheres(spheres);
            state = survey(spheres, samples);
        }
        result.loss = state.loss;
    }
    return result;
}

}  // namespace pelletlab::shapegen::detail
