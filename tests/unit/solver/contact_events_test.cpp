// Contact events: impacts whose energies are known in closed form, and books that agree with the whole.
#include "solver/contact_events.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "core/random.hpp"
#include "solver/simulation.hpp"

namespace pelletlab::solver {
namespace {

constexpr double radius = 1.5e-3, density = 1800.0, restitution = 0.6;

RigidTemplate ball() {
    RigidTemplate t;
    t.name = "ball";
    t.spheres = {{Vec3::Zero(), radius}};
    t.bounding_radius = radius;
    MassProperties& m = t.mass_properties;
    m.volume = 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
    m.density = density;
    m.mass = density * m.volume;
    m.principal_inertia = Vec3::Constant(0.4 * m.mass * radius * radius);
    return t;
}

/// Two spheres side by side.
RigidTemplate dumbbell() {
    RigidTemplate t = ball();
    t.spheres = {{Vec3(-radius, 0, 0), radius}, {Vec3(radius, 0, 0), radius}};
    t.bounding_radius = 2.0 * radius;
    MassProperties& m = t.mass_properties;
    m.volume *= 2.0, m.mass *= 2.0;
    const double along = 0.4 * m.mass * radius * radius;
    m.principal_inertia = {along, along + m.mass * radius * radius, along + m.mass * radius * radius};
    return t;
}

SimulationDefinition free_of_weight(const RigidTemplate& t) {
    SimulationDefinition d;
    d.templates = {t};
    d.gravity = Vec3::Zero();
    d.pellet_contact = {restitution, 0.5, 0.0};
    d.time_step = 1e-6;
    d.physics.contact = ContactModel::hertz_impulse_exact;
    d.physics.energy_book = true;
    d.domain = {Vec3::Constant(-1.0), Vec3::Constant(1.0)};
    return d;
}

WallDefinition plate(double half) {
    WallDefinition wall;
    wall.name = "plate";
    wall.mesh.vertices = {{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}};
    wall.mesh.faces = {{0, 1, 2}, {0, 2, 3}};
    wall.material = {3e9, 0.25};
    wall.contact = {restitution, 0.5, 0.0};
    return wall;
}

double sum(const std::array<double, spectrum_bins>& bins) {
    double total = 0.0;
    for (const double value : bins) total += value;
    return total;
}

const EventSpectrum& spectrum(const ContactEvents& events, EventEnergy energy) {
    return events.spectra[static_cast<std::size_t>(energy)];
}

TEST(ContactEvents, BinsTellTheirEnergies) {
    EXPECT_EQ(spectrum_bin(0.0), 0u);
    EXPECT_EQ(spectrum_bin(-1.0), 0u);
    EXPECT_EQ(spectrum_bin(1.0), spectrum_bins - 1);
    for (std::size_t bin = 0; bin < spectrum_bins; ++bin) EXPECT_EQ(spectrum_bin(std::sqrt(spectrum_edge(bin) * spectrum_edge(bin + 1))), bin);
    EXPECT_NEAR(spectrum_edge(8), 1e-11, 1e-25);
}

TEST(ContactEvents, AHeadOnImpactCostsWhatTheRestitutionSays) {
    const RigidTemplate t = ball();
    Simulation s(free_of_weight(t));
    const double speed = 0.4;  // each
    s.add_bodies(std::vector<BodyPlacement>{{0, {Vec3(-1.01 * radius, 0, 0), Quat::Identity()}, speed * Vec3::UnitX(), Vec3::Zero()},
                                            {0, {Vec3(1.01 * radius, 0, 0), Quat::Identity()}, -speed * Vec3::UnitX(), Vec3::Zero()}});
    s.record_contact_events();
    s.advance(3000);
    const std::vector<ContactEvents> kinds = s.contact_events();
    ASSERT_EQ(kinds.size(), 1u);
    EXPECT_EQ(kinds[0].complete, 1.0);
    // ½ m* (2 v)², m* = m / 2; the first step of the contact has lost some 1e-3 of the speed.
    const double impact = 0.5 * 0.5 * t.mass_properties.mass * 4.0 * speed * speed;
    EXPECT_NEAR(sum(spectrum(kinds[0], EventEnergy::impact).energy), impact, 0.01 * impact);
    // 1 − e² of it is lost, all of it to normal damping.
    const double lost = (1.0 - restitution * restitution) * impact;
    EXPECT_NEAR(sum(spectrum(kinds[0], EventEnergy::normal).energy), lost, 0.005 * lost);
    EXPECT_NEAR(sum(spectrum(kinds[0], EventEnergy::total).energy), lost, 0.005 * lost);
    EXPECT_EQ(spectrum(kinds[0], EventEnergy::impact).count[spectrum_bin(impact)], 1.0);
    EXPECT_DOUBLE_EQ(kinds[0].dissipated, kinds[0].dissipated_complete);
    EXPECT_GT(kinds[0].duration, 1e-5);
    EXPECT_LT(kinds[0].duration, 1e-3);
}

TEST(ContactEvents, ADroppedSphereBouncesOnce) {
    const RigidTemplate t = ball();
    SimulationDefinition d = free_of_weight(t);
    d.gravity = {0.0, 0.0, -9.81};
    d.walls = {plate(0.05)};
    Simulation s(std::move(d));
    const double height = 5e-3, speed = std::sqrt(2.0 * 9.81 * height), fall = speed / 9.81;
    s.add_bodies(std::vector<BodyPlacement>{{0, {Vec3(0.001, 0.002, radius + height), Quat::Identity()}, Vec3::Zero(), Vec3::Zero()}});
    s.record_contact_events();
    s.advance(static_cast<std::uint64_t>((fall + 0.5 * restitution * fall) / 1e-6));  // half of the way up after the bounce
    const ContactEvents wall = s.contact_events()[1];
    EXPECT_EQ(s.contact_events()[0].complete, 0.0);
    EXPECT_EQ(wall.complete, 1.0);
    const double impact = 0.5 * t.mass_properties.mass * speed * speed;
    EXPECT_NEAR(sum(spectrum(wall, EventEnergy::impact).energy), impact, 1e-3 * impact) << "the first step of the contact is 0.3 um deep";
    EXPECT_EQ(spectrum(wall, EventEnergy::impact).count[spectrum_bin(impact)], 1.0);
    // Weight acts while they touch (g · duration is a part of the speed, once on the way in, once out): what is lost differs by that part.
    const double lost = (1.0 - restitution * restitution) * impact;
    EXPECT_NEAR(sum(spectrum(wall, EventEnergy::normal).energy), lost, (0.005 + 2.0 * 9.81 * wall.duration / speed) * lost);
    EXPECT_DOUBLE_EQ(sum(spectrum(wall, EventEnergy::total).energy), sum(spectrum(wall, EventEnergy::normal).energy)) << "nothing slides";
}

TEST(ContactEvents, TwoSpheresOfOneBodyOnAPlateAreOneEvent) {
    const RigidTemplate t = dumbbell();
    SimulationDefinition d = free_of_weight(t);
    d.walls = {plate(0.05)};
    Simulation s(std::move(d));
    s.add_bodies(std::vector<BodyPlacement>{{0, {Vec3(0.001, 0.002, 1.01 * radius), Quat::Identity()}, Vec3(0, 0, -0.3), Vec3::Zero()}});
    s.record_contact_events();
    s.advance(3000);
    const std::vector<ContactEvents> kinds = s.contact_events();
    ASSERT_EQ(kinds.size(), 2u);
    EXPECT_EQ(kinds[0].complete, 0.0);
    EXPECT_EQ(kinds[1].complete, 1.0);
    const double impact = 0.5 * t.mass_properties.mass * 0.3 * 0.3;
    EXPECT_NEAR(sum(spectrum(kinds[1], EventEnergy::impact).energy), impact, 0.01 * impact);
    const double before = impact, after = s.energy().kinetic_translation + s.energy().kinetic_rotation;
    EXPECT_NEAR(sum(spectrum(kinds[1], EventEnergy::total).energy), before - after, 1e-3 * before) << "what the body lacks afterwards";
}

TEST(ContactEvents, AGlancingImpactLosesToFrictionAsWell) {
    SimulationDefinition d = free_of_weight(ball());
    d.walls = {plate(0.05)};
    Simulation s(std::move(d));
    s.add_bodies(std::vector<BodyPlacement>{{0, {Vec3(0.0, 0.0, 1.01 * radius), Quat::Identity()}, Vec3(0.5, 0, -0.3), Vec3::Zero()}});
    const double before = s.energy().kinetic_translation;
    s.record_contact_events();
    s.advance(3000);
    const ContactEvents wall = s.contact_events()[1];
    const double normal = sum(spectrum(wall, EventEnergy::normal).energy), total = sum(spectrum(wall, EventEnergy::total).energy);
    EXPECT_GT(total, 1.2 * normal);
    // A tangential spring whose stiffness falls as the spheres part loses energy to no friction: the book has it as `fed`, here below zero.
    EXPECT_LT(s.energy().fed, 0.0);
    EXPECT_NEAR(total - s.energy().fed, before - s.energy().kinetic_translation - s.energy().kinetic_rotation, 2e-3 * before);
    const double impact = 0.5 * ball().mass_properties.mass * 0.3 * 0.3;
    EXPECT_NEAR(sum(spectrum(wall, EventEnergy::impact).energy), impact, 0.01 * impact) << "the normal approach alone";
}

/// A box of agitated dumbbells.
Simulation agitated(std::size_t count) {
    SimulationDefinition d = free_of_weight(dumbbell());
    d.gravity = {0.0, 0.0, -9.81};
    d.time_step = 5e-6;
    WallDefinition box = plate(0.012);
    const double h = 0.012, top = 0.03;
    box.mesh.vertices.insert(box.mesh.vertices.end(), {{-h, -h, top}, {h, -h, top}, {h, h, top}, {-h, h, top}});
    for (std::uint32_t k = 0; k < 4; ++k) box.mesh.faces.push_back({k, (k + 1) % 4, 4 + k}), box.mesh.faces.push_back({(k + 1) % 4, 4 + (k + 1) % 4, 4 + k});
    box.mesh.faces.push_back({4, 5, 6}), box.mesh.faces.push_back({4, 6, 7});
    d.walls = {box};
    Simulation s(std::move(d));
    std::vector<BodyPlacement> bodies;
    for (std::size_t i = 0; i < count; ++i) {
        RandomStream random(7, i);
        const auto column = static_cast<double>(i % 3) - 1.0, row = static_cast<double>((i / 3) % 3) - 1.0, layer = static_cast<double>(i / 9);
        bodies.push_back({0,
                          {Vec3(6.5e-3 * column, 6.5e-3 * row, 4e-3 + 6.5e-3 * layer), random.rotation()},
                          0.5 * Vec3(random.normal(), random.normal(), random.normal()),
                          Vec3::Zero()});
    }
    s.add_bodies(bodies);
    return s;
}

TEST(ContactEvents, AllKindsTogetherDissipateWhatTheEnergyBookSays) {
    Simulation s = agitated(27);
    s.advance(4000);  // contacts that go on when the recording begins
    const double before = s.energy().dissipated();
    s.record_contact_events();
    s.advance(8000);
    double recorded = 0.0, complete = 0.0, events = 0.0;
    for (const ContactEvents& kind : s.contact_events()) recorded += kind.dissipated, complete += kind.dissipated_complete, events += kind.complete;
    EXPECT_GT(events, 50.0);
    EXPECT_NEAR(recorded, s.energy().dissipated() - before, 1e-9 * recorded);
    EXPECT_LE(complete, recorded);
    EXPECT_GT(complete, 0.3 * recorded);
}

TEST(ContactEvents, RecordingChangesNoBitAndGoesOnFromACheckpoint) {
    Simulation plain = agitated(27), recorded = agitated(27);
    recorded.record_contact_events();
    plain.advance(3000), recorded.advance(3000);
    EXPECT_EQ(plain.state_hash(), recorded.state_hash());
    const std::string checkpoint = recorded.checkpoint();
    set_thread_count(1);
    recorded.advance(3000);
    set_thread_count(2);
    Simulation restored(recorded.definition());
    restored.restore(checkpoint, "test");
    restored.advance(3000);
    set_thread_count(0);
    EXPECT_EQ(restored.state_hash(), recorded.state_hash());
    const std::vector<ContactEvents> a = recorded.contact_events(), b = restored.contact_events();
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t k = 0; k < a.size(); ++k) {
        EXPECT_GT(a[k].complete, 10.0);
        EXPECT_EQ(a[k].complete, b[k].complete);
        EXPECT_EQ(a[k].dissipated, b[k].dissipated);
        for (std::size_t e = 0; e < event_energies; ++e) {
            EXPECT_EQ(a[k].spectra[e].count, b[k].spectra[e].count);
            EXPECT_EQ(a[k].spectra[e].energy, b[k].spectra[e].energy);
        }
    }
}

TEST(ContactEvents, NeedTheEnergyBook) {
    SimulationDefinition d = free_of_weight(ball());
    d.physics.energy_book = false;
    Simulation s(std::move(d));
    EXPECT_TRUE(s.contact_events().empty());
    EXPECT_THROW(s.record_contact_events(), Error);
}

}  // namespace
}  // namespace pelletlab::solver
