// Checkpoints: magic, version, fingerprint of the definition, payload length, checksum, payload. Only what decides the future is kept; neighbour
// lists are made anew, because results do not depend on them.
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string_view>
#include <system_error>

#include "core/error.hpp"
#include "solver/detail/checkpoint_bytes.hpp"
#include "solver/detail/motion.hpp"
#include "solver/detail/state.hpp"

namespace pelletlab::solver {

namespace {

using Writer = detail::CheckpointWriter;
using Reader = detail::CheckpointReader;

constexpr std::array<char, 8> magic{'P', 'L', 'A', 'B', 'C', 'K', 'P', 'T'};
constexpr std::uint32_t version = 5;

struct Header {
    std::array<char, 8> magic;
    std::uint32_t version, reserved;
    std::uint64_t fingerprint, payload_bytes, checksum;
};

std::uint64_t checksum_of(std::string_view bytes) {
    detail::Hash hash;
    hash.add(static_cast<std::uint64_t>(bytes.size()));
    std::size_t k = 0;
    for (; k + 8 <= bytes.size(); k += 8) {
        std::uint64_t word;
        std::memcpy(&word, bytes.data() + k, 8);
        hash.add(word);
    }
    std::uint64_t rest = 0;
    if (k < bytes.size()) std::memcpy(&rest, bytes.data() + k, bytes.size() - k);
    hash.add(rest);
    return hash.value();
}

struct SavedSpring {
    std::uint32_t i, j;
    std::uint32_t a, b;
    double spring[8];  ///< rows of the history, the second one zero where there is none
};

struct SavedHistory {
    std::uint32_t body, sphere, patch;
    Vec3 normal, spring, torque;
    double last_overlap;
};

/// Everything of a checkpoint, read and checked before the simulation is touched.
struct Saved {
    std::uint64_t steps = 0;
    detail::Bodies bodies;
    std::vector<SavedSpring> springs;
    struct SavedWall {
        WallMotion motion;
        std::uint64_t motion_start = 0;
        Pose start_pose;
        WallLoad load;
        double work = 0.0;
        std::vector<SavedHistory> history;
    };
    std::vector<SavedWall> walls;
    std::array<double, 9> book{};  ///< stored, gone, work of body forces
    detail::ContactRecorder recorder;
};

void put_motion_extras(Writer& w, const WallMotion& m) {
    w.put(m.oscillation), w.put(m.swing), w.put(m.frequency), w.put(m.phase);
    w.put(static_cast<std::uint64_t>(m.table.size()));
    for (const MotionRow& row : m.table) w.put(row.time), w.put(row.shift), w.put(row.angle);
}

void get_motion_extras(Reader& r, WallMotion& m) {
    m.oscillation = r.get_vec(), m.swing = r.get_number(), m.frequency = r.get_number(), m.phase = r.get_number();
    const std::size_t rows = r.get_count(5 * sizeof(double));
    for (std::size_t k = 0; k < rows; ++k) {
        MotionRow row;
        row.time = r.get_number(), row.shift = r.get_vec(), row.angle = r.get_number();
        m.table.push_back(row);
    }
}

std::string payload_of(const Simulation::State& s) {
    Writer w;
    w.put(s.steps);
    w.put(static_cast<std::uint64_t>(s.bodies.size()));
    for (std::size_t id = 0; id < s.bodies.size(); ++id) {
        w.put(s.bodies.template_of(s.bodies.place_of(id)));
        w.put(s.bodies.numbers(s.bodies.place_of(id)));
    }
    std::vector<SavedSpring> springs;
    detail::for_each_record(s.pairs, s.bodies, [&](const detail::PairRecord& r, const detail::PairBlock& block) {
        for (std::size_t c = r.first; c < r.first + std::size_t{r.count}; ++c)
            if (block.candidates[c].touching()) {
                SavedSpring saved{s.bodies.id(r.i), s.bodies.id(r.j), block.candidates[c].sphere_a(), block.candidates[c].b, {}};
                for (std::size_t row = 0; row < s.pairs.spring_rows; ++row)
                    std::copy_n(block.springs[c * s.pairs.spring_rows + row].row, 4, saved.spring + 4 * row);
                springs.push_back(saved);
            }
    });
    w.put(static_cast<std::uint64_t>(springs.size()));
    for (const SavedSpring& spring : springs) w.put(spring);
    w.put(s.book.stored), w.put(s.book.gone), w.put(s.book.body_force_work);
    w.put(static_cast<std::uint64_t>(s.walls.size()));
    for (std::size_t k = 0; k < s.walls.size(); ++k) {
        const detail::Wall& wall = s.walls[k];
        w.put(wall.motion.point), w.put(wall.motion.axis), w.put(wall.motion.rotation_speed), w.put(wall.motion.velocity);
        put_motion_extras(w, wall.motion);
        w.put(wall.motion_start);
        w.put(wall.start_pose.position), w.put(wall.start_pose.orientation);
        w.put(s.wall_loads[k].force), w.put(s.wall_loads[k].torque), w.put(s.wall_loads[k].power);
        w.put(s.book.wall_work[k]);
        std::uint64_t count = 0;
        for (const detail::WallWatch& watch : wall.watches) count += watch.near ? watch.near->history.size() : 0;
        w.put(count);
        for (std::uint32_t id = 0; id < wall.watches.size(); ++id) {
            const std::size_t i = s.bodies.place_of(id);
            if (!wall.watches[i].near) continue;
            for (const detail::WallHistory& h : wall.watches[i].near->history) {
                w.put(id), w.put(h.sphere), w.put(h.patch);
                w.put(h.normal), w.put(h.spring), w.put(h.torque), w.put(h.last_overlap);
            }
        }
    }
    detail::put_recorder(w, s.recorder);
    return std::move(w.bytes);
}

Saved read_payload(std::string_view bytes, const std::string& file, const Simulation::State& s) {
    Reader r(bytes, file);
    Saved saved;
    saved.steps = r.get<std::uint64_t>();
    using Numbers = std::array<double, detail::Bodies::number_count>;
    const std::size_t n = r.get_count(sizeof(std::uint32_t) + sizeof(Numbers));
    saved.bodies.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
        const auto t = r.get<std::uint32_t>();
        if (t >= s.templates.size()) r.broken();
        saved.bodies.set_template(i, t);
        const auto numbers = r.get<Numbers>();
        if (!std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); })) r.broken();
        saved.bodies.set_numbers(i, numbers);
    }
    const std::size_t spring_count = r.get_count(sizeof(SavedSpring));
    for (std::size_t k = 0; k < spring_count; ++k) {
        saved.springs.push_back(r.get<SavedSpring>());
        const SavedSpring& spring = saved.springs.back();
        if (spring.i >= spring.j || spring.j >= n) r.broken();
        for (const double x : spring.spring)
            if (!std::isfinite(x)) r.broken();
    }
    saved.book = r.get<std::array<double, 9>>();
    const auto wall_count = r.get<std::uint64_t>();
    if (wall_count != s.walls.size()) r.broken();
    for (const detail::Wall& wall : s.walls) {
        Saved::SavedWall w;
        w.motion.point = r.get_vec(), w.motion.axis = r.get_vec(), w.motion.rotation_speed = r.get_number(), w.motion.velocity = r.get_vec();
        get_motion_extras(r, w.motion);
        w.motion_start = r.get<std::uint64_t>();
        if (w.motion_start > saved.steps) r.broken();
        w.start_pose.position = r.get_vec(), w.start_pose.orientation = r.get_quat();
        w.load.force = r.get_vec(), w.load.torque = r.get_vec(), w.load.power = r.get_number();
        w.work = r.get_number();
        const std::size_t count = r.get_count(12);
        for (std::size_t k = 0; k < count; ++k) {
            SavedHistory h{r.get<std::uint32_t>(), r.get<std::uint32_t>(), r.get<std::uint32_t>(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), 0.0};
            h.normal = r.get_vec(), h.spring = r.get_vec(), h.torque = r.get_vec(), h.last_overlap = r.get_number();
            if (h.body >= n || h.sphere >= s.templates[saved.bodies.template_of(h.body)].balls.size() || h.patch >= wall.mesh.patch_count) r.broken();
            w.history.push_back(h);
        }
        saved.walls.push_back(std::move(w));
    }
    saved.recorder = detail::get_recorder(r, s.walls.size(), saved.steps, n);
    r.end();
    for (std::size_t i = 0; i < n; ++i) {
        const bool sound =
            saved.bodies.position(i).allFinite() && std::abs(saved.bodies.orientation(i).norm() - 1.0) < 1e-6 && s.domain.contains(saved.bodies.position(i));
        if (!sound) r.broken();
    }
    return saved;
}

