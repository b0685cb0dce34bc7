#include "apps/shape_methods.hpp"

#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "meshes/mass_properties.hpp"
#include "shapegen/baselines/baselines.hpp"
#include "shapegen/hand_made.hpp"

namespace pelletlab::apps {

namespace {

constexpr double study_diameter = 3.12e-3, study_height = 2.96e-3;  // [m]
constexpr const char* study_prefix = "shape";

}  // namespace

const std::vector<NamedMethod>& all_methods() {
    static const std::vector<NamedMethod> methods = [] {
        std::vector<NamedMethod> list{{fit_method, "least squares on the signed distance"}};
        for (int k = 1; k <= 4; ++k) list.push_back({study_prefix + std::to_string(k), "study's Shape " + std::to_string(k) + ", hand-made"});
        for (const shapegen::baselines::Method& method : shapegen::baselines::methods()) list.push_back({method.id, method.name});
        return list;
    }();
    return methods;
}

const NamedMethod& find_method(const std::string& id) {
    std::vector<std::string> known;
    std::string list;
    for (const NamedMethod& method : all_methods()) {
        if (method.id == id) return method;
        known.push_back(method.id);
        list += (list.empty() ? "" : ", ") + method.id;
    }
    const std::string guess = closest_word(id.substr(0, 40), known);
    throw usage_error("there is no method '" + id.substr(0, 40) + "'", (guess.empty() ? "" : "did you mean '" + guess + "'? ") + ("known: " + list));
}

bool is_study_shape(const std::string& id) {
    return id.size() == 6 && id.starts_with(study_prefix);
}

bool is_study_cylinder(const TriangleMesh& body) {
    const MassProperties mass = meshes::mass_properties(body, 1.0);
    const double radius = 0.5 * study_diameter, volume = std::numbers::pi * radius * radius * study_height;
    const double axial = 0.5 * radius * radius, transverse = (3.0 * radius * radius + study_height * study_height) / 12.0;
    const Vec3 per_mass = mass.principal_inertia / mass.volume;
    return std::abs(mass.volume / volume - 1.0) < 0.01 && std::abs(per_mass.z() / axial - 1.0) < 0.01 && std::abs(per_mass.x() / transverse - 1.0) < 0.01 &&
           std::abs(per_mass.y() / transverse - 1.0) < 0.01;
}

std::vector<Sphere> spheres_of_method(const std::string& id, const TriangleMesh& body, const meshes::SignedDistance& exact, std::uint32_t sphere_count,
                                      std::uint64_t seed) {
    find_method(id);
    if (is_study_shape(id)) {
        if (!is_study_cylinder(body))
            throw bad_input("the study's shapes are made for its cylinder of 3.12 x 2.96 mm, and this body is another one", "choose another method");
        std::vector<Sphere> spheres = shapegen::hand_made_shape(id.back() - '0');
        const Pose pose = meshes::mass_properties(body, 1.0).body_in_mesh();  // z is the axis of the cylinder
        for (Sphere& sphere : spheres) sphere.centre = pose.to_world(sphere.centre);
        return spheres;
    }
    shapegen::baselines::BaselineSettings settings;
    settings.sphere_count = sphere_count;
    settings.seed = seed;
    return shapegen::baselines::baseline(id, body, exact, settings);
}

}  // namespace pelletlab::apps
