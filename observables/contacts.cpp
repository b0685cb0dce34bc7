#include "observables/contacts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "observables/detail/closest_point.hpp"
#include "observables/detail/near_pairs.hpp"
#include "observables/statistics.hpp"

namespace pelletlab::observables {

namespace {

constexpr double millinewton = 1e-3;
constexpr double force_bin = 0.25;  // of the mean force

struct Touch {
    std::size_t contacts = 0;
    Vec3 force = Vec3::Zero();  ///< [N], on the second body, or on the wall
};

/// Elastic normal force [N] at an overlap.
double elastic_force(const ContactStiffness& law, double stiffness, double radius, double overlap) {
    return law.hertz ? 4.0 / 3.0 * stiffness * std::sqrt(radius * overlap) * overlap : stiffness * overlap;
}

struct Instant {
    const TrajectoryHeader& header;
    const Frame& frame;
    std::vector<std::size_t> bodies;
    std::vector<double> reach;  ///< [m], one a shape

    const RigidTemplate& rigid(std::size_t body) const { return header.shapes[header.shape_of_body[body]].rigid; }
    Pose pose(std::size_t body) const { return {frame.positions[body], frame.orientations[body]}; }
};

Touch touch_of_pair(const Instant& now, std::size_t a, std::size_t b, const std::optional<ContactStiffness>& law) {
    Touch touch;
    const Pose pose_a = now.pose(a), pose_b = now.pose(b);
    std::vector<Sphere> others;  // of b that come near a, in the world
    for (const Sphere& sphere : now.rigid(b).spheres) {
        const Vec3 centre = pose_b.to_world(sphere.centre);
        if ((centre - pose_a.position).norm() < now.reach[now.header.shape_of_body[a]] + sphere.radius) others.push_back({centre, sphere.radius});
    }
    for (const Sphere& sphere : now.rigid(a).spheres) {
        const Vec3 centre = pose_a.to_world(sphere.centre);
        for (const Sphere& other : others) {
            const Vec3 apart = other.centre - centre;
            const double sum = sphere.radius + other.radius, squared = apart.squaredNorm();
            if (squared >= sum * sum) continue;
            ++touch.contacts;
            const double distance = std::sqrt(squared);
            if (law && distance > 0.0) touch.force += apart / distance * elastic_force(*law, law->pellets, sphere.radius * other.radius / sum, sum - distance);
        }
    }
    return touch;
}

/// The point of a wall that is nearest to a point; faces that a body cannot reach are left out.
class WallSurface {
public:
    WallSurface(const WallShape& wall, const Pose& pose, const TubeGeometry& tube, TubeSurface surface) : tube_(tube) {
        if (surface == TubeSurface::exact && wall.name == "shell") kind_ = Kind::cylinder;
        if (surface == TubeSurface::exact && wall.name == "floor") kind_ = Kind::plane;
        mesh_ = transformed(wall.mesh, pose);
    }
    void approach(const Vec3& centre, double reach) {
        near_.clear();
        if (kind_ != Kind::mesh) return;
        for (std::size_t f = 0; f < mesh_.faces.size(); ++f) {
            const Vec3 a = mesh_.corner(f, 0), b = mesh_.corner(f, 1), c = mesh_.corner(f, 2);
            if ((detail::closest_point(centre, a, b, c) - centre).squaredNorm() < reach * reach) near_.push_back({a, b, c});
        }
    }
    /// Vector from `centre` to the nearest point; infinite when no face is near.
    Vec3 to_surface(const Vec3& centre) const {
        if (kind_ == Kind::plane) return {0.0, 0.0, tube_.floor - centre.z()};
        if (kind_ == Kind::cylinder) {
            const double distance = centre.head<2>().norm();
            if (!(distance > 0.0)) return {tube_.radius, 0.0, 0.0};
            return Vec3(centre.x(), centre.y(), 0.0) * ((tube_.radius - distance) / distance);
        }
        Vec3 best = Vec3::Constant(std::numeric_limits<double>::infinity());
        for (const auto& [a, b, c] : near_)
            if (const Vec3 to = detail::closest_point(centre, a, b, c) - centre; !(to.squaredNorm() >= best.squaredNorm())) best = to;
        return best;
    }

private:
    enum class Kind { mesh, cylinder, plane };
    Kind kind_ = Kind::mesh;
    const TubeGeometry& tube_;
    TriangleMesh mesh_;
    std::vector<std::array<Vec3, 3>> near_;
};

Touch touch_of_wall(const Instant& now, std::size_t body, WallSurface& wall, const ContactStiffness* law, double stiffness) {
    Touch touch;
    const Pose pose = now.pose(body);
    wall.approach(pose.position, now.reach[now.header.shape_of_body[body]]);
    for (const Sphere& sphere : now.rigid(body).spheres) {
        const Vec3 to = wall.to_surface(pose.to_world(sphere.centre));
        const double distance = to.norm();
        if (!(distance < sphere.radius)) continue;
        ++touch.contacts;
        if (law != nullptr && distance > 0.0) touch.force += to / distance * elastic_force(*law, stiffness, sphere.radius, sphere.radius - distance);
    }
    return touch;
}

/// Density of f = force / mean force in bins of 0.25: Σ density · 0.25 = 1.
Profile force_distribution(const std::vector<double>& forces, double mean, const TimeWindow& window) {
    Profile profile{"contact_force_distribution", "1", "force_over_mean", "1", {}, {}, {}, window, "tube.contact_forces"};
    const auto bins = static_cast<std::size_t>(*std::max_element(forces.begin(), forces.end()) / mean / force_bin) + 1;
    std::vector<double> count(bins, 0.0);
    for (const double force : forces) count[static_cast<std::size_t>(force / mean / force_bin)] += 1.0;
    const double n = static_cast<double>(forces.size());
    for (std::size_t k = 0; k < bins; ++k) {
        profile.axis.push_back((static_cast<double>(k) + 0.5) * force_bin);
        profile.value.push_back(count[k] / n / force_bin);
        profile.standard_error.push_back(std::sqrt(count[k]) / n / force_bin);
    }
    return profile;
}

Profile neighbour_distribution(const std::vector<std::size_t>& neighbours, std::size_t pellets, const TimeWindow& window) {
    Profile profile{"touching_neighbours_distribution", "1", "neighbours", "1", {}, {}, {}, window, "tube.contacts"};
    profile.value.assign(*std::max_element(neighbours.begin(), neighbours.end()) + 1, 0.0);
    for (const std::size_t n : neighbours) profile.value[n] += 1.0 / static_cast<double>(pellets);
    for (std::size_t k = 0; k < profile.value.size(); ++k) profile.axis.push_back(static_cast<double>(k));
    profile.standard_error.assign(profile.value.size(), not_known);
    return profile;
}

Instant last_instant(const FrameSource& trajectory, const Frame& frame, const TubeGeometry& tube) {
    Instant now{trajectory.header(), frame, {}, {}};
    for (const PelletShape& shape : now.header.shapes) {
        if (shape.rigid.spheres.empty()) throw bad_input("the pellets have no spheres, so their contacts are not known", "give their clump");
        now.reach.push_back(bounding_radius(shape.rigid.spheres));
    }
    for (std::size_t body = 0; body < frame.positions.size(); ++body) {
        const Vec3& p = frame.positions[body];
        if (p.head<2>().norm() <= tube.radius && p.z() >= tube.floor) now.bodies.push_back(body);
    }
    if (now.bodies.empty()) throw bad_input("no pellet lies inside the tube", "check the tube's radius and floor against the trajectory");
    return now;
}

}  // namespace

double effective_modulus(double shear_modulus_1, double poisson_ratio_1, double shear_modulus_2, double poisson_ratio_2) {
    const auto compliance = [](double g, double nu) { return (1.0 - nu) / (2.0 * g); };  // (1 − ν²) / (2 G (1 + ν))
    return 1.0 / (compliance(shear_modulus_1, poisson_ratio_1) + compliance(shear_modulus_2, poisson_ratio_2));
}

void add_frame_contacts(Observables& result, const FrameSource& trajectory, const TubeGeometry& tube, TubeSurface surface,
                        const std::optional<ContactStiffness>& stiffness) {
    if (trajectory.frame_count() == 0) throw bad_input("the trajectory holds no frame", "run the case again");
    const Frame frame = trajectory.frame(trajectory.frame_count() - 1);
    const Instant now = last_instant(trajectory, frame, tube);
    const TimeWindow window{frame.time, frame.time};
    const double pellets = static_cast<double>(now.bodies.size());
    const auto add = [&](const char* name, const char* unit, double value, const char* method) {
        result.values.push_back({name, unit, value, not_known, window, method});
    };

    const auto pairs = detail::near_pairs(now.header, frame, now.bodies, now.reach, 0.0);
    std::vector<Touch> touches(pairs.size());
    parallel_for(pairs.size(), 64, [&](std::size_t k) { touches[k] = touch_of_pair(now, pairs[k].first, pairs[k].second, stiffness); });
    std::vector<std::size_t> neighbours(frame.positions.size(), 0), partners(frame.positions.size(), 0);
    std::vector<double> forces;
    double sphere_contacts = 0.0, touching = 0.0;
    for (std::size_t k = 0; k < pairs.size(); ++k) {
        if (touches[k].contacts == 0) continue;
        touching += 1.0;
        sphere_contacts += static_cast<double>(touches[k].contacts);
        ++neighbours[pairs[k].first], ++neighbours[pairs[k].second];
        if (stiffness) forces.push_back(touches[k].force.norm());
    }
    partners = neighbours;
    double wall_contacts = 0.0;
    Vec3 on_floor = Vec3::Zero();
    bool has_floor = false;
    for (std::size_t w = 0; w < now.header.walls.size(); ++w) {
        WallSurface wall(now.header.walls[w], frame.wall_poses[w], tube, surface);
        const double of_wall = stiffness ? stiffness->walls.at(w) : 0.0;
        for (const std::size_t body : now.bodies) {
            const Touch touch = touch_of_wall(now, body, wall, stiffness ? &*stiffness : nullptr, of_wall);
            wall_contacts += static_cast<double>(touch.contacts);
            if (touch.contacts > 0) ++partners[body];
            if (now.header.walls[w].name == "floor") on_floor += touch.force;
        }
        has_floor = has_floor || now.header.walls[w].name == "floor";
    }
    double loose = 0.0;
    std::vector<std::size_t> of_bodies;
    for (const std::size_t body : now.bodies) {
        of_bodies.push_back(neighbours[body]);
        if (partners[body] < 2) loose += 1.0;
    }
    add("touching_neighbours", "1", 2.0 * touching / pellets, "tube.contacts");
    add("sphere_contacts_per_pellet", "1", sphere_contacts / pellets, "tube.contacts");
    if (!now.header.walls.empty()) add("wall_contacts_per_pellet", "1", wall_contacts / pellets, "tube.contacts");
    if (!now.header.walls.empty()) add("loose_pellet_share", "1", loose / pellets, "tube.contacts");
    result.profiles.push_back(neighbour_distribution(of_bodies, now.bodies.size(), window));

    if (!stiffness || forces.empty()) return;
    const double mean = mean_of(forces), g = now.header.gravity.norm();
    double weight = 0.0;
    for (const std::size_t body : now.bodies) weight += now.rigid(body).mass_properties.mass * g;
    add("contact_force_mean", "mN", mean / millinewton, "tube.contact_forces");
    add("contact_force_p95", "mN", percentile(forces, 0.95) / millinewton, "tube.contact_forces");
    add("contact_force_max", "mN", *std::max_element(forces.begin(), forces.end()) / millinewton, "tube.contact_forces");
    if (weight > 0.0) {
        add("contact_force_over_weight", "1", mean * pellets / weight, "tube.contact_forces");
        if (has_floor) add("floor_elastic_share", "1", on_floor.dot(now.header.gravity) / (g * weight), "tube.contact_forces");
    }
    if (mean > 0.0) result.profiles.push_back(force_distribution(forces, mean, window));
}

}  // namespace pelletlab::observables
