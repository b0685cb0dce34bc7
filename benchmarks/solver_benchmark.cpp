// Speed of the solver on settled tubes and rotating drums: pellet-steps a second, nanoseconds a stage, one thread and more.
//   solver_benchmark tube  --pellets 2000 --spheres 82 --state tube.checkpoint --steps 1000 --repeats 5 --threads 1,2
//   solver_benchmark drum  --pellets 22000 --spheres 82 --rpm 35 …
//   solver_benchmark box   --pellets 100000 --spheres 1 …
// The state is prepared once (rain, settling, rotation) and kept in the checkpoint file; later calls start from it. With --bodies FILE it starts from the
// bodies of another program instead: a line each, place, turn w x y z, velocity, spin.
// With --run SECONDS --state FILE it goes on from there for that much simulated time instead of timing repeats: the state is saved every half minute, the
// same command goes on after an interruption, and every hundredth of a second a line of CSV is printed (time, wall time, speed, energies, torque).
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "core/random.hpp"
#include "solver/simulation.hpp"
#include "solver/time_step.hpp"

using namespace pelletlab;

namespace {

constexpr double pellet_radius = 1.56e-3, pellet_height = 2.96e-3, big = 0.765e-3, small = 0.35e-3;

/// The study's pellet as rings of spheres, as benchmarks/peers/liggghts.py has it; mass of the true cylinder.
RigidTemplate pellet_template(int spheres) {
    RigidTemplate t;
    t.name = "pellet" + std::to_string(spheres);
    const auto ring = [&](int n, double z, double radius, double phase) {
        for (int i = 0; i < n; ++i) {
            const double a = 2.0 * M_PI * (i + phase) / n;
            t.spheres.push_back({{(pellet_radius - radius) * std::cos(a), (pellet_radius - radius) * std::sin(a), z}, radius});
        }
    };
    const auto rings = [&](int count, int n, double radius, double phase) {
        const double top = 0.5 * pellet_height - radius;
        for (int k = 0; k < count; ++k) ring(n, -top + 2.0 * top * k / (count - 1), radius, phase);
    };
    if (spheres == 1) t.spheres = {{Vec3::Zero(), std::cbrt(0.75 * pellet_radius * pellet_radius * pellet_height)}};
    if (spheres == 10) rings(2, 5, big, 0.0);
    if (spheres == 12) rings(2, 6, big, 0.0);
    if (spheres == 24 || spheres == 42) rings(3, 8, big, 0.0);
    if (spheres == 42) rings(2, 9, small, 0.5);
    if (spheres == 82) rings(3, 16, big, 0.0), rings(2, 17, small, 0.5);
    if (spheres == 200) rings(5, 24, big, 0.0), rings(2, 40, small, 0.5);
    if (t.spheres.empty()) throw usage_error("--spheres is 1, 10, 12, 24, 42, 82 or 200");
    MassProperties& m = t.mass_properties;
    m.volume = M_PI * pellet_radius * pellet_radius * pellet_height;
    m.density = 1800.0;
    m.mass = m.volume * m.density;
    const double across = m.mass * (3.0 * pellet_radius * pellet_radius + pellet_height * pellet_height) / 12.0;
    m.principal_inertia = {across, across, 0.5 * m.mass * pellet_radius * pellet_radius};
    if (spheres == 1) m.principal_inertia = Vec3::Constant(0.4 * m.mass * t.spheres[0].radius * t.spheres[0].radius);
    t.bounding_radius = bounding_radius(t.spheres);
    return t;
}

/// Prism shell of n facets about an axis (2: z, 1: y) between two planes, with end plates where asked for.
TriangleMesh shell(double radius, double low, double high, int n, int axis, bool low_plate, bool high_plate) {
    TriangleMesh mesh;
    const int u = axis == 2 ? 0 : 2, v = axis == 2 ? 1 : 0;
    for (int k = 0; k < n; ++k)
        for (const double h : {low, high}) {
            Vec3 p;
            p[u] = radius * std::cos(2.0 * M_PI * k / n), p[v] = radius * std::sin(2.0 * M_PI * k / n), p[axis] = h;
            mesh.vertices.push_back(p);
        }
    const auto centre = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const double h : {low, high}) mesh.vertices.push_back(Vec3::Unit(axis) * h);
    for (int k = 0; k < n; ++k) {
        const auto a = static_cast<std::uint32_t>(2 * k), b = static_cast<std::uint32_t>(2 * ((k + 1) % n));
        mesh.faces.push_back({a, b, b + 1});
        mesh.faces.push_back({a, b + 1, a + 1});
        if (low_plate) mesh.faces.push_back({b, a, centre});
        if (high_plate) mesh.faces.push_back({a + 1, b + 1, centre + 1});
    }
    return mesh;
}

