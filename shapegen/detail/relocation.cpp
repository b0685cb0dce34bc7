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

// The state of the fit between two rounds.
struct Survey {
    double loss = 0.0;
    std::vector<double> gap;                        // one a point
    std::vector<std::uint32_t> nearest;             // one a point
    std::vector<double> block_largest;              // largest gap of a block, not below 0
    std::vector<double> group_largest;              // and of a group of blocks
    std::vector<double> removal_cost;               // growth of Σwφ² if the sphere vanished and nothing else moved
    std::vector<std::uint32_t> by_cost;             // spheres, the least useful one first
    std::vector<std::vector<std::uint32_t>> cells;  // blocks in which a sphere is nearest to a point
    std::vector<std::vector<std::uint32_t>> reach;  // blocks in which it is a candidate
    std::vector<double> weight_below;               // running sum of (w gap²)², to draw a point from
};

Survey survey(const std::vector<Sphere>& spheres, const SampleBlocks& samples, const Containment& containment) {
    Survey state;
    GapLoss loss(samples, spheres);
    loss.contain(containment);
    state.loss = loss.evaluate(pack(spheres), nullptr, nullptr);
    state.gap = loss.gaps();
    state.nearest = loss.nearest();
    state.block_largest.assign(samples.block_count(), 0.0);
    state.group_largest.assign(samples.group_count(), 0.0);
    state.removal_cost.assign(spheres.size(), 0.0);
    state.cells.resize(spheres.size());
    state.reach.resize(spheres.size());
    state.weight_below.resize(samples.size());
    std::vector<double> second(samples.size());
    parallel_for(samples.block_count(), 256, [&](std::size_t b) {
        for (std::size_t k = b * width; k < (b + 1) * width; ++k) {
            double least = std::numeric_limits<double>::infinity();
            for (const std::uint32_t i : loss.candidates(b)) {
                if (i == state.nearest[k]) continue;
                const double limit = least + spheres[i].radius;
                const double squared = (samples.points[k] - spheres[i].centre).squaredNorm();
                if (squared < limit * limit) least = std::sqrt(squared) - spheres[i].radius;
            }
            // Without another candidate the second gap is at least the margin beyond the first.
            second[k] = std::isfinite(least) ? least : state.gap[k] + 2.0 * loss.margin();
        }
    });
    double running = 0.0;
    for (std::size_t b = 0; b < samples.block_count(); ++b) {
        const auto block = static_cast<std::uint32_t>(b);
        for (const std::uint32_t i : loss.candidates(b)) state.reach[i].push_back(block);
        for (std::size_t k = b * width; k < (b + 1) * width; ++k) {
            const std::uint32_t owner = state.nearest[k];
            state.removal_cost[owner] += samples.weight[k] * (second[k] * second[k] - state.gap[k] * state.gap[k]);
            if (state.cells[owner].empty() || state.cells[owner].back() != block) state.cells[owner].push_back(block);
            const double g = std::max(0.0, state.gap[k]);
            state.block_largest[b] = std::max(state.block_largest[b], g);
            running += samples.weight[k] * samples.weight[k] * g * g * g * g;
            state.weight_below[k] = running;
        }
        double& of_group = state.group_largest[b / SampleBlocks::group];
        of_group = std::max(of_group, state.block_largest[b]);
    }
    state.by_cost.resize(spheres.size());
    std::iota(state.by_cost.begin(), state.by_cost.end(), 0u);
    std::stable_sort(state.by_cost.begin(), state.by_cost.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return state.removal_cost[a] < state.removal_cost[b]; });
    return state;
}

