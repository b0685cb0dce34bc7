#include "meshes/detail/polygons.hpp"
#include "meshes/detail/text_scan.hpp"

namespace pelletlab::meshes::detail {

Polygons parse_obj(std::string_view bytes, const std::filesystem::path& file) {
    Polygons polygons;
    TextScan scan(bytes, file);
    struct Named {
        std::uint32_t index;
        int line;
    };
    Named highest{0, 0};  // a face may name vertices that come later
    std::vector<std::uint32_t> polygon;
    while (scan.next_line(true)) {
        const std::string_view keyword = scan.word();
        if (keyword == "v") {
            const double x = scan.coordinate(), y = scan.coordinate(), z = scan.coordinate();
            polygons.points.push_back({x, y, z});
        } else if (keyword == "f") {
            polygon.clear();
            for (std::string_view word = scan.word(); !word.empty() && word.front() != '#'; word = scan.word()) {
                const std::string_view number = word.substr(0, word.find('/'));  // vertex/texture/normal
                long long index = 0;
                const auto [end, status] = std::from_chars(number.data(), number.data() + number.size(), index);
                const auto have = static_cast<long long>(polygons.points.size());
                if (index < 0) index += have + 1;  // counted back from the vertex read last
                if (status != std::errc() || end != number.data() + number.size() || index < 1 || index > 0xfffffffeLL)
                    throw scan.fault("«" + std::string(word.substr(0, 40)) + "» names no vertex", "export the mesh again");
                polygon.push_back(static_cast<std::uint32_t>(index - 1));
                if (polygon.back() >= highest.index) highest = {polygon.back(), scan.line()};
            }
            if (polygon.size() < 3) throw scan.fault("a face has fewer than three corners", "export the mesh again");
            polygons.add(polygon);
        }
    }
    if (polygons.count() > 0 && highest.index >= polygons.points.size())
        throw bad_input("a face names vertex " + std::to_string(highest.index + 1ULL) + ", but there are only " + std::to_string(polygons.points.size()),
                        "export the mesh again", {file.string(), highest.line});
    return polygons;
}

}  // namespace pelletlab::meshes::detail
