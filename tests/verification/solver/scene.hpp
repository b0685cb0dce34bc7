// Small scenes that the solver's tests share.
#pragma once

#include <cmath>
#include <vector>

#include "core/random.hpp"
#include "solver/simulation.hpp"

namespace pelletlab::solver::scene {

inline RigidTemplate sphere_template(double radius, double density) {
    RigidTemplate t;
    t.name = "sphere";
    t.spheres = {{Vec3::Zero(), radius}};
    MassProperties& m = t.mass_properties;
    m.volume = 4.0 / 3.0 * M_PI * radius * radius * radius;
    m.density = density;
    m.mass = m.volume * density;
    m.principal_inertia = Vec3::Constant(0.4 * m.mass * radius * radius);
    t.bounding_radius = radius;
    return t;
}

/// A pellet of the reference study, D 3.12 mm × H 2.96 mm, axis z: rings of spheres inside the cylinder, exact mass properties.
inline RigidTemplate cylinder_template(int rings, int per_ring, double radius = 0.765e-3) {
    RigidTemplate t;
    t.name = "cylinder";
    const double big_r = 1.56e-3, h = 2.96e-3;
    for (int k = 0; k < rings; ++k)
        for (int j = 0; j < per_ring; ++j) {
            const double angle = 2.0 * M_PI * (j + 0.5 * (k % 2)) / per_ring;
            const double z = rings == 1 ? 0.0 : -0.5 * h + radius + (h - 2.0 * radius) * k / (rings - 1);
            t.spheres.push_back({{(big_r - radius) * std::cos(angle), (big_r - radius) * std::sin(angle), z}, radius});
        }
    MassProperties& m = t.mass_properties;
    m.volume = M_PI * big_r * big_r * h;
    m.density = 1800.0;
    m.mass = m.volume * m.density;
    const double transverse = m.mass * (3.0 * big_r * big_r + h * h) / 12.0;
    m.principal_inertia = {transverse, transverse, 0.5 * m.mass * big_r * big_r};
    t.bounding_radius = bounding_radius(t.spheres);
    return t;
}

inline RigidTemplate dumbbell_template(double radius, double distance, double density) {
    RigidTemplate t = sphere_template(radius, density);
    t.name = "dumbbell";
    t.spheres = {{{-0.5 * distance, 0.0, 0.0}, radius}, {{0.5 * distance, 0.0, 0.0}, radius}};
    MassProperties& m = t.mass_properties;
    m.volume *= 2.0;
    m.mass *= 2.0;
    const double across = 0.4 * m.mass * radius * radius + m.mass * 0.25 * distance * distance;
    m.principal_inertia = {0.4 * m.mass * radius * radius, across, across};
    t.bounding_radius = bounding_radius(t.spheres);
    return t;
}

/// Square plate in z = 0 made of n × n cells of two triangles.
inline TriangleMesh plate(double half, int n = 1) {
    TriangleMesh mesh;
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) mesh.vertices.push_back({-half + 2.0 * half * i / n, -half + 2.0 * half * j / n, 0.0});
    const auto at = [n](int i, int j) { return static_cast<std::uint32_t>(j * (n + 1) + i); };
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            mesh.faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            mesh.faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    return mesh;
}

/// Open tube with axis y, n facets.
inline TriangleMesh tube(double radius, double length, int n) {
    TriangleMesh mesh;
    for (int k = 0; k < n; ++k) {
        const double a = 2.0 * M_PI * k / n;
        mesh.vertices.push_back({radius * std::cos(a), -0.5 * length, radius * std::sin(a)});
        mesh.vertices.push_back({radius * std::cos(a), 0.5 * length, radius * std::sin(a)});
    }
    for (int k = 0; k < n; ++k) {
        const auto a = static_cast<std::uint32_t>(2 * k), b = static_cast<std::uint32_t>(2 * ((k + 1) % n));
        mesh.faces.push_back({a, b, b + 1});
        mesh.faces.push_back({a, b + 1, a + 1});
    }
    return mesh;
}

inline TriangleMesh box(const Vec3& low, const Vec3& high) {
    TriangleMesh mesh;
    for (int k = 0; k < 8; ++k) mesh.vertices.push_back({(k & 1) ? high.x() : low.x(), (k & 2) ? high.y() : low.y(), (k & 4) ? high.z() : low.z()});
    mesh.faces = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4}, {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return mesh;
}

inline WallDefinition wall(const std::string& name, TriangleMesh mesh, PairParameters contact, ElasticMaterial material = {3e9, 0.25}) {
    WallDefinition w;
    w.name = name;
    w.mesh = std::move(mesh);
    w.contact = contact;
    w.material = material;
    return w;
}

/// A few hundred pellets on a lattice with random orientations, above the floor of a mesh box.
inline SimulationDefinition falling_definition(const RigidTemplate& pellet, double time_step = 1e-5) {
    SimulationDefinition d;
    d.templates = {pellet};
    d.pellet_contact = {0.4, 0.7, 0.05};
    d.walls = {wall("box", box({-0.012, -0.012, 0.0}, {0.012, 0.012, 0.2}), {0.4, 0.6, 0.05})};
    d.time_step = time_step;
    return d;
}

inline std::vector<BodyPlacement> lattice(int nx, int ny, int nz, double spacing, std::uint64_t seed, double speed = 0.5) {
    std::vector<BodyPlacement> bodies;
    for (int k = 0; k < nz; ++k)
        for (int j = 0; j < ny; ++j)
            for (int i = 0; i < nx; ++i) {
                RandomStream random(seed, bodies.size());
                BodyPlacement b;
                b.pose.position = {(i - 0.5 * (nx - 1)) * spacing, (j - 0.5 * (ny - 1)) * spacing, (k + 0.6) * spacing};
                b.pose.orientation = random.rotation();
                b.velocity = Vec3(random.normal(), random.normal(), random.normal()) * 0.1 - Vec3(0, 0, speed);
                b.spin = Vec3(random.normal(), random.normal(), random.normal()) * 20.0;
                bodies.push_back(b);
            }
    return bodies;
}

}  // namespace pelletlab::solver::scene
