#include "observables/mixing.hpp"

#include <cmath>
#include <map>
#include <tuple>

#include "core/observables.hpp"

namespace pelletlab::observables {

double lacey_index(const std::vector<Vec3>& places, const std::vector<std::uint8_t>& label, double cell) {
    struct Content {
        double all = 0.0, labelled = 0.0;
    };
    std::map<std::tuple<long, long, long>, Content> cells;
    Content total;
    for (std::size_t i = 0; i < places.size(); ++i) {
        if (!places[i].allFinite()) continue;
        Content& content = cells[{std::lround(places[i].x() / cell), std::lround(places[i].y() / cell), std::lround(places[i].z() / cell)}];
        content.all += 1.0;
        content.labelled += label[i] != 0 ? 1.0 : 0.0;
        total.all += 1.0;
        total.labelled += label[i] != 0 ? 1.0 : 0.0;
    }
    const double p = total.labelled / total.all, unmixed = p * (1.0 - p);
    if (!(unmixed > 0.0) || cells.size() < 2) return not_known;
    double squares = 0.0;
    for (const auto& [where, content] : cells) squares += content.all * (content.labelled / content.all - p) * (content.labelled / content.all - p);
    const double random = unmixed * (static_cast<double>(cells.size()) - 1.0) / (total.all - 1.0);
    return random < unmixed ? (unmixed - squares / total.all) / (unmixed - random) : not_known;
}

}  // namespace pelletlab::observables
