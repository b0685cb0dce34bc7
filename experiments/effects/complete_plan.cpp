#include "experiments/effects/complete_plan.hpp"

#include <cmath>

#include "experiments/effects/effects.hpp"

namespace pelletlab::experiments {

void complete_effects(CampaignPlan& plan) {
    for (std::size_t k = 0; k < plan.effects.size(); ++k) {
        if (plan.effect_kinds[k] == PlannedEffectKind::case_keys) continue;
        CampaignEffect& e = plan.effects[k];
        const Effect* known = nullptr;
        try {
            known = &effect_named(e.name);
        } catch (const Error& error) {
            throw bad_input(error.problem(), error.remedy() + "; an effect of your own needs keys = [...]", plan.effect_places[k]);
        }
        plan.effect_kinds[k] = known->is_measurement() ? PlannedEffectKind::library_data : PlannedEffectKind::library_case;
        if (e.title.empty()) e.title = known->title;
        e.unit = known->unit;
        e.baseline = 0.0;
        if (std::isnan(e.full)) e.full = known->full;
        e.two_sided = known->two_sided;
        e.effect_class = known->effect_class;
        plan.effect_levels[k].clear();
        for (const double level : known->levels)
            if (std::abs(level) <= std::abs(e.full) * (1.0 + 1e-9)) plan.effect_levels[k].push_back(level);
        if (!known->levels.empty() && plan.effect_levels[k].empty())
            throw bad_input("'" + e.name + "' has no level within its range", "raise full, or leave it out", plan.effect_places[k]);
    }
}

}  // namespace pelletlab::experiments
