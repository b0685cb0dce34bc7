#include "diagnosis/rehearsal.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "core/parallel.hpp"

namespace pelletlab::diagnosis {

namespace {

constexpr std::array<double, 3> shares{0.40, 0.45, 0.15};  // of cases without, with one and with two effects

/// θ from the half-normal prior cut at 1 (both signs for two-sided effects).
double draw_amplitude(RandomStream& random, double width, bool two_sided) {
    for (;;) {
        const double t = width * random.normal();
        if (std::abs(t) <= 1.0) return two_sided ? t : std::abs(t);
    }
}

RehearsedCase judged(const Attributor& attributor, const Eigen::VectorXd& y, std::size_t truth, std::uint64_t seed) {
    RehearsedCase one;
    one.truth = truth;
    one.attribution = attribute(attributor, y, 1.0, attributor.problem().experiment.settings.bootstrap, seed);
    one.attribution.fits.clear();
    return one;
}

RehearsedCase simulate(const Attributor& attributor, std::uint64_t seed, std::uint64_t stream) {
    const Problem& problem = attributor.problem();
    const auto& hypotheses = attributor.hypotheses();
    RandomStream random(seed, stream);
    const double u = random.uniform();
    const std::size_t wanted = u < shares[0] ? 0 : u < shares[0] + shares[1] ? 1 : 2;
    std::vector<std::size_t> pool;
    for (std::size_t h = 0; h < hypotheses.size(); ++h)
        if (!hypotheses[h].open && hypotheses[h].effects.size() == wanted) pool.push_back(h);
    const std::size_t truth = pool.empty() ? 0 : pool[static_cast<std::size_t>(random.uniform() * static_cast<double>(pool.size()))];
    Eigen::VectorXd phi = problem.phi_lower, theta = Eigen::VectorXd::Zero(problem.model->effects());
    for (Eigen::Index i = 0; i < phi.size(); ++i) phi[i] += random.uniform() * (problem.phi_upper[i] - problem.phi_lower[i]);
    for (const int e : hypotheses[truth].effects) {
        const auto& effect = problem.model->effect(e);
        theta[e] = draw_amplitude(random, 0.55, effect.two_sided);
    }
    const inference::Whitener whitener(covariance(problem, problem.fitted, phi, theta));
    const Eigen::VectorXd y =
        predict(*problem.model, problem.fitted, phi, theta) + whitener.colour(inference::draw_student(random, attributor.data(), problem.model->emulator.nu()));
    return judged(attributor, y, truth, seed + stream);
}

struct ChosenRun {
    int configuration = 0;
    std::size_t truth = 0;
};

/// Runs inside the parameters' ranges that one of the hypotheses describes, in the wanted shares.
std::vector<ChosenRun> choose_runs(const Attributor& attributor, int count, RandomStream& random) {
    const Problem& problem = attributor.problem();
    const Campaign& c = problem.model->campaign;
    std::array<std::vector<ChosenRun>, 3> pools;
    for (Eigen::Index i = 0; i < c.output.rows(); ++i) {
        bool inside = true;
        for (Eigen::Index j = 0; j < c.parameter.cols(); ++j) {
            const double phi = campaign::unit_coordinate(c.description.parameters[static_cast<std::size_t>(j)], c.parameter(i, j));
            inside = inside && phi >= problem.phi_lower[j] - 1e-9 && phi <= problem.phi_upper[j] + 1e-9;
        }
        std::vector<int> active;
        for (std::size_t e = 0; e < problem.model->library.size(); ++e)
            if (c.amplitude(i, problem.model->library[e]) != 0.0) active.push_back(static_cast<int>(e));
        if (!inside || active.size() > 2) continue;
        for (std::size_t h = 0; h < attributor.hypotheses().size(); ++h)
            if (!attributor.hypotheses()[h].open && attributor.hypotheses()[h].effects == active) pools[active.size()].push_back({static_cast<int>(i), h});
    }
    std::vector<ChosenRun> chosen;
    for (std::size_t k = 0; k < pools.size(); ++k) {
        auto& pool = pools[k];
        const auto wanted = std::min(pool.size(), static_cast<std::size_t>(std::lround(shares[k] * count)));
        for (std::size_t n = 0; n < wanted; ++n) {
            std::swap(pool[n], pool[n + static_cast<std::size_t>(random.uniform() * static_cast<double>(pool.size() - n))]);
            chosen.push_back(pool[n]);
        }
    }
    return chosen;
}

void report(const ProgressSink& progress, std::size_t done, std::size_t all) {
    throw_if_interrupted();
    if (progress) progress({"setting thresholds on cases with a known cause", static_cast<double>(done), static_cast<double>(all), "cases", 0.0, "", ""});
}

}  // namespace

std::vector<RehearsedCase> simulated_cases(const Attributor& attributor, int count, std::uint64_t seed, const ProgressSink& progress) {
    std::vector<RehearsedCase> cases(static_cast<std::size_t>(count));
    constexpr std::size_t portion = 16;
    for (std::size_t begin = 0; begin < cases.size(); begin += portion) {  // portions, so that Ctrl-C and progress have a place
        report(progress, begin, cases.size());
        parallel_for(std::min(portion, cases.size() - begin), 1,
                     [&](std::size_t i) { cases[begin + i] = simulate(attributor, seed, 0x7265000000 + begin + i); });
    }
    return cases;
}

std::vector<RehearsedCase> left_out_cases(const Attributor& attributor, int count, std::uint64_t seed, const ProgressSink& progress) {
    const Problem& problem = attributor.problem();
    RandomStream random(seed, 0x6c656674);
    std::map<int, std::vector<ChosenRun>> by_point;
    for (const ChosenRun& run : choose_runs(attributor, count, random))
        by_point[problem.model->campaign.point[static_cast<std::size_t>(run.configuration)]].push_back(run);
    const inference::Whitener noise(problem.fitted.measurement_covariance + 1e-18 * Eigen::MatrixXd::Identity(attributor.data(), attributor.data()));
    const std::vector<std::pair<int, std::vector<ChosenRun>>> points(by_point.begin(), by_point.end());
    std::vector<std::vector<RehearsedCase>> judged_at(points.size());
    constexpr std::size_t portion = 4;
    for (std::size_t begin = 0; begin < points.size(); begin += portion) {
        report(progress, begin, points.size());
        parallel_for(std::min(portion, points.size() - begin), 1, [&](std::size_t i) {
            const auto& [point, runs] = points[begin + i];
            auto model = std::make_shared<Model>(*problem.model);
            model->emulator = problem.model->emulator.without_point(point);
            Problem stage = problem;
            stage.model = model;
            stage.experiment.settings.scatter_of_one_run = true;
            const Attributor left(stage);
            for (const ChosenRun& run : runs) {
                RandomStream own(seed, 0x6c65660000000000 + static_cast<std::uint64_t>(run.configuration));
                const Eigen::VectorXd y = problem.fitted.from_outputs * problem.model->campaign.output.row(run.configuration).transpose() +
                                          noise.colour(inference::draw_student(own, attributor.data(), std::numeric_limits<double>::infinity()));
                judged_at[begin + i].push_back(judged(left, y, run.truth, seed + static_cast<std::uint64_t>(run.configuration)));
                judged_at[begin + i].back().is_run = true;
            }
        });
    }
    std::vector<RehearsedCase> cases;
    for (auto& some : judged_at)
        for (RehearsedCase& one : some) cases.push_back(std::move(one));
    return cases;
}

}  // namespace pelletlab::diagnosis
