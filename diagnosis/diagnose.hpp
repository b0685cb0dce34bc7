// The whole diagnosis in its order: audit, plan, thresholds, locate, attribute, verdict, how far, what next.
#pragma once

#include "core/diagnosis.hpp"
#include "core/progress.hpp"
#include "diagnosis/attribute.hpp"
#include "diagnosis/recalibrate.hpp"
#include "diagnosis/verdict.hpp"

namespace pelletlab::diagnosis {

/// What can be said without statistics: runs used and failed, data that are suspiciously alike, uncertainties and tolerances that do not fit together.
std::vector<AuditItem> audit(const Problem& problem);

struct DiagnoseOptions {
    bool plan_only = false;
    const Thresholds* thresholds = nullptr;  ///< frozen ones; none: made from the experiment's own design
    bool with_plan = true;
    ProgressSink progress;
};

/// Locate, attribute and judge with fixed thresholds.
struct Assessment {
    Attribution attribution;
    std::vector<DiagnosisWhere> where;
    double transfer_p = not_known;
    double pair_gain = not_known;  ///< ln evidence of the most probable pair above the best single effect
    bool pair_confirmed = false;   ///< by runs of the campaign
    Judgement judgement;
};
Assessment assess(const Attributor& attributor, const Thresholds& thresholds, bool leave_groups_out = true);

/// Throws Error as make_model and make_problem.
Diagnosis diagnose(const Campaign& campaign, const Experiment& experiment, const DiagnoseOptions& options = {});
Diagnosis diagnose(const Problem& problem, const DiagnoseOptions& options = {});

}  // namespace pelletlab::diagnosis
