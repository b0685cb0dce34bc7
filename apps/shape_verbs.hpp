// The verbs below `pelletlab shape`: one function each, added to the verb.
#pragma once

#include <CLI/App.hpp>

namespace pelletlab::apps {

void add_shape_export(CLI::App& shape);
void add_shape_import(CLI::App& shape);
void add_shape_compare(CLI::App& shape);
void add_shape_pareto(CLI::App& shape);
void add_shape_family(CLI::App& shape);

/// Options and arguments of `shape` itself mean nothing to the verbs below it: Error(usage) when one was given.
void refuse_options_of_shape(const CLI::App& shape, const CLI::App& verb);

}  // namespace pelletlab::apps
