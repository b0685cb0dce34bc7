#include "report/detail/svg_chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pelletlab::report::detail {

namespace {

constexpr double width = 340.0, height = 250.0, left = 48.0, bottom = 32.0, top = 22.0, right = 10.0;

struct Scale {
    double low, high, from, to;
    double operator()(double v) const { return from + (v - low) / (high - low) * (to - from); }
};

std::string polyline(const DiagnosisCurve& c, const std::vector<double>& y, const Scale& sx, const Scale& sy, const char* attributes) {
    std::string points;
    for (std::size_t i = 0; i < y.size(); ++i) points += fmt::format("{:.1f},{:.1f} ", sx(c.axis[i]), sy(y[i]));
    return fmt::format("<polyline points='{}' fill='none' {}/>", points, attributes);
}

std::string bar(double y, const std::string& name, double value, double largest, const char* colour, const std::string& text) {
    const double length = largest > 0.0 ? 300.0 * std::max(0.0, value) / largest : 0.0;
    return fmt::format(
        "<text x='175' y='{:.0f}' text-anchor='end'>{}</text><rect x='182' y='{:.0f}' width='{:.1f}' height='14' fill='{}'/><text x='{:.1f}' "
        "y='{:.0f}'>{}</text>",
        y + 12, escaped(name), y, length, colour, 188.0 + length, y + 12, text);
}

}  // namespace

std::string escaped(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if (c == '<')
            out += "&lt;";
        else if (c == '>')
            out += "&gt;";
        else if (c == '&')
            out += "&amp;";
        else if (c == '\'')
            out += "&#39;";
        else if (c == '"')
            out += "&quot;";
        else
            out += c;
    }
    return out;
}

std::string profile_chart(const DiagnosisCurve& c) {
    double low = 1e300, high = -1e300;
    for (const auto* y : {&c.value, &c.baseline, &c.explained})
        for (const double v : *y) {
            low = std::min(low, v);
            high = std::max(high, v);
        }
    if (high <= low) high = low + 1.0;
    const Scale sx{c.axis.front(), c.axis.back(), left, width - right}, sy{low, high, height - bottom, top};
    std::string svg =
        fmt::format("<svg width='{:.0f}' height='{:.0f}' font-size='11' font-family='system-ui,sans-serif'><text x='{}' y='14' font-weight='600'>{}{}</text>",
                    width, height, left, escaped(c.name), c.held_out ? " (held out)" : "");
    std::string gap;
    for (std::size_t i = 0; i < c.axis.size(); ++i) gap += fmt::format("{:.1f},{:.1f} ", sx(c.axis[i]), sy(c.value[i]));
    for (std::size_t i = c.axis.size(); i > 0; --i) gap += fmt::format("{:.1f},{:.1f} ", sx(c.axis[i - 1]), sy(c.baseline[i - 1]));
    svg += fmt::format("<polygon points='{}' fill='#b3261e' fill-opacity='0.25'/>", gap);
    svg += polyline(c, c.baseline, sx, sy, "stroke='#10365c' stroke-width='1.6'") +
           polyline(c, c.explained, sx, sy, "stroke='#c77700' stroke-width='1.6' stroke-dasharray='5 3'");
    for (std::size_t i = 0; i < c.axis.size(); ++i) {
        svg += fmt::format("<line x1='{0:.1f}' x2='{0:.1f}' y1='{1:.1f}' y2='{2:.1f}' stroke='#1c2430'/>", sx(c.axis[i]), sy(c.value[i] - 2 * c.uncertainty[i]),
                           sy(c.value[i] + 2 * c.uncertainty[i]));
        svg += fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='2' fill='#1c2430'/>", sx(c.axis[i]), sy(c.value[i]));
    }
    svg += fmt::format("<path d='M{0} {1}V{2}H{3}' fill='none' stroke='#8a94a3'/>", left, top, height - bottom, width - right);
    for (const double t : {0.0, 0.5, 1.0}) {
        const double x = c.axis.front() + t * (c.axis.back() - c.axis.front()), y = low + t * (high - low);
        svg += fmt::format("<text x='{:.0f}' y='{:.0f}' text-anchor='middle'>{:.3g}</text>", sx(x), height - bottom + 14, std::abs(x) < 1e-12 ? 0.0 : x);
        svg += fmt::format("<text x='{:.0f}' y='{:.0f}' text-anchor='end'>{:.3g}</text>", left - 5, sy(y) + 4, y);
    }
    svg += fmt::format("<text x='{:.0f}' y='{:.0f}' text-anchor='middle'>{}</text></svg>", 0.5 * (left + width), height - 3, escaped(c.axis_name));
    return svg;
}

std::string probability_bars(const Diagnosis& d) {
    std::vector<std::pair<std::string, double>> bars;
    for (const auto& one : d.inclusion) bars.emplace_back(one.effect, one.probability);
    for (const auto& h : d.hypotheses)
        if (h.name == "parameters only" || h.name == "none of these") bars.emplace_back(h.name, h.probability);
    const double size = 20.0 * static_cast<double>(bars.size()) + 26.0;
    std::string svg = fmt::format("<svg width='560' height='{:.0f}' font-size='12' font-family='system-ui,sans-serif'>", size);
    double y = 6.0;
    for (const auto& [name, p] : bars) {
        svg += bar(y, name, p, 1.0, p >= d.claim_threshold ? "#b3261e" : "#7d93ad", fmt::format("{:.3f}", p));
        y += 20.0;
    }
    const double x = 182.0 + 300.0 * d.claim_threshold;
    return svg + fmt::format(
                     "<line x1='{0:.1f}' x2='{0:.1f}' y1='0' y2='{1:.0f}' stroke='#1c2430' stroke-dasharray='3 3'/><text x='{0:.1f}' y='{2:.0f}' "
                     "text-anchor='middle'>threshold</text></svg>",
                     x, y, y + 14);
}

std::string budget_bars(const Diagnosis& d) {
    double largest = 0.0;
    for (const auto& s : d.how_far) largest = std::max({largest, s.before, s.after, std::isnan(s.placebo) ? 0.0 : s.placebo});
    std::string svg =
        fmt::format("<svg width='560' height='{:.0f}' font-size='12' font-family='system-ui,sans-serif'>", 90.0 * static_cast<double>(d.how_far.size()) + 10.0);
    double y = 6.0;
    for (const auto& s : d.how_far) {
        svg += bar(y, s.data + ": before", s.before, largest, "#b3261e", fmt::format("{:.2f}", s.before));
        svg += bar(y + 20, "after", s.after, largest, "#c77700", fmt::format("{:.2f}", s.after));
        if (!std::isnan(s.placebo)) svg += bar(y + 40, "placebo", s.placebo, largest, "#9aa5b5", fmt::format("{:.2f}", s.placebo));
        svg += bar(y + 60, "measurement noise", s.floor, largest, "#d5dbe3", fmt::format("{:.2f}", s.floor));
        y += 90.0;
    }
    return svg + "</svg>";
}

}  // namespace pelletlab::report::detail
