// Measured values as a person reads them.
#pragma once

#include "core/observables.hpp"

namespace pelletlab::apps {

/// One line a value: name, value ± standard error, unit, method.
void print_observables(const Observables& observables);

}  // namespace pelletlab::apps
