#include "diagnosis/recalibrate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/parallel.hpp"
#include "inference/statistics.hpp"

namespace pelletlab::diagnosis {

namespace {

struct Simulated {
    std::size_t truth = 0;
    Attribution attribution;
};

/// θ from the half-normal prior cut at 1 (both signs for two-sided effects).
double draw_amplitude(RandomStream& random, double width, bool two_sided) {
    for (;;) {
        const double t = width * random.normal();
        if (std::abs(t) <= 1.0) return two_sided ? t : std::abs(t);
    }
}

Simulated simulate(const Attributor& attributor, std::uint64_t seed, std::uint64_t stream) {
    const Problem& problem = attributor.problem();
    const auto& hypotheses = attributor.hypotheses();
    RandomStream random(seed, stream);
    const double u = random.uniform();
    const std::size_t wanted = u < 0.40 ? 0 : u < 0.85 ? 1 : 2;
    std::vector<std::size_t> pool;
    for (std::size_t h = 0; h < hypotheses.size(); ++h)
        if (!hypotheses[h].open && hypotheses[h].effects.size() == wanted) pool.push_back(h);
    Simulated s;
    s.truth = pool.empty() ? 0 : pool[static_cast<std::size_t>(random.uniform() * static_cast<double>(pool.size()))];
    Eigen::VectorXd phi = problem.phi_lower, theta = Eigen::VectorXd::Zero(problem.model->effects());
    for (Eigen::Index i = 0; i < phi.size(); ++i) phi[i] += random.uniform() * (problem.phi_upper[i] - problem.phi_lower[i]);
    for (const int e : hypotheses[s.truth].effects) {
        const auto& effect = problem.model->campaign.description.effects[static_cast<std::size_t>(problem.model->library[static_cast<std::size_t>(e)])];
        theta[e] = draw_amplitude(random, 0.55, effect.two_sided);
    }
    const inference::Whitener whitener(covariance(problem, problem.fitted, phi, theta));
    const Eigen::VectorXd y =
        predict(*problem.model, problem.fitted, phi, theta) + whitener.colour(inference::draw_student(random, attributor.data(), problem.model->emulator.nu()));
    s.attribution = attribute(attributor, y, 1.0, 100, seed + stream);
    s.attribution.fits.clear();
    return s;
}

}  // namespace

Thresholds recalibrate(const Attributor& attributor, int cases, std::uint64_t seed, const ProgressSink& progress) {
    Thresholds t;
    if (cases == 0) return t;
    std::vector<Simulated> simulated(static_cast<std::size_t>(cases));
    constexpr std::size_t portion = 16;
    for (std::size_t begin = 0; begin < simulated.size(); begin += portion) {  // portions, so that Ctrl-C and progress have a place
        throw_if_interrupted();
        if (progress) progress({"recalibrating on simulated cases", static_cast<double>(begin), static_cast<double>(cases), "cases", 0.0, "", ""});
        const std::size_t count = std::min(portion, simulated.size() - begin);
        parallel_for(count, 1, [&](std::size_t i) { simulated[begin + i] = simulate(attributor, seed, 0x7265000000 + begin + i); });
    }
    const auto& hypotheses = attributor.hypotheses();
    const Eigen::Index effects = attributor.problem().model->effects();
    double best = -1e300;
    for (const double temperature : {0.7, 0.85, 1.0, 1.2, 1.5, 1.9, 2.4, 3.0, 4.0}) {
        double score = 0.0;
        for (Simulated& s : simulated) {
            normalise(s.attribution, hypotheses, temperature, effects);
            score += std::log(std::max(1e-12, s.attribution.probability[s.truth]));
        }
        if (score > best) {
            best = score;
            t.temperature = temperature;
        }
    }
    std::vector<double> null_claims, adequacy;
    for (Simulated& s : simulated) {
        normalise(s.attribution, hypotheses, t.temperature, effects);
        const auto& p = s.attribution.inclusion;
        if (s.truth == 0 && !p.empty()) null_claims.push_back(*std::max_element(p.begin(), p.end()));
        adequacy.push_back(s.attribution.adequacy.p);
    }
    t.cases = cases;
    if (null_claims.size() >= 20) t.claim = std::clamp(inference::quantile(null_claims, 0.95), 0.90, 0.995);
    if (adequacy.size() >= 20) t.adequacy = std::clamp(inference::quantile(adequacy, 0.03), 0.01, 0.05);
    for (const double c : null_claims) t.null_false_alarm += (c >= t.claim ? 1.0 : 0.0) / static_cast<double>(null_claims.size());
    return t;
}

std::string thresholds_text(const Thresholds& t) {
    return fmt::format("temperature {:.17g} claim {:.17g} adequacy {:.17g} cases {} null_false_alarm {:.17g}\n", t.temperature, t.claim, t.adequacy, t.cases,
                       t.null_false_alarm);
}

}  // namespace pelletlab::diagnosis
