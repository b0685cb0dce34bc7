#include "shapegen/formats/formats.hpp"

#include "core/error.hpp"
#include "shapegen/formats/detail/entries.hpp"

namespace pelletlab::shapegen::formats {

const std::vector<Format>& all() {
    static const std::vector<Format> table{detail::liggghts(), detail::lammps(), detail::yade(), detail::mercury(), detail::chrono(),
                                           detail::pfc(),      detail::edem(),   detail::csv(),  detail::vtk(),     detail::stl()};
    return table;
}

const Format& find(std::string_view id) {
    for (const Format& format : all())
        if (format.id == id) return format;
    std::vector<std::string> known;
    std::string list;
    for (const Format& format : all()) {
        known.push_back(format.id);
        list += (list.empty() ? "" : ", ") + format.id;
    }
    const std::string guess = closest_word(std::string(id.substr(0, 40)), known);
    throw usage_error("unknown clump format '" + std::string(id.substr(0, 40)) + "'",
                      (guess.empty() ? "" : "did you mean '" + guess + "'? ") + ("known: " + list));
}

}  // namespace pelletlab::shapegen::formats
