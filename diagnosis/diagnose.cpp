#include "diagnosis/diagnose.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "diagnosis/explained_gap.hpp"
#include "diagnosis/locate.hpp"
#include "diagnosis/plan.hpp"
#include "diagnosis/quantify.hpp"
#include "diagnosis/recommend.hpp"

namespace pelletlab::diagnosis {

namespace {

std::string unit_text(const std::string& unit) {
    return unit == "1" ? "" : " " + unit;
}

DiagnosisHypothesis describe(const Problem& problem, const Hypothesis& h, const Fit& fit, double probability, bool in_set) {
    DiagnosisHypothesis d;
    d.name = h.name;
    d.log_evidence = fit.log_evidence;
    d.prior = std::exp(h.log_prior);
    d.probability = probability;
    d.chi2 = fit.mode.chi2;
    d.effective_samples = fit.posterior.effective_samples;
    d.in_set = in_set;
    const Eigen::Index p = problem.phi_lower.size();
    for (std::size_t e = 0; e < h.effects.size(); ++e) {
        const CampaignEffect& effect = problem.model->effect(h.effects[e]);
        const auto i = p + static_cast<Eigen::Index>(e);
        const auto value = [&](double theta) { return campaign::value_of_amplitude(effect, theta); };
        d.amplitudes.push_back({effect.name, fit.posterior.mean[i], fit.posterior.lower[i], fit.posterior.upper[i],
                                fmt::format("{:.3g} ({:.3g} to {:.3g}){}", value(fit.posterior.mean[i]), value(fit.posterior.lower[i]),
                                            value(fit.posterior.upper[i]), unit_text(effect.unit))});
    }
    for (Eigen::Index i = 0; i < p; ++i) {
        const CampaignParameter& one = problem.model->campaign.description.parameters[static_cast<std::size_t>(i)];
        const auto value = [&](double phi) { return campaign::value_of_coordinate(one, phi); };
        d.parameters.push_back(fmt::format("{} {:.3g} ({:.3g} to {:.3g}){}", one.name, value(fit.posterior.mean[i]), value(fit.posterior.lower[i]),
                                           value(fit.posterior.upper[i]), unit_text(one.unit)));
    }
    return d;
}

/// Largest λ_k0 that any effect could have had at θ = 1 at the baseline's fit.
double best_detectability(const Attributor& attributor, const Fit& baseline) {
    double best = 0.0;
    const Eigen::Index k = attributor.problem().model->effects();
    Eigen::VectorXd phi, none;
    attributor.split(attributor.hypotheses()[0], baseline.mode.psi, phi, none);
    for (Eigen::Index e = 0; e < k; ++e) {
        Eigen::VectorXd theta = Eigen::VectorXd::Zero(k);
        theta[e] = 1.0;
        best = std::max(best, separation(attributor, phi, theta, 0));
    }
    return best;
}

/// Cosines between the baseline's residual and each effect's signature after recalibration.
std::vector<std::string> nearest_signatures(const Attributor& attributor, const Fit& baseline) {
    std::vector<std::pair<double, std::string>> list;
    const Problem& problem = attributor.problem();
    const Hypothesis& none = attributor.hypotheses()[0];
    Eigen::VectorXd phi, theta;
    attributor.split(none, baseline.mode.psi, phi, theta);
    const Eigen::MatrixXd m = inference::residual_operator(baseline.mode);
    const Eigen::VectorXd f0 = predict(*problem.model, problem.fitted, phi, theta);
    for (Eigen::Index e = 0; e < theta.size(); ++e) {
        Eigen::VectorXd with = theta;
        with[e] = 0.7;
        const Eigen::VectorXd s = m * baseline.whitener.whiten(predict(*problem.model, problem.fitted, phi, with) - f0);
        const double cosine = s.dot(baseline.mode.residual) / std::max(1e-12, s.norm() * baseline.mode.residual.norm());
        list.emplace_back(-cosine, fmt::format("{} (cosine {:.2f})", problem.model->effect(static_cast<int>(e)).name, cosine));
    }
    std::sort(list.begin(), list.end());
    std::vector<std::string> names;
    for (std::size_t i = 0; i < std::min<std::size_t>(3, list.size()); ++i) names.push_back(list[i].second);
    return names;
}

void add_curves(Diagnosis& d, const Attributor& attributor, const Attribution& a, int leading, const DataSet& data, bool held_out) {
    if (data.empty()) return;
    const Problem& problem = attributor.problem();
    const auto at = [&](int h) {
        Eigen::VectorXd phi, theta;
        attributor.split(attributor.hypotheses()[static_cast<std::size_t>(h)], a.fits[static_cast<std::size_t>(h)].posterior.mean, phi, theta);
        return predict(*problem.model, data, phi, theta);
    };
    const Eigen::VectorXd baseline = at(0), explained = at(leading);
    int last = -1;
    for (std::size_t i = 0; i < data.points.size(); ++i) {
        const DataPoint& p = data.points[i];
        if (p.measurement != last) {
            const auto& o = problem.model->campaign.description.observables[static_cast<std::size_t>(p.observable)];
            d.curves.push_back({problem.experiment.measurements[static_cast<std::size_t>(p.measurement)].name,
                                o.name,
                                p.regime,
                                o.unit,
                                o.axis_name,
                                held_out,
                                {},
                                {},
                                {},
                                {},
                                {}});
            last = p.measurement;
        }
        DiagnosisCurve& c = d.curves.back();
        c.axis.push_back(p.axis);
        c.value.push_back(p.value);
        c.uncertainty.push_back(p.uncertainty);
        c.baseline.push_back(baseline[static_cast<Eigen::Index>(i)]);
        c.explained.push_back(explained[static_cast<Eigen::Index>(i)]);
    }
}

std::string join(const std::vector<std::string>& words, const char* between) {
    std::string text;
    for (const std::string& w : words) text += (text.empty() ? "" : between) + w;
    return text;
}

std::string statement_of(const Diagnosis& d, const Judgement& j) {
    switch (d.verdict) {
        case Verdict::no_gap:
            return "No gap: the baseline, calibrated, describes these data within noise and tolerance.";
        case Verdict::ambiguous_calibration:
            return "The miss on new data is ambiguity of the calibration: one set of parameters fits all data together.";
        case Verdict::effect:
            return fmt::format("The gap is explained by {} ({}).", d.named[0], j.reason);
        case Verdict::effects:
            return fmt::format("The gap needs {} together.", join(d.named, " and "));
        case Verdict::set:
            return d.named.empty() ? "These data do not tell the explanations apart."
                                   : fmt::format("These data cannot tell apart: {}. Measure what is recommended below.", join(d.named, ", "));
        case Verdict::outside_library:
            return fmt::format("None of the library's effects describes the gap: {}.", j.reason);
        case Verdict::underpowered:
            break;
    }
    return "No conclusion is possible: these data could not have shown any effect of the library.";
}

/// Halving and doubling the prior mass of each class must not change which effects are claimed.
bool depends_on_prior(Attribution a, std::vector<Hypothesis> hypotheses, const Thresholds& t, Eigen::Index effects) {
    const auto claims = [&](const Attribution& one) {
        std::vector<bool> c;
        for (const double p : one.inclusion) c.push_back(p >= t.claim);
        c.push_back(one.probability_of_open >= t.open);
        return c;
    };
    const auto reference = claims(a);
    a.fits.clear();
    for (std::size_t size = 0; size <= 3; ++size)
        for (const double factor : {0.5, 2.0}) {
            auto changed = hypotheses;
            for (Hypothesis& h : changed)
                if (h.open ? size == 3 : h.effects.size() == size) h.log_prior += std::log(factor);
            normalise(a, changed, t.temperature, effects);
            if (claims(a) != reference) return true;
        }
    return false;
}

void describe_emulator(Diagnosis& d, const inference::EmulatorReport& r) {
    d.emulator_accepted = r.accepted;
    d.emulator = {fmt::format("{} configurations ({} with at most one effect, {} with two), {} modes with {:.2f} % of the variance", r.runs, r.spoke_runs,
                              r.pair_runs, r.modes, 100.0 * r.kept_variance),
                  fmt::format("left-out points: standardised error {:.2f} (1 is right), {:.1f} % beyond three, {:.0f} % of outputs within half a tolerance",
                              r.standardised_rms, 100.0 * r.share_beyond_three, 100.0 * r.share_small),
                  fmt::format("as stated afterwards: {:.2f} at points on the edge of the runs' range, {:.2f} inside it ({:.2f} is right for such tails)",
                              r.edge_rms, r.inner_rms, std::sqrt(r.nu / (r.nu - 2.0))),
                  fmt::format("scatter of single runs between {:.2f} and {:.2f} of its middle, Student t with {:.0f} degrees of freedom", r.smallest_scatter,
                              r.largest_scatter, r.nu)};
}

}  // namespace

Assessment assess(const Attributor& attributor, const Thresholds& t, bool leave_groups_out) {
    Assessment result;
    const Problem& problem = attributor.problem();
    const DiagnosisSettings& s = problem.experiment.settings;
    const Eigen::VectorXd& y = problem.fitted.value;
    result.attribution = attribute(attributor, y, t.temperature, s.bootstrap, s.seed);
    const Attribution& a = result.attribution;
    result.where = locate(attributor, y, a.fits[0], s.bootstrap, s.seed, leave_groups_out);
    const auto explained = explained_gaps(attributor, y, a, s.false_discovery_rate, s.seed);
    for (std::size_t g = 0; g < explained.size(); ++g) {
        DiagnosisWhere& w = result.where[g];
        w.explained = explained[g].gap;
        w.explained_lower = explained[g].lower;
        w.explained_upper = explained[g].upper;
        w.explained_probability = explained[g].probability;
        w.explained_discovery = explained[g].discovery;
    }
    result.transfer_p = transfer_p_value(attributor, y, s.bootstrap, s.seed);
    Evidence evidence{&a, result.transfer_p, best_detectability(attributor, a.fits[0]), false};
    int best_pair = -1;
    double best_single = -std::numeric_limits<double>::infinity();
    for (std::size_t h = 0; h < attributor.hypotheses().size(); ++h) {
        if (attributor.hypotheses()[h].effects.size() == 1) best_single = std::max(best_single, a.log_evidence[h]);
        if (attributor.hypotheses()[h].effects.size() == 2 && (best_pair < 0 || a.probability[h] > a.probability[static_cast<std::size_t>(best_pair)]))
            best_pair = static_cast<int>(h);
    }
    if (best_pair >= 0) {
        result.pair_gain = a.log_evidence[static_cast<std::size_t>(best_pair)] - best_single;
        if (a.probability[static_cast<std::size_t>(best_pair)] > 0.5) result.pair_confirmed = runs_confirm_pair(attributor, a, y, best_pair);
    }
    evidence.second_effect_confirmed = result.pair_confirmed;
    result.judgement = judge(attributor.hypotheses(), evidence, t);
    return result;
}

Diagnosis diagnose(const Problem& problem, const DiagnoseOptions& options) {
    Diagnosis d;
    const DiagnosisSettings& s = problem.experiment.settings;
    d.name = problem.experiment.name;
    d.campaign = problem.model->campaign.description.name;
    d.campaign_source = problem.model->campaign.description.source;
    d.audit = audit(problem);
    describe_emulator(d, problem.model->emulator.report());
    const Attributor attributor(problem);
    if (options.with_plan || options.plan_only) d.plan = make_plan(attributor);
    if (options.plan_only) return d;

    const Thresholds t = options.thresholds != nullptr ? *options.thresholds : recalibrate(attributor, s.recalibration_cases, s.seed, options.progress);
    d.temperature = t.temperature;
    d.claim_threshold = t.claim;
    d.adequacy_threshold = t.adequacy;
    d.gap_threshold = t.gap;
    d.open_threshold = t.open;
    throw_if_interrupted();
    const Assessment assessment = assess(attributor, t);
    const Attribution& a = assessment.attribution;
    const Judgement& judgement = assessment.judgement;
    d.where = assessment.where;
    d.transfer_p = assessment.transfer_p;
    int leading = a.best_closed;
    d.verdict = judgement.verdict;
    for (const int e : judgement.named) d.named.push_back(problem.model->effect(e).name);
    if (d.verdict == Verdict::effect) leading = static_cast<int>(hypothesis_index(attributor.hypotheses(), {judgement.named[0]}));
    for (std::size_t h = 0; h < attributor.hypotheses().size(); ++h) {
        const bool in_set = std::find(a.credible_set.begin(), a.credible_set.end(), static_cast<int>(h)) != a.credible_set.end();
        d.hypotheses.push_back(describe(problem, attributor.hypotheses()[h], a.fits[h], a.probability[h], in_set));
    }
    std::stable_sort(d.hypotheses.begin(), d.hypotheses.end(), [](const auto& x, const auto& z) { return x.probability > z.probability; });
    for (std::size_t e = 0; e < a.inclusion.size(); ++e) d.inclusion.push_back({problem.model->effect(static_cast<int>(e)).name, a.inclusion[e]});
    d.baseline_p = a.baseline_adequacy.p;
    d.best_p = a.adequacy.p;
    d.misfit_family = a.adequacy.family;
    d.best_name = attributor.hypotheses()[static_cast<std::size_t>(a.best_closed)].name;
    d.nearest = nearest_signatures(attributor, a.fits[0]);
    d.prior_dependent = depends_on_prior(a, attributor.hypotheses(), t, problem.model->effects());
    d.how_far = quantify(attributor, a, leading, s.seed);
    d.confirmation = "by re-simulation: not possible, the campaign was made elsewhere and no solver is attached. ";
    for (const bool held_out : {false, true}) {
        const double by_runs = shrink_by_runs(attributor, a, leading, held_out);
        if (!std::isnan(by_runs))
            d.confirmation += fmt::format("By single runs of the campaign, the closest with and without the effect: the {} gap changes by {:+.0f} %. ",
                                          held_out ? "held-out" : "fitted", -100.0 * by_runs);
    }
    d.next = recommend(attributor, a, s.seed);
    add_curves(d, attributor, a, leading, problem.fitted, false);
    add_curves(d, attributor, a, leading, problem.held_out, true);
    d.notes = problem.notes;
    if (d.prior_dependent) d.notes.push_back("prior-dependent: halving or doubling the prior mass of a class changes what is claimed");
    if (!d.emulator_accepted) d.notes.push_back("the emulator does not meet its acceptance bounds: read the probabilities with care");
    d.statement = statement_of(d, judgement);
    return d;
}

Diagnosis diagnose(const Campaign& campaign, const Experiment& experiment, const DiagnoseOptions& options) {
    if (options.progress) options.progress({"fitting the emulator", 0.0, 0.0, "", 0.0, "", ""});
    const Problem problem = make_problem(make_model(campaign, experiment.library, experiment.exclude, experiment.file), experiment);
    return diagnose(problem, options);
}

}  // namespace pelletlab::diagnosis
