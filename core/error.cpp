#include "core/error.hpp"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

namespace pelletlab {

namespace {

std::string full_text(const std::string& problem, const std::string& remedy, const Place& place) {
    std::string text;
    if (!place.file.empty()) {
        text += place.file;
        if (place.line > 0) text += ":" + std::to_string(place.line);
        if (place.line > 0 && place.column > 0) text += ":" + std::to_string(place.column);
        text += ": ";
    }
    text += problem;
    if (!remedy.empty()) text += "\n  what to do: " + remedy;
    return text;
}

}  // namespace

Error::Error(ErrorKind kind, std::string problem, std::string remedy, Place place)
    : std::runtime_error(full_text(problem, remedy, place)), kind_(kind), problem_(std::move(problem)), remedy_(std::move(remedy)), place_(std::move(place)) {}

Error usage_error(std::string problem, std::string remedy) {
    return {ErrorKind::usage, std::move(problem), std::move(remedy)};
}

Error bad_input(std::string problem, std::string remedy, Place place) {
    return {ErrorKind::bad_input, std::move(problem), std::move(remedy), std::move(place)};
}

Error numerical_failure(std::string problem, std::string remedy, Place place) {
    return {ErrorKind::numerical, std::move(problem), std::move(remedy), std::move(place)};
}

int edit_distance(const std::string& a, const std::string& b) {
    std::vector<int> previous(b.size() + 1);
    std::vector<int> current(b.size() + 1);
    std::iota(previous.begin(), previous.end(), 0);
    for (std::size_t i = 1; i <= a.size(); ++i) {
        current[0] = static_cast<int>(i);
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const int substitution = previous[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            current[j] = std::min({previous[j] + 1, current[j - 1] + 1, substitution});
        }
        std::swap(previous, current);
    }
    return previous[b.size()];
}

}  // namespace pelletlab
