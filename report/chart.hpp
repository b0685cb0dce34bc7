// Charts of numbers: points and lines over two axes, each linear or logarithmic, with a key.
#pragma once

#include <string>
#include <vector>

#include "report/draw.hpp"
#include "report/pictures.hpp"

namespace pelletlab::report {

enum class Marker { disc, ring, square, diamond, cross, none };

struct ChartSeries {
    std::string name;                 ///< in the key
    std::vector<Point> points;        ///< in the units of the axes, in the order of the line
    std::vector<std::string> labels;  ///< one a point beside it, or none at all
    Srgb colour = {33, 102, 172};
    Marker marker = Marker::disc;
    bool line = false;                ///< joins the points
    bool dashed = false;              ///< … with a broken line
    std::vector<double> errors = {};  ///< one a point, drawn as an upright bar of ± this; or none at all. Not on a logarithmic axis
};

struct ChartAxis {
    std::string label;  ///< «DEM cost / that of Shape 2»
    bool logarithmic = false;
};

struct Chart {
    std::string title;
    ChartAxis horizontal, vertical;
    std::vector<ChartSeries> series;  ///< later ones are drawn over earlier ones and stand above them in the key
};

/// Ticks of a logarithmic axis inside [lower, upper]: powers of ten, with more between them when there are few. Throws Error(bad_input) unless
/// 0 < lower < upper, both finite.
std::vector<double> log_ticks(double lower, double upper);

/// `settings.width` wide, 5 : 8. Throws Error(bad_input) without points, for coordinates that are not finite, or not positive on a logarithmic axis, when the
/// labels or errors are not one a point, and for errors on a logarithmic axis.
Image picture_of_chart(const Chart& chart, const PictureSettings& settings);

}  // namespace pelletlab::report