/// An open box about the z axis, from its floor at 0.
TriangleMesh open_box(double half, double height) {
    TriangleMesh mesh;
    for (const double z : {0.0, height})
        for (const double y : {-half, half})
            for (const double x : {-half, half}) mesh.vertices.push_back({x, y, z});
    mesh.faces = {{0, 1, 3}, {0, 3, 2}, {0, 1, 5}, {0, 5, 4}, {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 3, 7}, {1, 7, 5}};
    return mesh;
}

struct Options {
    std::string rig = "tube", state, bodies;
    int pellets = 2000, spheres = 82, steps = 1000, repeats = 5;
    double rpm = 35.0, settle = 0.5, spin_up = 1.0, step = 1e-5, height = 0.0, run = 0.0;
    std::vector<int> threads{1, 2};
    solver::SearchSkins skins;
};

Options read_options(int argc, char** argv) {
    Options o;
    if (argc < 2)
        throw usage_error(
            "usage: solver_benchmark tube|drum|box [--pellets N] [--spheres N] [--state FILE] [--steps N] [--repeats N] [--threads 1,2] [--settle s] …");
    o.rig = argv[1];
    for (int k = 2; k + 1 < argc; k += 2) {
        const std::string key = argv[k], value = argv[k + 1];
        if (key == "--pellets")
            o.pellets = std::stoi(value);
        else if (key == "--spheres")
            o.spheres = std::stoi(value);
        else if (key == "--steps")
            o.steps = std::stoi(value);
        else if (key == "--repeats")
            o.repeats = std::stoi(value);
        else if (key == "--rpm")
            o.rpm = std::stod(value);
        else if (key == "--settle")
            o.settle = std::stod(value);
        else if (key == "--spin-up")
            o.spin_up = std::stod(value);
        else if (key == "--run")
            o.run = std::stod(value);
        else if (key == "--height")
            o.height = std::stod(value);
        else if (key == "--time-step")
            o.step = std::stod(value);
        else if (key == "--skin-bodies")
            o.skins.bodies = std::stod(value);
        else if (key == "--skin-spheres")
            o.skins.spheres = std::stod(value);
        else if (key == "--skin-wall-faces")
            o.skins.wall_faces = std::stod(value);
        else if (key == "--skin-wall-candidates")
            o.skins.wall_candidates = std::stod(value);
        else if (key == "--state")
            o.state = value;
        else if (key == "--bodies")
            o.bodies = value;
        else if (key == "--threads") {
            o.threads.clear();
            std::stringstream list(value);
            for (std::string item; std::getline(list, item, ',');) o.threads.push_back(std::stoi(item));
        } else
            throw usage_error("unknown option " + key);
    }
    return o;
}

struct Bench {
    solver::SimulationDefinition definition;
    std::vector<solver::BodyPlacement> bodies;
    solver::WallMotion motion;
};

solver::WallDefinition vessel(TriangleMesh mesh) {
    solver::WallDefinition wall;
    wall.name = "vessel";
    wall.mesh = std::move(mesh);
    wall.material = {3e9, 0.25};
    wall.contact = {0.4, 0.7, 0.05};
    return wall;
}

