#include "observables/tester.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <string>

#include "core/error.hpp"
#include "observables/detail/end_view.hpp"
#include "observables/detail/tester_cloud.hpp"
#include "observables/statistics.hpp"

namespace pelletlab::observables {

namespace {

constexpr double degree = std::numbers::pi / 180.0, full_turn = 2.0 * std::numbers::pi;
constexpr double millimetre = 1e-3;
constexpr std::size_t points_per_pellet = 125;
constexpr double widest_bin = 5.0 * degree;  // of the baffle's load against its angle
constexpr double angle_off = 3.0 * degree;   // a frame stands for one of the eight angles when it is that near

/// Frames of the window against the baffle's angle, which grows without end.
struct Place {
    std::size_t frame;
    double angle;  ///< [rad]
};

void require_usable(const FrameSource& trajectory, const TesterGeometry& t) {
    if (!(t.radius > 0.0) || !(t.length > 0.0) || !(t.grid > 0.0)) throw bad_input("the tester to measure has no radius, length or grid");
    if (t.rotation_speed == 0.0) throw bad_input("the tester does not turn: there are no baffle angles to measure at", "state its speed");
    if (trajectory.header().shape_of_body.empty()) throw bad_input("the trajectory holds no pellets", "run the case again");
}

std::vector<Place> places_in(const FrameSource& trajectory, const TesterGeometry& t, const TimeWindow& window) {
    std::vector<Place> places;
    for (std::size_t k = 0; k < trajectory.frame_count(); ++k) {
        const double time = trajectory.time(k);
        if (time < window.begin + 1e-9 || time > window.end + 1e-9) continue;  // without its begin: over whole turns that instant is the end once more
        places.push_back({k, t.baffle_angle + std::abs(t.rotation_speed) * (time - t.angle_time)});
    }
    if (places.empty()) throw bad_input("no frame lies in the time that is to be measured", "store frames more often, or measure longer");
    return places;
}

/// The frame of each turn that is nearest to that angle.
std::vector<std::size_t> frames_at(const std::vector<Place>& places, double angle) {
    std::map<long long, std::pair<double, std::size_t>> nearest;  // of a turn: how far off, frame
    for (const Place& place : places) {
        const double turns = (place.angle - angle) / full_turn;
        const double off = std::abs(turns - std::round(turns)) * full_turn;
        if (off > angle_off) continue;
        const auto [found, fresh] = nearest.try_emplace(std::llround(turns), off, place.frame);
        if (!fresh && off < found->second.first) found->second = {off, place.frame};
    }
    std::vector<std::size_t> frames;
    for (const auto& [turn, frame] : nearest) frames.push_back(frame.second);
    return frames;
}

std::string angle_text(std::size_t m) {
    const std::string digits = std::to_string(45 * m);
    return std::string(3 - digits.size(), '0') + digits;
}

/// s / √n of values of single turns; NaN for fewer than two.
double error_of_turns(const std::vector<double>& values) {
    if (values.size() < 2) return not_known;
    const double mean = mean_of(values), n = static_cast<double>(values.size());
    double squares = 0.0;
    for (const double value : values) squares += (value - mean) * (value - mean);
    return std::sqrt(squares / (n - 1.0) / n);
}

void measure_angle(std::size_t m, const FrameSource& trajectory, const std::vector<std::size_t>& frames, const std::vector<detail::PelletPoints>& shapes,
                   const TesterGeometry& t, const TimeWindow& window, Observables& result) {
    const auto cells = static_cast<std::size_t>(std::ceil(2.0 * t.radius / t.grid));
    const detail::ViewGrid grid = detail::ViewGrid::over(t.radius, cells, cells);
    FieldMap map = detail::empty_map(("cloud_" + angle_text(m)).c_str(), "1", "tester.cloud", grid, window);
    std::vector<double> volume(grid.cells(), 0.0), loose, x, z;
    for (const std::size_t index : frames) {
        const Frame frame = trajectory.frame(index);
        detail::add_end_view(volume, grid, trajectory.header(), frame, shapes);
        loose.push_back(detail::loose_share(trajectory.header(), frame, shapes));
        const Vec3 centre = detail::centre_of_pellets(trajectory.header(), frame, shapes);
        x.push_back(centre.x() / millimetre);
        z.push_back(centre.z() / millimetre);
    }
    const std::vector<double> area = grid.area_inside(t.radius);
    for (std::size_t cell = 0; cell < grid.cells(); ++cell) {
        if (frames.empty() || !(area[cell] > 0.0)) continue;
        map.value[cell] = volume[cell] / (static_cast<double>(frames.size()) * area[cell] * t.length);
        map.sample_count[cell] = static_cast<double>(frames.size());
    }
    result.maps.push_back(std::move(map));
    const auto add = [&](const char* name, const char* unit, const std::vector<double>& of_turns, const char* method) {
        result.values.push_back({name + angle_text(m), unit, mean_of(of_turns), error_of_turns(of_turns), window, method});
    };
    add("loose_share_", "1", loose, "tester.loose");
    add("centre_x_", "mm", x, "tester.centre");
    add("centre_z_", "mm", z, "tester.centre");
}

struct Load {
    std::vector<double> angle;                 ///< [rad], bin centres
    std::vector<std::vector<double>> of_turn;  ///< (turns)(bins) pellets on the baffle; NaN where no frame was
};

Load baffle_load(const FrameSource& trajectory, const std::vector<Place>& places, const TesterGeometry& t) {
    const double spacing = places.size() > 1 ? (places.back().angle - places.front().angle) / static_cast<double>(places.size() - 1) : full_turn;
    const auto bins = static_cast<std::size_t>(std::max(1.0, std::floor(full_turn / std::max(widest_bin, spacing) + 1e-6)));
    Load load;
    for (std::size_t b = 0; b < bins; ++b) load.angle.push_back((static_cast<double>(b) + 0.5) * full_turn / static_cast<double>(bins));
    const double first = places.front().angle, spanned = (places.back().angle - first + spacing) / full_turn;  // a frame stands for the way to the next
    const auto rows = static_cast<std::size_t>(std::max(1.0, std::floor(spanned + 0.01)));
    load.of_turn.assign(rows, std::vector<double>(bins, 0.0));
    std::vector<std::vector<double>> count = load.of_turn;
    for (const Place& place : places) {
        const auto row = static_cast<std::size_t>(std::max(0.0, (place.angle - first) / full_turn + 1e-9));
        if (row >= rows) continue;                            // of a turn that the window cuts off
        const double turns = place.angle / full_turn + 1e-7;  // rounding must not put a frame on an edge into the bin before
        const std::size_t bin = std::min(bins - 1, static_cast<std::size_t>((turns - std::floor(turns)) * static_cast<double>(bins)));
        load.of_turn[row][bin] += static_cast<double>(detail::carried_by_baffle(trajectory.frame(place.frame), t, place.angle));
        count[row][bin] += 1.0;
    }
    for (std::size_t row = 0; row < load.of_turn.size(); ++row)
        for (std::size_t bin = 0; bin < bins; ++bin) load.of_turn[row][bin] = count[row][bin] > 0.0 ? load.of_turn[row][bin] / count[row][bin] : not_known;
    return load;
}

/// Bin by bin over the turns, one of them left out («none» for an index behind the last).
std::vector<double> mean_load(const Load& load, std::size_t without) {
    std::vector<double> mean;
    for (std::size_t bin = 0; bin < load.angle.size(); ++bin) {
        std::vector<double> values;
        for (std::size_t turn = 0; turn < load.of_turn.size(); ++turn)
            if (turn != without) values.push_back(load.of_turn[turn][bin]);
        mean.push_back(mean_of(values));
    }
    return mean;
}

void measure_load(const FrameSource& trajectory, const std::vector<Place>& places, const TesterGeometry& t, const TimeWindow& window, Observables& result) {
    const Load load = baffle_load(trajectory, places, t);
    const std::size_t turns = load.of_turn.size();
    const std::vector<double> mean = mean_load(load, turns);
    Profile profile{"baffle_load", "1", "baffle_angle", "deg", {}, mean, {}, window, "tester.load"};
    for (std::size_t bin = 0; bin < load.angle.size(); ++bin) {
        std::vector<double> values;
        for (const auto& turn : load.of_turn)
            if (std::isfinite(turn[bin])) values.push_back(turn[bin]);
        profile.axis.push_back(load.angle[bin] / degree);
        profile.standard_error.push_back(error_of_turns(values));
    }
    result.profiles.push_back(std::move(profile));
    double largest = not_known;
    for (const double value : mean)
        if (!(largest >= value) && std::isfinite(value)) largest = value;
    result.values.push_back({"baffle_load_largest", "1", largest, not_known, window, "tester.load"});
    constexpr std::array<const char*, 3> names{"release_angle_begin", "release_angle", "release_angle_end"};
    constexpr std::array<double, 3> shares{0.9, 0.5, 0.1};
    for (std::size_t k = 0; k < names.size(); ++k) {
        const double angle = detail::release_angle(load.angle, mean, shares[k]);
        double squares = 0.0;  // jackknife: the angle without each turn
        for (std::size_t turn = 0; turn < turns; ++turn) {
            const double other = detail::release_angle(load.angle, mean_load(load, turn), shares[k]);
            squares += (other - angle) * (other - angle);
        }
        const double n = static_cast<double>(turns), error = turns < 2 ? not_known : std::sqrt((n - 1.0) / n * squares);
        result.values.push_back({names[k], "deg", angle / degree, error / degree, window, "tester.release"});
    }
}

}  // namespace

Observables measure_tester(const FrameSource& trajectory, const TesterGeometry& tester, const TimeWindow& window) {
    require_usable(trajectory, tester);
    const std::vector<Place> places = places_in(trajectory, tester, window);
    const std::vector<detail::PelletPoints> shapes = detail::sample_shapes(trajectory.header(), points_per_pellet);
    Observables result;
    result.case_name = trajectory.header().case_name;
    result.provenance = trajectory.header().provenance;
    const double turns = std::abs(tester.rotation_speed) * (window.end - window.begin) / full_turn;
    if (turns < 2.0 - 1e-3) result.status = "too few turns";
    result.values.push_back({"turns_measured", "1", turns, not_known, window, "tester.turns"});
    for (std::size_t m = 0; m < baffle_angles; ++m) {
        const std::vector<std::size_t> frames = frames_at(places, static_cast<double>(m) * full_turn / baffle_angles);
        if (frames.empty() && result.status == "complete") result.status = "frames too far apart";
        measure_angle(m, trajectory, frames, shapes, tester, window, result);
    }
    measure_load(trajectory, places, tester, window, result);
    return result;
}

}  // namespace pelletlab::observables
