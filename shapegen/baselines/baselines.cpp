#include "shapegen/baselines/baselines.hpp"

#include <cmath>

#include "core/error.hpp"

namespace pelletlab::shapegen::baselines {

namespace {

constexpr std::uint32_t most_spheres = 2000;  // as many as the fit makes

struct Entry {
    Method method;
    std::vector<Sphere> (*make)(const TriangleMesh&, const meshes::SignedDistance&, const BaselineSettings&);
};

const std::vector<Entry>& table() {
    static const std::vector<Entry> entries{
        {{"openvdb", "OpenVDB fillWithSpheres"},
         [](const TriangleMesh& body, const meshes::SignedDistance&, const BaselineSettings& settings) { return openvdb_fill(body, settings); }},
        {{"favier", "Favier et al. 1999"}, favier},
        {{"ferellec", "Ferellec & McDowell 2010"}, ferellec_mcdowell},
        {{"euclidean", "Euclidean map (CLUMP)"}, euclidean_map}};
    return entries;
}

}  // namespace

const std::vector<Method>& methods() {
    static const std::vector<Method> all = [] {
        std::vector<Method> list;
        for (const Entry& entry : table()) list.push_back(entry.method);
        return list;
    }();
    return all;
}

std::vector<Sphere> baseline(const std::string& id, const TriangleMesh& body, const meshes::SignedDistance& exact, const BaselineSettings& settings) {
    if (settings.sphere_count == 0 || settings.sphere_count > most_spheres)
        throw bad_input("a clump of " + std::to_string(settings.sphere_count) + " spheres is out of reach",
                        "ask for 1 to " + std::to_string(most_spheres) + " spheres");
    if (!(settings.overlap >= 0.0 && settings.overlap < 1.0)) throw bad_input("the overlap is not between 0 and 1", "give 0.6 as CLUMP does");
    if (!(settings.cell_fraction > 1.0 / 512.0 && settings.cell_fraction <= 0.25))
        throw bad_input("the cell is not between 1/512 and 1/4 of the smallest extent", "give 1/64");
    std::vector<std::string> known;
    for (const Entry& entry : table()) {
        if (entry.method.id == id) {
            std::vector<Sphere> spheres = entry.make(body, exact, settings);
            if (spheres.empty())
                throw bad_input(
                    "the method '" + id + "' finds no sphere inside this body",
                    id == "favier" ? "its spheres lie on the long axis, which is outside of this body: choose another method" : "choose another method");
            return spheres;
        }
        known.push_back(entry.method.id);
    }
    const std::string closest = closest_word(id, known);
    throw usage_error("there is no baseline '" + id + "'",
                      closest.empty() ? "choose openvdb, favier, ferellec or euclidean" : "did you mean '" + closest + "'?");
}

}  // namespace pelletlab::shapegen::baselines