std::vector<solver::BodyPlacement> read_bodies(const std::string& file) {
    std::vector<solver::BodyPlacement> bodies;
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);) {
        std::istringstream numbers(line);
        double v[13];
        for (double& x : v)
            if (!(numbers >> x))
                throw bad_input("line " + std::to_string(bodies.size() + 1) + " has fewer than 13 numbers", "see solver_benchmark.cpp", {file});
        solver::BodyPlacement p;
        p.pose = {{v[0], v[1], v[2]}, Quat(v[3], v[4], v[5], v[6]).normalized()};
        p.velocity = {v[7], v[8], v[9]};
        p.spin = {v[10], v[11], v[12]};
        bodies.push_back(p);
    }
    if (bodies.empty()) throw bad_input("there are no bodies", "give a file that scripts/bench-peers made", {file});
    return bodies;
}

/// Pellets on a lattice with random orientations, filling a cylinder (axis 2: upright tube, axis 1: lying drum) from below.
Bench make_bench(const Options& o) {
    Bench b;
    b.definition.templates = {pellet_template(o.spheres)};
    b.definition.pellet_contact = {0.4, 0.7, 0.05};
    b.definition.time_step = o.step;
    b.definition.skins = o.skins;
    const double reach = b.definition.templates[0].bounding_radius, spacing = 2.02 * reach;
    const auto put = [&](double x, double y, double z) {
        RandomStream random(7, b.bodies.size());
        solver::BodyPlacement p;
        p.pose = {{x, y, z}, random.rotation()};
        p.velocity = Vec3(random.normal(), random.normal(), random.normal()) * 0.05 - Vec3(0, 0, 0.3);
        b.bodies.push_back(p);
    };
    const auto n = static_cast<std::size_t>(o.pellets);
    if (o.rig == "tube") {
        const double radius = 0.026, room = radius * std::cos(M_PI / 96.0) - reach;
        for (int k = 0; b.bodies.size() < n; ++k)
            for (int j = -8; j <= 8; ++j)
                for (int i = -8; i <= 8; ++i)
                    if (std::hypot(i, j) * spacing < room && b.bodies.size() < n) put(i * spacing, j * spacing, (k + 0.6) * spacing);
        b.definition.walls = {vessel(shell(radius, 0.0, o.height > 0.0 ? o.height : b.bodies.back().pose.position.z() + 0.02, 96, 2, true, false))};
    } else if (o.rig == "drum") {
        const double volume = o.pellets * b.definition.templates[0].mass_properties.volume / 0.6 / 0.2;
        const double diameter = std::cbrt(volume / (0.25 * M_PI * 0.375)), length = 0.375 * diameter, room = 0.5 * diameter * std::cos(M_PI / 120.0) - reach;
        const int layers = static_cast<int>((length - 2.0 * reach) / spacing);
        for (int k = 0; b.bodies.size() < n; ++k) {
            const double z = -room + k * spacing;
            if (z > room) throw bad_input("the drum cannot hold so many pellets before they settle", "fewer pellets");
            const double half = std::sqrt(std::max(0.0, room * room - z * z));
            for (int j = 0; j <= layers; ++j)
                for (int i = static_cast<int>(-half / spacing); i <= static_cast<int>(half / spacing); ++i)
                    if (b.bodies.size() < n) put(i * spacing, (j - 0.5 * layers) * spacing, z);
        }
        b.definition.walls = {vessel(shell(0.5 * diameter, -0.5 * length, 0.5 * length, 120, 1, true, true))};
        b.motion.rotation_speed = o.rpm * 2.0 * M_PI / 60.0;
    } else if (o.rig == "box") {
        const double half = 0.12 * std::sqrt(o.pellets / 1e5);
        const int across = static_cast<int>(2.0 * (half - reach) / spacing);
        for (int k = 0; b.bodies.size() < n; ++k)
            for (int j = 0; j <= across; ++j)
                for (int i = 0; i <= across; ++i)
                    if (b.bodies.size() < n) put((i - 0.5 * across) * spacing, (j - 0.5 * across) * spacing, (k + 0.6) * spacing);
        b.definition.walls = {vessel(open_box(half, b.bodies.back().pose.position.z() + 0.02))};
    } else {
        throw usage_error("the rig is tube, drum or box");
    }
    if (!o.bodies.empty()) b.bodies = read_bodies(o.bodies);
    return b;
}

