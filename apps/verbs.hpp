// One function a verb: adds itself to the command line; its callback does the work and throws Error.
#pragma once

#include <CLI/App.hpp>

namespace pelletlab::apps {

void add_mesh_verb(CLI::App& app);
void add_shape_verb(CLI::App& app);
void add_case_verb(CLI::App& app);
void add_fill_verb(CLI::App& app);
void add_drum_verb(CLI::App& app);
void add_pile_verb(CLI::App& app);
void add_tester_verb(CLI::App& app);
void add_observe_verb(CLI::App& app);
void add_compare_verb(CLI::App& app);
void add_campaign_verb(CLI::App& app);
void add_calibrate_verb(CLI::App& app);
void add_demo_verb(CLI::App& app);
void add_diagnose_verb(CLI::App& app);

}  // namespace pelletlab::apps