/// Puts the springs back into freshly found candidates. False when one has no place.
bool install_springs(Simulation::State& s, const Saved& saved) {
    std::size_t next = 0;
    detail::for_each_record(s.pairs, s.bodies, [&](detail::PairRecord& record, detail::PairBlock& block) {
        const std::uint32_t i = s.bodies.id(record.i), j = s.bodies.id(record.j);
        if (next == saved.springs.size() || saved.springs[next].i != i || saved.springs[next].j != j) return;
        detail::refresh_candidates(s.pairs, block, record, s.templates[s.bodies.template_of(record.i)], s.templates[s.bodies.template_of(record.j)],
                                   detail::relative_pose(s.kinematics[record.i], s.kinematics[record.j]), *s.kernels, static_cast<std::uint32_t>(s.steps));
        for (std::size_t c = record.first; c < record.first + std::size_t{record.count} && next < saved.springs.size(); ++c) {
            const SavedSpring& spring = saved.springs[next];
            if (spring.i != i || spring.j != j || block.candidates[c].key() != ((spring.a << 16) | spring.b)) continue;
            for (std::size_t row = 0; row < s.pairs.spring_rows; ++row)
                std::copy_n(spring.spring + 4 * row, 4, block.springs[c * s.pairs.spring_rows + row].row);
            block.candidates[c].a |= detail::Candidate::touching_bit;
            ++next;
        }
    });
    for (std::size_t k = 0; k < s.walls.size(); ++k)
        for (const SavedHistory& h : saved.walls[k].history) {
            detail::WallWatch& watch = s.walls[k].watches[s.bodies.place_of(h.body)];
            if (!watch.near) watch.near = std::make_unique<detail::NearWall>();
            watch.near->history.push_back({h.sphere, h.patch, h.normal, h.spring, h.torque, h.last_overlap});
        }
    return next == saved.springs.size();
}