// Fall of Σwφ² if `ball` were added and nothing else moved; the blocks that it changes.
double insertion_gain(const Sphere& ball, const Survey& state, const SampleBlocks& samples, std::vector<std::uint32_t>& touched) {
    touched.clear();
    double gain = 0.0;
    for (std::size_t g = 0; g < samples.group_count(); ++g) {
        const Vec3 middle(samples.group_x[g], samples.group_y[g], samples.group_z[g]);
        if ((middle - ball.centre).norm() - ball.radius - samples.group_radius[g] > state.group_largest[g]) continue;
        const std::size_t last = std::min(samples.block_count(), (g + 1) * SampleBlocks::group);
        for (std::size_t b = g * SampleBlocks::group; b < last; ++b) {
            const Vec3 m(samples.ball_x[b], samples.ball_y[b], samples.ball_z[b]);
            if ((m - ball.centre).norm() - ball.radius - samples.ball_radius[b] > state.block_largest[b]) continue;
            bool changed = false;
            for (std::size_t k = b * width; k < (b + 1) * width; ++k) {
                const double gap = (samples.points[k] - ball.centre).norm() - ball.radius;
                if (gap >= state.gap[k]) continue;
                gain += samples.weight[k] * (state.gap[k] * state.gap[k] - gap * gap);
                changed = true;
            }
            if (changed) touched.push_back(static_cast<std::uint32_t>(b));
        }
    }
    return gain;
}

// One change to try: who goes where, who may move with it, and which blocks that concerns.
struct Trial {
    std::uint32_t idle = 0;
    Sphere ball;
    std::vector<std::uint32_t> free_spheres, blocks;
    double before = 0.0;  // loss of those blocks now
    double after = std::numeric_limits<double>::infinity();
    std::uint32_t iterations = 0;
    std::vector<Sphere> moved;  // the free spheres afterwards
};

void add_owners(const std::vector<std::uint32_t>& blocks, const std::vector<std::uint32_t>& nearest, std::vector<std::uint8_t>& member) {
    for (const std::uint32_t b : blocks) {
        for (std::size_t k = b * width; k < (b + 1) * width; ++k) member[nearest[k]] = 1;
    }
}

// Draws an idle sphere and the best of a few medial balls at points drawn by gap⁴. False when there is nothing to gain.
bool propose(const Survey& state, const SampleBlocks& samples, const meshes::SignedDistance& distance, const RelocationSettings& settings, std::uint64_t number,
             Trial& trial) {
    RandomStream random(settings.seed, 0x7e1e00000000u + number);
    const std::size_t n = state.by_cost.size();
    const double pool = std::min(static_cast<double>(n), std::max(4.0, 0.25 * static_cast<double>(n)));
    trial.idle = state.by_cost[static_cast<std::size_t>(random.uniform() * random.uniform() * pool)];
    const double smallest = std::max(settings.min_radius, 2.0 * settings.tolerance);
    std::vector<std::uint32_t> touched, best_touched;
    double best_gain = 0.0;
    for (int k = 0; k < 6; ++k) {
        const double target = random.uniform() * state.weight_below.back();
        const auto at = static_cast<std::size_t>(std::lower_bound(state.weight_below.begin(), state.weight_below.end(), target) - state.weight_below.begin());
        if (at >= samples.size() || state.nearest[at] == trial.idle) continue;
        const Vec3 &p = samples.points[at], &normal = samples.normals[at];
        const double r = std::max(smallest, medial_radius(distance, p, normal, settings.largest_radius, settings.tolerance));
        const Sphere candidate{p - r * normal, r};
        const double gain = insertion_gain(candidate, state, samples, touched);
        if (gain > best_gain) {
            best_gain = gain;
            trial.ball = candidate;
            best_touched = touched;
        }
    }
    if (best_gain < 0.05 * state.removal_cost[trial.idle]) return false;

    // Who takes part: the two neighbourhoods and one ring around them; which blocks count: all that one of them may reach.
    std::vector<std::uint8_t> member(n, 0);
    member[trial.idle] = 1;
    add_owners(state.cells[trial.idle], state.nearest, member);
    add_owners(best_touched, state.nearest, member);
    std::vector<std::uint8_t> wider = member;
    for (std::size_t i = 0; i < n; ++i) {
        if (member[i]) add_owners(state.cells[i], state.nearest, wider);
    }
    std::vector<std::uint8_t> counted(samples.block_count(), 0);
    for (std::size_t i = 0; i < n; ++i) {
        if (!wider[i]) continue;
        trial.free_spheres.push_back(static_cast<std::uint32_t>(i));
        for (const std::uint32_t b : state.reach[i]) counted[b] = 1;
    }
    for (const std::uint32_t b : best_touched) counted[b] = 1;
    for (std::size_t b = 0; b < counted.size(); ++b) {
        if (!counted[b]) continue;
        trial.blocks.push_back(static_cast<std::uint32_t>(b));
        for (std::size_t k = b * width; k < (b + 1) * width; ++k) trial.before += samples.weight[k] * state.gap[k] * state.gap[k];
    }
    trial.before /= static_cast<double>(samples.size());
    return true;
}

