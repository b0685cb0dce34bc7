// Everything a Simulation owns. The files of this room each work on a part of it.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "solver/detail/bodies.hpp"
#include "solver/detail/contact_recorder.hpp"
#include "solver/detail/kernels.hpp"
#include "solver/detail/pair_contacts.hpp"
#include "solver/detail/pair_list.hpp"
#include "solver/detail/wall_contacts.hpp"
#include "solver/simulation.hpp"

namespace pelletlab::solver {

struct Simulation::State {
    explicit State(SimulationDefinition given);

    SimulationDefinition definition;
    std::vector<detail::BodyTemplate> templates;
    std::vector<const detail::Ball*> balls;          ///< per template
    std::vector<detail::MotionConstants> constants;  ///< per template
    detail::LawRow pellet_law;
    detail::ContactKernel pellet_contact = nullptr;
    const detail::Kernels* kernels = nullptr;
    detail::WallSkins wall_skins;
    Box domain;

    std::uint64_t steps = 0;
    detail::Bodies bodies;
    LargeVector<detail::Kinematic> kinematics;
    detail::PairList pairs;
    std::vector<detail::Wall> walls;
    std::vector<WallLoad> wall_loads;
    std::vector<detail::LoadRow> body_loads;  ///< of body_forces; empty without
    std::vector<std::uint8_t> body_loads_act;
    double body_force_power = 0.0;  ///< [W]
    struct Book {
        std::array<double, 3> stored{};  ///< [J], normal, tangential, rolling
        std::array<double, 5> gone{};    ///< [J], the rest of BookColumn, summed over time
        std::vector<double> wall_work;   ///< [J]
        double body_force_work = 0.0;    ///< [J]
    };
    Book book;
    detail::ContactRecorder recorder;  ///< of contact events; reads, and decides nothing

    std::vector<detail::DriftResult> drift_results;  ///< scratch, one a block of bodies
    std::array<double, 6> stage_seconds{};           ///< see stage_names

    mutable BodyState view;  ///< filled when bodies() is asked for
    mutable bool view_is_current = false;

    double time() const { return static_cast<double>(steps) * definition.time_step; }

    // The stages of a step, in their order; step.cpp.
    /// Half kick, drift and predicted velocities; the squared distance that the furthest body has from its reference position.
    double kick_and_drift_bodies();
    void move_walls();
    void find_neighbours_if_needed(double furthest2);
    void compute_pair_forces(const detail::StepClock& clock);
    void compute_wall_forces(const detail::StepClock& clock);
    void gather_forces_and_kick(double kick);
    void sum_wall_loads();
    void compute_body_forces();
    void book_contacts();
    void book_work();
    void record_events();

    /// Forces and torques at the present instant, springs untouched: after bodies were added.
    void look_at_forces();
    void fit_to_body_count();
    /// Lays bodies and what walls keep of them along the curve of body_order.hpp; the pair list must be rebuilt afterwards.
    void order_bodies();
};

namespace detail {

// Bodies that one thread takes at a time; fixed, so sums do not depend on the number of threads. Small ones, so that nobody waits long for the last.
inline constexpr std::size_t body_grain = 64;
inline constexpr std::size_t wall_grain = 128;  ///< wall contacts of so many bodies are computed together
inline constexpr std::size_t sum_grain = 256;

inline constexpr std::array<const char*, 6> stage_names{"drift", "walls move", "neighbours", "pairs", "wall contacts", "gather and kick"};

/// Constants of the contact law between two materials; Throws Error(bad_input) for values out of range, naming `what`.
/// `largest_radius` [m] is that of the pellets' spheres.
LawRow make_law_row(const ElasticMaterial& a, const ElasticMaterial& b, const PairParameters& contact, const Physics& physics, double largest_radius,
                    const std::string& what);

/// Throws Error(bad_input) for options out of range or that exclude each other.
void check_physics(const Physics& physics);
void check_body_forces(const BodyForces& forces);

/// Hash of everything in a definition that decides the future.
std::uint64_t fingerprint(const SimulationDefinition& definition);

/// 64-bit hash that runs over words.
class Hash {
public:
    void add(std::uint64_t word) {
        value_ = (value_ ^ word) * 0x9E3779B97F4A7C15ULL;
        value_ ^= value_ >> 29;
    }
    void add(double number);
    void add(const Vec3& v) {
        for (int k = 0; k < 3; ++k) add(v[k]);
    }
    void add(const Quat& q) {
        for (int k = 0; k < 4; ++k) add(q.coeffs()[k]);
    }
    void add(const std::string& text) {
        add(static_cast<std::uint64_t>(text.size()));
        for (const char c : text) add(static_cast<std::uint64_t>(static_cast<unsigned char>(c)));
    }
    std::uint64_t value() const { return value_; }

private:
    std::uint64_t value_ = 0xCBF29CE484222325ULL;
};

}  // namespace detail

}  // namespace pelletlab::solver
