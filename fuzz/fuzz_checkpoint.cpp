// Any bytes as the checkpoint of a run and of a simulation. A reader either throws an Error and changes nothing, or gives a state that steps and that saves
// itself with the same bits. Checksums are put right first, else no damage would ever get past them.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>

#include "core/error.hpp"
#include "packing/run_checkpoint.hpp"
#include "solver/simulation.hpp"

using namespace pelletlab;

namespace {

void require(bool condition) {
    if (!condition) std::abort();
}

solver::SimulationDefinition definition() {
    solver::SimulationDefinition d;
    RigidTemplate t;
    t.name = "dumbbell";
    t.spheres = {{{-5e-4, 0, 0}, 1e-3}, {{5e-4, 0, 0}, 1e-3}};
    t.mass_properties.mass = 1e-5;
    t.mass_properties.density = 1000.0;
    t.mass_properties.volume = 1e-8;
    t.mass_properties.principal_inertia = {4e-12, 6e-12, 6e-12};
    t.bounding_radius = 1.5e-3;
    d.templates = {t};
    solver::WallDefinition floor;
    floor.name = "floor";
    floor.mesh.vertices = {{-0.05, -0.05, 0}, {0.05, -0.05, 0}, {0.05, 0.05, 0}, {-0.05, 0.05, 0}};
    floor.mesh.faces = {{0, 1, 2}, {0, 2, 3}};
    d.walls = {floor};
    return d;
}

/// A few bodies in touch with each other and the floor.
std::string sound_checkpoint() {
    solver::Simulation s(definition());
    std::vector<solver::BodyPlacement> bodies(4);
    for (std::size_t k = 0; k < bodies.size(); ++k) {
        bodies[k].pose.position = {1e-3 * static_cast<double>(k % 2), 5e-4 * static_cast<double>(k), 1.01e-3 + 2.1e-3 * static_cast<double>(k)};
        bodies[k].velocity = {0.01, 0.0, -0.2};
        bodies[k].spin = {3.0, 20.0, 1.0};
    }
    s.add_bodies(bodies);
    s.advance(600);
    require(s.contacts().sphere_contacts > 0 && s.contacts().wall_contacts > 0);
    return s.checkpoint();
}

/// The state's own checksum, as solver/checkpoint.cpp and solver/detail/state.hpp define it.
void put_checksum_right(std::string& bytes) {
    constexpr std::size_t header = 40;
    if (bytes.size() < header) return;
    const std::uint64_t length = bytes.size() - header;
    std::uint64_t hash = 0xCBF29CE484222325ULL;
    const auto add = [&hash](std::uint64_t word) {
        hash = (hash ^ word) * 0x9E3779B97F4A7C15ULL;
        hash ^= hash >> 29;
    };
    add(length);
    std::size_t k = header;
    std::uint64_t word = 0;
    for (; k + 8 <= bytes.size(); k += 8) {
        std::memcpy(&word, bytes.data() + k, 8);
        add(word);
    }
    word = 0;
    std::memcpy(&word, bytes.data() + k, bytes.size() - k);
    add(word);
    std::memcpy(bytes.data() + 24, &length, 8);
    std::memcpy(bytes.data() + 32, &hash, 8);
}

void try_simulation(std::string bytes) {
    static const std::string sound = sound_checkpoint();
    // Edits of a sound checkpoint: (position, byte) pairs; the rest is a tail that replaces its end.
    std::string edited = sound;
    std::size_t at = 1;
    const std::size_t pairs = bytes.empty() ? 0 : static_cast<unsigned char>(bytes[0]) % 32;
    for (std::size_t k = 0; k < pairs && at + 3 <= bytes.size(); ++k, at += 3) {
        const std::size_t place = (static_cast<unsigned char>(bytes[at]) * 256u + static_cast<unsigned char>(bytes[at + 1])) % edited.size();
        edited[place] = bytes[at + 2];
    }
    if (at < bytes.size()) edited.replace(edited.size() - std::min(edited.size(), bytes.size() - at), std::string::npos, bytes.substr(at));
    put_checksum_right(edited);
    solver::Simulation s(definition());
    const std::uint64_t before = s.state_hash();
    try {
        s.restore(edited, "fuzz");
    } catch (const Error& error) {
        require(error.kind() == ErrorKind::bad_input && !error.problem().empty() && !error.remedy().empty());
        require(s.state_hash() == before);
        return;
    }
    const std::string again = s.checkpoint();
    solver::Simulation twin(definition());
    twin.restore(again, "twin");
    require(twin.state_hash() == s.state_hash());
    try {
        s.advance(20);
    } catch (const Error& error) {
        require(error.kind() == ErrorKind::numerical);  // wild velocities may carry a body out of the domain
        return;
    }
    twin.advance(20);
    require(twin.state_hash() == s.state_hash());
}

void try_run(std::string bytes) {
    static const std::string owner(64, 'a');
    if (!bytes.empty() && (bytes[0] & 1)) {  // with a right checksum
        std::string sum(8, '\0');
        std::uint64_t hash = 0xCBF29CE484222325ULL;
        bytes = "PLABRUN1" + bytes.substr(1);
        for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3ULL;
        std::memcpy(sum.data(), &hash, 8);
        bytes += sum;
    }
    try {
        const packing::RunCheckpoint c = packing::checkpoint_from(bytes, owner, "fuzz");
        require(packing::to_bytes(c, owner) == bytes);
    } catch (const Error& error) {
        require(error.kind() == ErrorKind::bad_input && !error.problem().empty() && !error.remedy().empty());
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string bytes(reinterpret_cast<const char*>(data), size);
    if (bytes.empty()) return 0;
    if (bytes[0] & 1) {
        try_simulation(bytes.substr(1));
    } else {
        try_run(bytes.substr(1));
    }
    return 0;
}
