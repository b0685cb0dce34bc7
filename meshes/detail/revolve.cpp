#include "meshes/detail/revolve.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "meshes/detail/rings.hpp"
#include "meshes/mass_properties.hpp"

namespace pelletlab::meshes::detail {
namespace {

constexpr double most_quads_of_a_part = 2048.0;
constexpr std::size_t most_cap_faces = 800;

}  // namespace

std::uint32_t piece_count(double length, double edge, std::uint32_t facets, std::uint32_t least) {
    const double most = std::max(static_cast<double>(least), std::floor(most_quads_of_a_part / facets));
    return static_cast<std::uint32_t>(std::clamp(std::round(length / edge), static_cast<double>(least), most));
}

void add_line(std::vector<ProfilePoint>& profile, ProfilePoint to, std::uint32_t pieces) {
    const ProfilePoint from = profile.back();
    for (std::uint32_t k = 1; k < pieces; ++k) {
        const double s = static_cast<double>(k) / pieces;
        profile.push_back({from.r + s * (to.r - from.r), from.z + s * (to.z - from.z)});
    }
    profile.push_back(to);
}

void add_arc(std::vector<ProfilePoint>& profile, ProfilePoint centre, double radius, double from, double to, std::uint32_t pieces) {
    for (std::uint32_t k = 1; k <= pieces; ++k) {
        const double angle = from + (to - from) * k / pieces;
        profile.push_back({centre.r + radius * std::cos(angle), centre.z + radius * std::sin(angle)});
    }
}

TriangleMesh revolve(const std::vector<ProfilePoint>& profile, std::uint32_t facets) {
    double widest = 0.0;
    for (const ProfilePoint& p : profile) widest = std::max(widest, p.r);
    const double edge = 2.0 * std::numbers::pi * widest / facets;
    TriangleMesh mesh;
    std::vector<Ring> rings(profile.size());
    const auto is_pole = [&](std::size_t i) { return profile[i].r <= 1e-12 * widest; };
    for (std::size_t i = 0; i < profile.size(); ++i) {
        if (is_pole(i)) {
            rings[i] = {static_cast<std::uint32_t>(mesh.vertices.size()), 1};
            mesh.vertices.emplace_back(0.0, 0.0, profile[i].z);
            continue;
        }
        // Away from the axis all rings have the same vertices, side by side. Towards it edges keep the length between the facets' and the profile's steps.
        std::uint32_t count = facets;
        if (profile[i].r < 0.7 * widest) {
            const std::size_t next = i + 1 < profile.size() ? i + 1 : i - 1;
            const double step = std::hypot(profile[next].r - profile[i].r, profile[next].z - profile[i].z);
            const double wanted = std::round(2.0 * std::numbers::pi * profile[i].r / std::sqrt(edge * std::max(edge, step)));
            count = static_cast<std::uint32_t>(std::clamp(wanted, std::min(6.0, static_cast<double>(facets)), static_cast<double>(facets)));
        }
        rings[i] = add_ring(mesh, count, profile[i].r, profile[i].z);
    }
    for (std::size_t i = 1; i < profile.size(); ++i) {
        if (is_pole(i - 1))
            for (std::uint32_t k = 0; k < rings[i].count; ++k) mesh.faces.push_back({rings[i].at(k + 1), rings[i].at(k), rings[i - 1].first});
        else if (is_pole(i))
            for (std::uint32_t k = 0; k < rings[i - 1].count; ++k) mesh.faces.push_back({rings[i - 1].at(k), rings[i - 1].at(k + 1), rings[i].first});
        else
            add_band(mesh, rings[i - 1], rings[i]);
    }
    const std::size_t last = profile.size() - 1;
    if (!is_pole(0)) add_flat_cap(mesh, rings[0], profile[0].r, profile[0].z, false, most_cap_faces);
    if (!is_pole(last)) add_flat_cap(mesh, rings[last], profile[last].r, profile[last].z, true, most_cap_faces);
    return mesh;
}

void scale_radii_to_volume(TriangleMesh& mesh, double volume) {
    const double factor = std::sqrt(volume / volume_moments(mesh).volume);
    for (Vec3& v : mesh.vertices) {
        v.x() *= factor;
        v.y() *= factor;
    }
}

}  // namespace pelletlab::meshes::detail