void prepare(solver::Simulation& s, const Bench& b, const Options& o) {
    if (!o.state.empty() && std::filesystem::exists(o.state)) {
        s.load_checkpoint(o.state);
        return;
    }
    if (!o.bodies.empty()) {
        s.add_bodies(b.bodies, 1.0);
        if (o.rig == "drum") s.set_wall_motion(0, b.motion);
        s.advance(static_cast<std::uint64_t>(o.settle / o.step));  // contacts get their history back
        if (!o.state.empty()) s.save_checkpoint(o.state);
        return;
    }
    s.add_bodies(b.bodies);
    const auto run = [&](double seconds, const char* what) {
        const auto total = static_cast<std::uint64_t>(seconds / o.step), part = std::max<std::uint64_t>(1, total / 10);
        for (std::uint64_t done = 0; done < total; done += part) {
            s.advance(part);
            const auto e = s.energy();
            std::fprintf(stderr, "%s %.3f s: kinetic energy a pellet %.3e J\n", what, s.time(), (e.kinetic_translation + e.kinetic_rotation) / o.pellets);
        }
    };
    run(o.settle, "settling");
    if (o.rig == "drum") {
        s.set_wall_motion(0, b.motion);
        run(o.spin_up, "rotating");
    }
    if (!o.state.empty()) s.save_checkpoint(o.state);
}