/// Makes the simulation what was saved. False when it contradicts itself.
bool put_in_place(Simulation::State& s, const Saved& saved) {
    s.steps = saved.steps;
    std::copy_n(saved.book.begin(), 3, s.book.stored.begin());
    std::copy_n(saved.book.begin() + 3, 5, s.book.gone.begin());
    s.book.body_force_work = saved.book[8];
    s.recorder = saved.recorder;
    s.bodies = saved.bodies;
    for (std::size_t k = 0; k < s.walls.size(); ++k) {
        detail::Wall& wall = s.walls[k];
        wall.motion = saved.walls[k].motion;
        wall.motion_start = saved.walls[k].motion_start;
        wall.start_pose = saved.walls[k].start_pose;
        wall.watches.clear();
        wall.wake.clear();
        detail::move_wall(wall, s.steps, s.definition.time_step);
        s.wall_loads[k] = saved.walls[k].load;
        s.book.wall_work[k] = saved.walls[k].work;
    }
    detail::PairList fresh;
    fresh.skin = s.pairs.skin, fresh.smallest_skin = s.pairs.smallest_skin, fresh.largest_skin = s.pairs.largest_skin, fresh.rebuilt_at = s.steps,
    fresh.pair_skin = s.pairs.pair_skin, fresh.hold = s.pairs.hold, fresh.spring_rows = s.pairs.spring_rows;
    s.pairs = std::move(fresh);
    s.kinematics.resize(detail::padded_count(s.bodies.size()));
    for (detail::Wall& wall : s.walls)
        wall.watches.resize(s.bodies.size()), wall.wake.resize(s.bodies.size(), detail::always_awake), wall.loads.resize(s.bodies.size()),
            wall.touching.resize(s.bodies.size());
    s.order_bodies();
    s.fit_to_body_count();
    s.pairs.ordered_spread = s.pairs.spread;
    for (std::size_t i = 0; i < s.bodies.size(); ++i) detail::fill_record(s.bodies, s.templates[s.bodies.template_of(i)], i, s.kinematics[i]);
    s.view_is_current = false;
    return install_springs(s, saved);
}

}  // namespace

