// A diagnosis on the terminal.
#pragma once

#include <CLI/App.hpp>

#include "core/diagnosis.hpp"

namespace pelletlab::apps {

void print_plan(const Diagnosis& diagnosis);
void print_answers(const Diagnosis& diagnosis);
void add_blind_verbs(CLI::App& diagnose);
void add_effect_verbs(CLI::App& diagnose);

}  // namespace pelletlab::apps
