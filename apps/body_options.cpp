#include "apps/body_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <map>

#include "core/error.hpp"
#include "meshes/named_body.hpp"

namespace pelletlab::apps {

namespace {

const std::map<std::string, meshes::RepairMethod>& repairs() {
    static const std::map<std::string, meshes::RepairMethod> methods{{"automatic", meshes::RepairMethod::automatic},
                                                                     {"fill-holes", meshes::RepairMethod::fill_holes},
                                                                     {"unite-shells", meshes::RepairMethod::unite_shells},
                                                                     {"alpha-wrap", meshes::RepairMethod::alpha_wrap}};
    return methods;
}

}  // namespace

std::string list_of_bodies() {
    std::string text = "Bodies, with their defaults (and facets=128):\n";
    for (const meshes::NamedBody& body : meshes::named_bodies()) text += fmt::format("  {}\n      {}\n", body.example, body.what);
    return text;
}

void add_body_options(CLI::App& verb, BodyOptions& options) {
    verb.add_option("mesh", options.mesh, "STL, OBJ or PLY file of one closed body");
    verb.add_option("--unit", options.unit, "Unit of the mesh's coordinates: mm, m, um, in, … (the file does not say)");
    verb.add_option("--body", options.parametric, "A parametric body instead of a mesh file: cylinder:diameter=3.12mm,height=2.96mm (see below)");
    verb.add_option("--repair", options.repair, "Mend an open, crossing or multi-shell mesh: automatic, fill-holes, unite-shells, alpha-wrap")
        ->check(CLI::IsMember(repairs()));
    verb.footer(list_of_bodies());
}

BodyRequest body_request(const BodyOptions& options) {
    if (options.mesh.empty() && options.parametric.empty())
        throw usage_error("a mesh file or --body is required", "for instance: pellet.stl --unit mm, or --body cylinder");
    if (!options.mesh.empty() && !options.parametric.empty()) throw usage_error("a mesh file and --body were given", "choose one of them");
    BodyRequest request;
    request.mesh_file = options.mesh;
    request.unit = options.unit;
    request.parametric = options.parametric;
    if (!options.repair.empty()) request.repair = repairs().at(options.repair);
    return request;
}

}  // namespace pelletlab::apps
