#include "apps/print_observables.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "apps/terminal.hpp"

namespace pelletlab::apps {

void print_observables(const Observables& observables) {
    std::vector<std::pair<std::string, std::string>> rows;
    for (const Observable& o : observables.values) {
        std::string text = fmt::format("{:.5g}", o.value);
        if (std::isfinite(o.standard_error)) text += fmt::format(" ± {:.2g}", o.standard_error);
        rows.emplace_back(o.name, text + " " + o.unit + (o.method.empty() ? "" : "   [" + o.method + "]"));
    }
    print_line(fmt::format("Measured ({}; definitions in docs/observables.md):", observables.status));
    print_pairs(rows);
}

}  // namespace pelletlab::apps