/// CPU time of the process [s]: on a shared machine the fairer clock for one thread.
double cpu_seconds() {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double memory_megabytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

/// The long run of --run. Its end is a step count beside the state, so that an interrupted run knows how far it has to go.
int long_run(solver::Simulation& s, const Options& o) {
    if (o.state.empty()) throw usage_error("--run needs --state, where the run is kept");
    const std::filesystem::path goal_file = o.state + ".goal";
    std::uint64_t goal = s.step_count() + static_cast<std::uint64_t>(std::llround(o.run / o.step));
    if (std::filesystem::exists(goal_file))
        std::ifstream(goal_file) >> goal;
    else
        std::ofstream(goal_file) << goal;
    set_thread_count(o.threads.back());
    using Clock = std::chrono::steady_clock;
    const auto start = Clock::now();
    auto saved = start;
    const std::uint64_t first = s.step_count(), chunk = static_cast<std::uint64_t>(std::llround(0.01 / o.step));
    std::printf("time_s,wall_s,pellet_steps_per_s,kinetic_J,potential_J,drum_torque_Nm,sphere_contacts,largest_overlap_ratio,memory_MB\n");
    while (s.step_count() < goal) {
        s.advance(std::min(chunk, goal - s.step_count()));
        const auto now = Clock::now();
        const double wall = std::chrono::duration<double>(now - start).count();
        const auto e = s.energy();
        const auto c = s.contacts();
        std::printf("%.5f,%.1f,%.4e,%.6e,%.6e,%.6e,%zu,%.4f,%.1f\n", s.time(), wall, o.pellets * static_cast<double>(s.step_count() - first) / wall,
                    e.kinetic_translation + e.kinetic_rotation, e.gravity, -s.wall_loads()[0].torque.y(), c.sphere_contacts, c.largest_overlap_ratio,
                    memory_megabytes());
        std::fflush(stdout);
        if (now - saved > std::chrono::seconds(30) || s.step_count() == goal) s.save_checkpoint(o.state), saved = Clock::now();
    }
    return 0;
}

int run(int argc, char** argv) {
    const Options o = read_options(argc, argv);
    const Bench b = make_bench(o);
    if (b.bodies.size() != static_cast<std::size_t>(o.pellets)) throw usage_error("--pellets is not the number of bodies in the file");
    const auto advice = solver::advise_time_step(b.definition);
    solver::Simulation s(b.definition);
    prepare(s, b, o);
    if (o.run > 0.0) return long_run(s, o);
    const auto contacts = s.contacts();
    const double n = o.pellets;
    std::printf("%s, %d pellets of %d spheres, time step %.3g s (%.0f %% of Rayleigh, %.0f %% of the contact limit)\n", o.rig.c_str(), o.pellets, o.spheres,
                o.step, advice.percent_of_rayleigh(o.step), advice.percent_of_limit(o.step));
    std::printf("per pellet: %.2f touching pairs, %.2f sphere contacts, %.2f wall contacts; largest overlap / radius %.3f\n",
                static_cast<double>(contacts.touching_pairs) / n, static_cast<double>(contacts.sphere_contacts) / n,
                static_cast<double>(contacts.wall_contacts) / n, contacts.largest_overlap_ratio);
    const auto search = s.search_report();
    std::printf("per pellet: %.2f listed pairs, %.2f with candidates, %.2f candidates; %.2f near walls, %.2f wall candidates; %.0f bytes\n",
                static_cast<double>(search.listed_pairs) / n, static_cast<double>(search.pairs_with_candidates) / n, static_cast<double>(search.candidates) / n,
                static_cast<double>(search.bodies_near_walls) / n, static_cast<double>(search.wall_candidates) / n, static_cast<double>(search.bytes) / n);
    double speed = 0.0;
    for (const Vec3& v : s.bodies().velocity) speed += v.norm() / n;
    std::printf("mean speed %.4f m/s, peak memory %.1f MB\n", speed, memory_megabytes());
    const std::filesystem::path start =
        std::filesystem::temp_directory_path() / ("solver_benchmark_" + std::to_string(std::hash<std::string>{}(o.rig + o.state)) + ".checkpoint");
    s.save_checkpoint(start);
    std::map<int, double> best, best_cpu;
    std::map<int, std::uint64_t> hash;
    for (int repeat = 0; repeat < o.repeats; ++repeat)
        for (const int threads : o.threads) {
            set_thread_count(threads);
            s.load_checkpoint(start);
            s.advance(20);
            const auto before = s.stage_times();
            const std::uint64_t rebuilds = s.neighbour_rebuilds();
            const auto begin = std::chrono::steady_clock::now();
            const double cpu_begin = cpu_seconds();
            s.advance(static_cast<std::uint64_t>(o.steps));
            const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
            const auto after = s.stage_times();
            const double rate = n * o.steps / seconds;
            const double cpu_rate = n * o.steps / (cpu_seconds() - cpu_begin);
            best[threads] = std::max(best[threads], rate);
            best_cpu[threads] = std::max(best_cpu[threads], cpu_rate);
            hash[threads] = s.state_hash();
            std::printf("threads %d: %.3e pellet-steps/s (%.3e a CPU second);", threads, rate, cpu_rate);
            for (std::size_t k = 0; k < after.size(); ++k)
                std::printf(" %s %.0f", after[k].name.c_str(), (after[k].seconds - before[k].seconds) / (n * o.steps) * 1e9);
            std::printf(" ns; rebuilds %llu\n", static_cast<unsigned long long>(s.neighbour_rebuilds() - rebuilds));
            std::fflush(stdout);
        }
    for (const auto& [threads, rate] : best)
        std::printf("best, threads %d: %.3e pellet-steps/s (%.3e a CPU second), hash %016llx\n", threads, rate, best_cpu[threads],
                    static_cast<unsigned long long>(hash[threads]));
    std::filesystem::remove(start);
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        return run(argc, argv);
    } catch (const Error& e) {
        std::fprintf(stderr, "solver_benchmark: %s\n", e.what());
        return e.exit_code();
    }
}
