// Sizes and inks that all pictures share, in proportion to their width.
#pragma once

#include <cmath>
#include <string>

#include "core/error.hpp"
#include "report/colour_bar.hpp"
#include "report/pictures.hpp"

namespace pelletlab::report::detail {

struct Page {
    double unit = 1.0;  ///< [pixel], 1 on a picture 1200 pixels wide
    double margin = 40.0, bar_width = 22.0;
    TextStyle title, text, small;

    explicit Page(std::uint32_t width) : unit(width / 1200.0), margin(40.0 * unit), bar_width(22.0 * unit) {
        if (width < 200 || width > 20000) throw bad_input("a picture of " + std::to_string(width) + " pixels in width", "choose 200 to 20000 pixels");
        title.cap_height = std::max(6.0, 17.0 * unit);
        title.colour = {33, 38, 45};
        text.cap_height = std::max(5.5, 14.0 * unit);
        small = text;
        small.colour = {98, 106, 116};
    }
};

/// «1.25 s»
inline std::string time_text(double seconds) {
    return tick_text(seconds, seconds != 0.0 && std::abs(seconds) < 0.0995 ? 3 : 2) + " s";
}

}  // namespace pelletlab::report::detail