double containment_cost(const Sphere& sphere, const Containment& containment, std::size_t spheres) {
    const double excess = std::max(0.0, sphere.radius + containment.distance->value(sphere.centre) - containment.slack);
    return 2.0 * excess * excess / static_cast<double>(spheres);
}

void attempt(Trial& trial, std::vector<Sphere> spheres, const SampleBlocks& samples, const Containment& containment, const RelocationSettings& settings) {
    for (const std::uint32_t i : trial.free_spheres) trial.before += containment_cost(spheres[i], containment, spheres.size());
    spheres[trial.idle] = trial.ball;
    GapLoss local(samples, spheres, trial.free_spheres, trial.blocks);
    local.contain(containment);
    SettleSettings settle_settings;
    settle_settings.iterations = settings.local_iterations;
    settle_settings.tolerance = 2e-3;
    settle_settings.min_radius = settings.min_radius;
    settle_settings.give_up_above = trial.before;
    const MinimiserResult settled = settle(local, settle_settings);
    trial.iterations = settled.iterations;
    trial.after = settled.loss;
    local.copy_spheres(spheres);
    for (const std::uint32_t i : trial.free_spheres) trial.moved.push_back(spheres[i]);
}

}  // namespace

RelocationResult relocate(std::vector<Sphere>& spheres, const SampleBlocks& samples, const meshes::SignedDistance& distance,
                          const RelocationSettings& settings) {
    RelocationResult result;
    const std::size_t n = spheres.size();
    if (n < 2) return result;
    const Containment containment{&distance, settings.slack};
    Survey state = survey(spheres, samples, containment);
    std::uint32_t since_settled = 0;
    const std::size_t widest = std::max<std::size_t>(1, n / 64);  // trials of a round; they share no block, so they run side by side
    while (result.trials < settings.trials) {
        throw_if_interrupted();
        std::vector<Trial> round;
        std::vector<std::uint8_t> taken(samples.block_count(), 0);
        for (std::size_t k = 0; k < 2 * widest && round.size() < widest && result.trials < settings.trials; ++k) {
            Trial trial;
            if (!propose(state, samples, distance, settings, result.trials++, trial)) continue;
            if (std::any_of(trial.blocks.begin(), trial.blocks.end(), [&](std::uint32_t b) { return taken[b] != 0; })) continue;
            for (const std::uint32_t b : trial.blocks) taken[b] = 1;
            round.push_back(std::move(trial));
        }
        if (round.empty()) continue;
        parallel_for(round.size(), 1, [&](std::size_t k) { attempt(round[k], spheres, samples, containment, settings); });
        std::vector<Sphere> next = spheres;
        std::uint32_t accepted = 0;
        for (const Trial& trial : round) {
            result.iterations += trial.iterations;
            if (trial.after >= trial.before) continue;
            for (std::size_t k = 0; k < trial.free_spheres.size(); ++k) next[trial.free_spheres[k]] = trial.moved[k];
            ++accepted;
        }
        if (accepted == 0) continue;
        since_settled += accepted;
        if (since_settled >= std::max<std::size_t>(8, n / 8)) {
            since_settled = 0;
            GapLoss all(samples, next);
            all.contain(containment);
            result.iterations += settle(all, {10, 2e-3, settings.min_radius, 0.05}).iterations;
            all.copy_spheres(next);
        }
        Survey after = survey(next, samples, containment);
        if (after.loss >= state.loss) continue;
        spheres = std::move(next);
        state = std::move(after);
        result.accepted += accepted;
    }
    result.loss = state.loss;
    return result;
}

}  // namespace pelletlab::shapegen::detail
