#include "experiments/effects/effects.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "core/error.hpp"
#include "core/units.hpp"
#include "experiments/effects/complete_plan.hpp"
#include "experiments/rotating_drum.hpp"
#include "packing/fill_tube.hpp"
#include "tests/unit/packing/small_case.hpp"

namespace pelletlab::experiments {
namespace {

using small_case::drum_case;
using small_case::dumbbell_inputs;
using small_case::tube_case;

Case pile_case() {
    Case c = tube_case(30);
    c.rig = Rig::pile;
    return c;
}

Case case_on(Rig rig) {
    return rig == Rig::drum ? drum_case(30) : rig == Rig::pile ? pile_case() : tube_case(30);
}

double middle_amplitude(const Effect& e) {
    return e.levels.empty() ? 0.5 * e.full : e.levels.front();
}

std::uint64_t drum_hash(Case c) {
    c.time.settle_limit = 0.03;
    c.time.spin_up = 0.02;
    c.time.measure = 0.03;
    return run_drum(c, dumbbell_inputs(), {}, {}).state_hash;
}

Observables drum_readings() {
    Observables o;
    for (const auto& [name, value] : std::vector<std::pair<std::string, double>>{
             {"bed_height", 50.0}, {"upper_angle_of_repose", 40.0}, {"surface_velocity", 0.2}, {"front_surface_velocity", 0.1}})
        o.values.push_back({name, "1", value, 0.1, {}, "x"});
    Profile surface{"free_surface", "mm", "x", "mm", {-20.0, -10.0, 0.0, 10.0, 20.0}, {30.0, 15.0, 0.0, -12.0, -20.0}, {}, {}, "x"};
    Profile depth{"depth_velocity", "m/s", "depth", "mm", {1.0, 3.0, 5.0, 7.0}, {0.3, 0.1, 0.0, -0.1}, {}, {}, "x"};
    o.profiles = {surface, depth};
    return o;
}

double value_of(const Observables& o, const std::string& name) {
    for (const auto& v : o.values)
        if (v.name == name) return v.value;
    return not_known;
}

TEST(Effects, TheLibraryIsComplete) {
    std::set<std::string> names, ids;
    for (const Effect& e : effect_library()) {
        EXPECT_TRUE(names.insert(e.name).second) << e.name;
        EXPECT_TRUE(ids.insert(e.id).second) << e.id;
        for (const std::string* text : {&e.title, &e.equation, &e.source, &e.test}) EXPECT_GT(text->size(), 3u) << e.name;
        EXPECT_NE(static_cast<bool>(e.on_case), static_cast<bool>(e.on_observables)) << e.name;
        EXPECT_GT(e.full, 0.0) << e.name;
        EXPECT_EQ(e.is_measurement(), e.effect_class == "measurement") << e.name;
        EXPECT_NO_THROW(unit_dimension(e.unit)) << e.name;
        for (const double level : e.levels) EXPECT_LE(level, e.full) << e.name;
    }
    // The design's core library, and more than eight beyond it.
    for (const char* id : {"B1", "B2", "C1", "C2", "C3", "E1", "P1", "P2", "O1", "O2", "M1", "M2"}) EXPECT_TRUE(ids.contains(id)) << id;
    EXPECT_GE(ids.size(), 20u);
}

TEST(Effects, ZeroLeavesEveryCaseAsItIsAndEveryOtherAmplitudeDoesNot) {
    for (const Effect& e : effect_library()) {
        if (e.is_measurement()) continue;
        for (const Rig rig : {Rig::drum, Rig::tube, Rig::pile}) {
            const Case c = case_on(rig);
            EXPECT_EQ(with_effect(e, c, 0.0), c) << e.name;
            const bool acts = e.rigs.empty() || std::find(e.rigs.begin(), e.rigs.end(), rig) != e.rigs.end();
            EXPECT_EQ(with_effect(e, c, middle_amplitude(e)) == c, !acts) << e.name << " on " << rig_name(rig);
        }
    }
}

TEST(Effects, BothSidesOfATwoSidedEffectDiffer) {
    for (const Effect& e : effect_library()) {
        if (!e.two_sided || e.is_measurement()) continue;
        const Case c = case_on(e.rigs.empty() ? Rig::drum : e.rigs.front());
        const Case up = with_effect(e, c, e.full), down = with_effect(e, c, -e.full);
        EXPECT_NE(up, down) << e.name;
        EXPECT_NE(down, c) << e.name;
    }
}

/// What an effect writes for a vanishing amplitude is the baseline's physics, not only its text: another row for the end plates, another law with nothing in
/// it, another density of nothing give the same bits.
TEST(Effects, AVanishingAmplitudeIsTheBaselinesPhysics) {
    const std::uint64_t baseline = drum_hash(drum_case(30));
    for (const char* name : {"end_plate_friction", "rolling_resistance", "kinetic_friction", "drum_length", "pellet_size", "pellet_mass", "drum_speed",
                             "dusty_drum", "stiffness"}) {
        Case c = drum_case(30);
        effect_named(name).on_case(c, 0.0);
        EXPECT_EQ(drum_hash(c), baseline) << name;
    }
    for (const char* name : {"end_plate_friction", "rolling_resistance", "kinetic_friction", "pellet_size", "pellet_mass", "drum_speed", "dusty_drum",
                             "charged_walls", "cohesion", "sticky_walls", "capillary_bridges", "shared_contacts", "standing_end_plates",
                             "velocity_dependent_restitution", "axis_tilt", "air_drag", "vibration", "weld_bead"}) {
        const Effect& e = effect_named(name);
        EXPECT_NE(drum_hash(with_effect(e, drum_case(30), e.levels.empty() ? e.full : e.levels.front())), baseline) << name << " changes nothing in the run";
    }
}

TEST(Effects, EndPlatesHaveTheirOwnFriction) {
    const Case c = with_effect(effect_named("end_plate_friction"), drum_case(30), -0.4);
    EXPECT_DOUBLE_EQ(c.contacts.at("pellet-front").sliding_friction, 0.6 * 0.5);
    EXPECT_DOUBLE_EQ(c.contacts.at("pellet-vessel").sliding_friction, 0.5);
    EXPECT_DOUBLE_EQ(c.contacts.at("pellet-back").restitution, 0.4);
}

TEST(Effects, ALargerPelletIsLargerInEveryWay) {
    Case c = tube_case(20);
    c.time.settle_limit = 0.01;
    const Effect& size = effect_named("pellet_size");
    std::vector<RigidTemplate> seen;
    for (const double a : {0.0, 0.05}) {
        packing::fill_tube(with_effect(size, c, a), dumbbell_inputs(),
                           [&](const TrajectoryHeader& h) {
                               seen.push_back(h.shapes.front().rigid);
                               return packing::FrameSink([](const Frame&) {});
                           },
                           {});
    }
    ASSERT_EQ(seen.size(), 2u);
    EXPECT_DOUBLE_EQ(seen[1].spheres[0].radius, 1.05 * seen[0].spheres[0].radius);
    EXPECT_DOUBLE_EQ(seen[1].spheres[0].centre.z(), 1.05 * seen[0].spheres[0].centre.z());
    EXPECT_NEAR(seen[1].mass_properties.mass / seen[0].mass_properties.mass, std::pow(1.05, 3), 1e-12);
    EXPECT_NEAR(seen[1].mass_properties.principal_inertia.x() / seen[0].mass_properties.principal_inertia.x(), std::pow(1.05, 5), 1e-12);
    EXPECT_DOUBLE_EQ(seen[1].mass_properties.density, seen[0].mass_properties.density);
}

/// A ball of 3.5 mm that meets a plate at 0.3 m/s rebounds with the case's restitution: against the series of Ramírez et al. 1999, e = 1 − C₁ x + C₂ x² …, at
/// weak damping.
TEST(Effects, ViscoelasticContactsKeepTheRestitutionAtTheReferenceSpeed) {
    Case c = drum_case(10);
    for (auto& [name, row] : c.contacts) row.restitution = 0.97;
    const Case changed = with_effect(effect_named("velocity_dependent_restitution"), c, 1.0);
    EXPECT_EQ(changed.physics.contact_model, "viscoelastic");
    const double r = 1.75e-3, mass = 1800.0 * 4.0 / 3.0 * M_PI * r * r * r, e_star = 1.0 / (2.0 * (1.0 - 0.25) / (2.0 * 2e6));
    const double rho = 4.0 / 3.0 * e_star * std::sqrt(r),
                 x = 1.5 * changed.contacts.at("pellet-vessel").relaxation_time * std::pow(rho / mass, 0.4) * std::pow(0.3, 0.2);
    const double series = 1.0 - 1.15344 * x + 0.6 * 1.15344 * 1.15344 * x * x;
    EXPECT_NEAR(series, 0.97, 2.0 * x * x * x);  // the next term of the series is of order x³, and so is what the missing pull at the end adds
    EXPECT_LT(x, 0.05);
    EXPECT_THROW(with_effect(effect_named("velocity_dependent_restitution"), changed, 1.0), Error);
}

TEST(Effects, TiltTurnsGravityAndKeepsItsSize) {
    const Case c = with_effect(effect_named("axis_tilt"), drum_case(10), 2.0);
    EXPECT_NEAR(c.gravity.norm(), 9.81, 1e-12);
    EXPECT_NEAR(std::abs(c.gravity.y()), 9.81 * std::sin(2.0 * M_PI / 180.0), 1e-12);
    EXPECT_EQ(c.gravity.x(), 0.0);
}

TEST(Effects, OneLawOfCohesionOnly) {
    const Case wet = with_effect(effect_named("capillary_bridges"), drum_case(10), 0.05);
    EXPECT_EQ(wet.physics.liquid_surface_tension, 0.05);
    EXPECT_THROW(with_effect(effect_named("charged_walls"), wet, 0.1), Error);
    const Case charged = with_effect(effect_named("charged_walls"), drum_case(10), 0.1);
    EXPECT_DOUBLE_EQ(charged.contacts.at("pellet-vessel").attraction_force, 1e-4);
    EXPECT_EQ(charged.contacts.at("pellet-pellet").attraction_force, 0.0);
}

TEST(Effects, InstrumentsWithZeroAmplitudeChangeNoBit) {
    const Observables before = drum_readings();
    for (const Effect& e : effect_library()) {
        if (!e.is_measurement()) continue;
        for (const double a : {0.0, e.full}) {
            const Observables after = with_effect(e, before, a);
            bool same = true;
            for (std::size_t i = 0; i < before.values.size(); ++i) same = same && after.values[i].value == before.values[i].value;
            for (std::size_t i = 0; i < before.profiles.size(); ++i) same = same && after.profiles[i].value == before.profiles[i].value;
            EXPECT_EQ(same, a == 0.0) << e.name << " " << a;
        }
        EXPECT_THROW(with_effect(e, drum_case(10), 0.1), Error);
        // What an instrument at another rig reads is none of its business.
        Observables tube;
        tube.values.push_back({"bed_height_mass", "mm", 24.0, 0.1, {}, "x"});
        EXPECT_EQ(with_effect(e, tube, e.full).values[0].value, 24.0) << e.name;
    }
}

TEST(Effects, InstrumentsDoWhatTheirFormulaSays) {
    const Observables o = drum_readings();
    EXPECT_DOUBLE_EQ(value_of(with_effect(effect_named("camera_layer"), o, 0.25), "surface_velocity"), 0.75 * 0.2 + 0.25 * 0.1);
    EXPECT_DOUBLE_EQ(value_of(with_effect(effect_named("frame_rate"), o, -0.1), "surface_velocity"), 0.18);
    EXPECT_DOUBLE_EQ(value_of(with_effect(effect_named("surface_threshold"), o, 1.5), "bed_height"), 51.5);
    const Observables rolled = with_effect(effect_named("camera_roll"), o, 1.0);
    EXPECT_DOUBLE_EQ(value_of(rolled, "upper_angle_of_repose"), 41.0);
    EXPECT_NEAR(rolled.profiles[0].value[0], 30.0 + 20.0 * std::tan(M_PI / 180.0), 1e-12);  // the uphill side, x < 0, rises
    EXPECT_NEAR(value_of(rolled, "bed_height"), 50.0 + 20.0 * std::tan(M_PI / 180.0), 1e-12);
    // A straight surface through the axis keeps its slope whatever the scale; a level one moves.
    const Observables scaled = with_effect(effect_named("camera_scale"), o, 0.05);
    EXPECT_DOUBLE_EQ(value_of(scaled, "bed_height"), 52.5);
    EXPECT_NEAR(scaled.profiles[0].value[1], 15.0, 1e-12);
    // A window as wide as a bin leaves the bin; one of three bins takes the mean of three, cut at the surface to two.
    EXPECT_EQ(with_effect(effect_named("window_average"), o, 2.0).profiles[1].value, o.profiles[1].value);
    const Observables wide = with_effect(effect_named("window_average"), o, 6.0);
    EXPECT_NEAR(wide.profiles[1].value[1], (0.3 + 0.1 + 0.0) / 3.0, 1e-12);
    EXPECT_NEAR(wide.profiles[1].value[0], 0.2, 1e-12);
    EXPECT_NEAR(value_of(wide, "surface_velocity"), 0.2 + 0.5 * (0.2 + 0.4 / 3.0) - 0.2, 1e-12);
}

TEST(Effects, AmplitudesAreReadWithTheirUnit) {
    EXPECT_DOUBLE_EQ(parse_effect("axis_tilt=1.5 deg").second, 1.5);
    EXPECT_NEAR(parse_effect("axis_tilt=0.01 rad").second, 0.01 * 180.0 / M_PI, 1e-12);
    EXPECT_DOUBLE_EQ(parse_effect("drum_speed=-0.1").second, -0.1);
    EXPECT_DOUBLE_EQ(parse_effect("charged_walls=0.1").second, 0.1);
    for (const char* wrong : {"axis_tilt", "axis_tilt=2 mm", "drum_speed=3 rpm", "drum_sped=0.1", "drum_speed=much", "standing_end_plates=nan"})
        EXPECT_THROW(([&] {
                         const auto [e, a] = parse_effect(wrong);
                         with_effect(*e, drum_case(10), a);
                     })(),
                     Error)
            << wrong;
    EXPECT_THROW(with_effect(effect_named("standing_end_plates"), drum_case(10), 0.5), Error);
    EXPECT_THROW(with_effect(effect_named("edge_rounding"), drum_case(10), 0.15), Error);
}

TEST(Effects, APlanTakesFromTheLibraryWhatItDoesNotState) {
    CampaignPlan plan;
    plan.effects = {{"axis_tilt", "", "axis_tilt", "", 0.0, not_known, false, false, ""},
                    {"edge_rounding", "own title", "edge_rounding", "", 0.0, 0.3, false, false, ""},
                    {"camera_roll", "", "camera_roll", "", 0.0, not_known, false, false, ""}};
    plan.effect_keys.resize(3);
    plan.effect_kinds.assign(3, PlannedEffectKind::library_case);
    plan.effect_levels.resize(3);
    plan.effect_places.resize(3);
    complete_effects(plan);
    EXPECT_EQ(plan.effects[0].unit, "deg");
    EXPECT_EQ(plan.effects[0].full, 2.0);
    EXPECT_EQ(plan.effects[0].effect_class, "boundary");
    EXPECT_EQ(plan.effects[1].title, "own title");
    EXPECT_EQ(plan.effect_levels[1], (std::vector<double>{0.1, 0.2, 0.3}));
    EXPECT_EQ(plan.effect_kinds[2], PlannedEffectKind::library_data);
    EXPECT_TRUE(plan.effects[2].two_sided);
    plan.effects[1].full = 0.05;
    plan.effect_levels[1].clear();
    EXPECT_THROW(complete_effects(plan), Error);
    plan.effects[1] = {"edge_roundin", "", "", "", 0.0, 1.0, false, false, ""};
    EXPECT_THROW(complete_effects(plan), Error);
}

}  // namespace
}  // namespace pelletlab::experiments