std::string Simulation::checkpoint() const {
    const std::string payload = payload_of(*state_);
    const Header header{magic, version, 0, detail::fingerprint(state_->definition), payload.size(), checksum_of(payload)};
    return std::string(reinterpret_cast<const char*>(&header), sizeof header) + payload;
}

void Simulation::save_checkpoint(const std::filesystem::path& file) const {
    const std::string bytes = checkpoint();
    std::filesystem::path temporary = file;
    temporary += ".part";
    const auto fail = [&](const std::string& what) {
        std::error_code ignored;
        std::filesystem::remove(temporary, ignored);
        return bad_input("the checkpoint cannot be written: " + what, "check the folder, its permissions and the free space", {file.string()});
    };
    std::FILE* out = std::fopen(temporary.c_str(), "wb");
    if (!out) throw fail(std::strerror(errno));
    bool good = std::fwrite(bytes.data(), bytes.size(), 1, out) == 1;
    good = std::fflush(out) == 0 && good;
    good = good && fsync(fileno(out)) == 0;  // the data must be on disk before the name points to them
    const int reason = errno;
    good = std::fclose(out) == 0 && good;
    if (!good) throw fail(std::strerror(reason));
    std::error_code error;
    std::filesystem::rename(temporary, file, error);
    if (error) throw fail(error.message());
}

void Simulation::load_checkpoint(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    if (!in) throw bad_input("the checkpoint cannot be read", "check the path and its permissions", {file.string()});
    const std::string bytes(std::istreambuf_iterator<char>(in), {});
    restore(bytes, file.string());
}

void Simulation::restore(std::string_view bytes, const std::string& name) {
    State& s = *state_;
    Header header;
    if (bytes.size() >= sizeof header) std::memcpy(&header, bytes.data(), sizeof header);
    if (bytes.size() < sizeof header || header.magic != magic) throw bad_input("this is not a checkpoint of PelletLab", "give a file that a run wrote", {name});
    if (header.version != version)
        throw bad_input("the checkpoint has format version " + std::to_string(header.version) + ", this program reads " + std::to_string(version),
                        "go on with the program that wrote it", {name});
    if (header.fingerprint != detail::fingerprint(s.definition))
        throw bad_input("the checkpoint belongs to another case", "templates, walls, materials, gravity and time step must be the same", {name});
    const std::string_view payload = bytes.substr(sizeof header);
    if (payload.size() != header.payload_bytes) throw bad_input("the checkpoint is cut off or has a tail", "it is damaged: use an older one", {name});
    if (checksum_of(payload) != header.checksum) throw bad_input("the checkpoint's checksum is wrong", "it is damaged: use an older one", {name});
    const Saved saved = read_payload(payload, name, s);
    const std::string before = payload_of(s);
    if (put_in_place(s, saved)) return;
    put_in_place(s, read_payload(before, name, s));
    throw bad_input("the checkpoint holds contacts of spheres that are far apart", "it is damaged: use an older one", {name});
}

}  // namespace pelletlab::solver
