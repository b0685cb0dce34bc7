#include "report/measured_charts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

namespace pelletlab::report {

namespace {

constexpr Srgb blue{33, 102, 172}, red{178, 24, 43}, orange{214, 120, 10}, green{27, 120, 55}, grey{110, 110, 110};

const Profile* profile_of(const Observables& observables, const std::string& name) {
    const auto found = std::find_if(observables.profiles.begin(), observables.profiles.end(), [&](const Profile& p) { return p.name == name; });
    return found == observables.profiles.end() ? nullptr : &*found;
}

double value_of(const Observables& observables, const std::string& name) {
    for (const Observable& o : observables.values)
        if (o.name == name) return o.value;
    return not_known;
}

ChartSeries line_of(std::string name, const Srgb& colour) {
    ChartSeries line;
    line.name = std::move(name);
    line.colour = colour;
    line.marker = Marker::none;
    line.line = true;
    return line;
}

ChartSeries level_line(const NamedLevel& level, double from, double to, const Srgb& colour) {
    ChartSeries line = line_of(level.first, colour);
    line.dashed = true;
    line.points = {{from, level.second}, {to, level.second}};
    return line;
}

}  // namespace

std::optional<Chart> porosity_from_wall(const Observables& bed, double radius, const std::vector<NamedLevel>& levels) {
    const Profile* radial = profile_of(bed, "packing_fraction_radial");
    const double diameter = value_of(bed, "mean_equivalent_diameter");  // mm
    if (radial == nullptr || !(diameter > 0.0)) return std::nullopt;
    ChartSeries porosity = line_of("this bed, rings of d/10", blue);
    for (std::size_t k = radial->axis.size(); k-- > 0;)
        if (std::isfinite(radial->value[k])) porosity.points.push_back({(radius * 1e3 - radial->axis[k]) / diameter, 1.0 - radial->value[k]});
    if (porosity.points.empty()) return std::nullopt;
    Chart chart{"porosity against the distance from the wall", {"distance from the wall / equivalent diameter", false}, {"porosity", false}, {}};
    constexpr std::array<Srgb, 3> colours{orange, green, grey};
    for (std::size_t k = 0; k < levels.size(); ++k) chart.series.push_back(level_line(levels[k], 0.0, porosity.points.back().x, colours[k % colours.size()]));
    if (const double core = value_of(bed, "packing_fraction_core_clipped"); std::isfinite(core))
        chart.series.push_back(level_line({"this bed, mean of the core", 1.0 - core}, 0.0, porosity.points.back().x, blue));
    chart.series.push_back(std::move(porosity));
    return chart;
}

std::optional<Chart> porosity_over_height(const Observables& bed) {
    const Profile* axial = profile_of(bed, "packing_fraction_axial");
    if (axial == nullptr) return std::nullopt;
    ChartSeries porosity = line_of("slices of d/10", blue);
    for (std::size_t k = 0; k < axial->axis.size(); ++k)
        if (std::isfinite(axial->value[k])) porosity.points.push_back({axial->axis[k], 1.0 - axial->value[k]});
    if (porosity.points.empty()) return std::nullopt;
    return Chart{"porosity against the height", {"height above the floor (mm)", false}, {"porosity", false}, {std::move(porosity)}};
}

std::optional<Chart> orientation_over_radius(const Observables& bed) {
    Chart chart{"orientation of the pellets' axes", {"distance from the tube's axis (mm)", false}, {"mean |component| of the pellet's axis", false}, {}};
    double end = 0.0;
    for (const auto& [name, label, colour, marker] : {std::tuple{"axis_alignment_radial", "along the vertical", blue, Marker::disc},
                                                      std::tuple{"axis_radial_radial", "along the radius", red, Marker::square}}) {
        const Profile* profile = profile_of(bed, name);
        if (profile == nullptr) return std::nullopt;
        ChartSeries series = line_of(label, colour);
        series.marker = marker;
        for (std::size_t k = 0; k < profile->axis.size(); ++k)
            if (std::isfinite(profile->standard_error[k])) {
                series.points.push_back({profile->axis[k], profile->value[k]});
                series.errors.push_back(profile->standard_error[k]);
            }
        if (series.points.empty()) return std::nullopt;
        end = std::max(end, series.points.back().x);
        chart.series.push_back(std::move(series));
    }
    chart.series.insert(chart.series.begin(), level_line({"random", 0.5}, 0.0, end, grey));
    return chart;
}

std::optional<Chart> contact_forces(const Observables& bed) {
    const Profile* forces = profile_of(bed, "contact_force_distribution");
    if (forces == nullptr) return std::nullopt;
    ChartSeries series = line_of("pairs of pellets", blue);
    series.marker = Marker::disc;
    for (std::size_t k = 0; k < forces->axis.size(); ++k)
        if (forces->value[k] > 0.0) series.points.push_back({forces->axis[k], forces->value[k]});
    if (series.points.empty()) return std::nullopt;
    ChartSeries exponential = line_of("exp(-f)", grey);
    exponential.dashed = true;
    for (const double f : {0.0, series.points.back().x}) exponential.points.push_back({f, std::exp(-f)});
    return Chart{"elastic forces between pellets", {"force / mean force", false}, {"density", true}, {std::move(exponential), std::move(series)}};
}

std::optional<Chart> collision_spectrum(const Observables& tester, const std::string& energy) {
    std::string words = energy;
    std::replace(words.begin(), words.end(), '_', ' ');
    Chart chart{"collisions by " + words, {"", true}, {"events per pellet and second, in bins of 1/8 decade", true}, {}};
    for (const auto& [kind, label, colour, marker] :
         {std::tuple{"pellets", "pellet - pellet", blue, Marker::disc}, std::tuple{"wall", "pellet - wall", green, Marker::square},
          std::tuple{"baffle", "pellet - baffle", red, Marker::diamond}}) {
        const Profile* spectrum = profile_of(tester, "spectrum_" + energy + "_" + kind);
        if (spectrum == nullptr) continue;
        chart.horizontal.label = words + " (" + (spectrum->axis_unit == "uJ" ? "µJ" : spectrum->axis_unit) + ")";
        ChartSeries series = line_of(label, colour);
        series.marker = marker;
        for (std::size_t k = 0; k < spectrum->axis.size(); ++k)
            if (spectrum->axis[k] > 0.0 && spectrum->value[k] > 0.0) series.points.push_back({spectrum->axis[k], spectrum->value[k]});
        if (!series.points.empty()) chart.series.push_back(std::move(series));
    }
    if (chart.series.empty()) return std::nullopt;
    return chart;
}

}  // namespace pelletlab::report
