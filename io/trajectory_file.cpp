#include "io/trajectory_file.hpp"

#include <algorithm>
#include <system_error>
#include <vector>

#include "core/error.hpp"
#include "io/detail/storage.hpp"

namespace pelletlab::io {

namespace {

using detail::Storage;
namespace fs = std::filesystem;

constexpr const char* format_name = "pelletlab-trajectory";
constexpr std::uint64_t format_version = 2;  // 2: sealed

std::string numbered(const char* group, std::size_t index, const char* member) {
    return "/" + std::string(group) + "/" + std::to_string(index) + "/" + member;
}

// ---- flat numbers and our structs ---------------------------------------------------------------------------------------------

std::span<const double> flat(const std::vector<Vec3>& vectors) {
    static_assert(sizeof(Vec3) == 3 * sizeof(double));
    return vectors.empty() ? std::span<const double>() : std::span<const double>(vectors.front().data(), vectors.size() * 3);
}

void push(std::vector<double>& numbers, const Quat& q) {
    numbers.insert(numbers.end(), {q.w(), q.x(), q.y(), q.z()});
}
void push(std::vector<double>& numbers, const Vec3& v) {
    numbers.insert(numbers.end(), {v[0], v[1], v[2]});
}

Vec3 vector_at(std::span<const double> numbers, std::size_t at) {
    return {numbers[at], numbers[at + 1], numbers[at + 2]};
}
Quat quaternion_at(std::span<const double> numbers, std::size_t at) {
    return {numbers[at], numbers[at + 1], numbers[at + 2], numbers[at + 3]};
}

std::vector<Vec3> vectors_of(std::span<const double> numbers) {
    std::vector<Vec3> vectors(numbers.size() / 3);
    for (std::size_t i = 0; i < vectors.size(); ++i) vectors[i] = vector_at(numbers, 3 * i);
    return vectors;
}

// ---- header -------------------------------------------------------------------------------------------------------------------

void write_mesh(Storage& file, const std::string& prefix, const TriangleMesh& mesh) {
    std::vector<std::uint32_t> corners;
    corners.reserve(mesh.faces.size() * 3);
    for (const Triangle& face : mesh.faces) corners.insert(corners.end(), face.begin(), face.end());
    file.write(prefix + "vertices", flat(mesh.vertices), 3, "m");
    file.write(prefix + "faces", corners, 3);
}

TriangleMesh read_mesh(const Storage& file, const std::string& prefix, const std::string& name) {
    TriangleMesh mesh;
    mesh.vertices = vectors_of(file.numbers(prefix + "vertices", 3));
    const auto corners = file.indices(prefix + "faces", 3);
    for (std::size_t i = 0; i < corners.size(); i += 3) mesh.faces.push_back({corners[i], corners[i + 1], corners[i + 2]});
    if (!corners.empty() && *std::max_element(corners.begin(), corners.end()) >= mesh.vertices.size())
        throw bad_input("the mesh '" + prefix + "' names a vertex that it does not have", "the file is damaged: make it again", {name});
    return mesh;
}

void write_shape(Storage& file, std::size_t index, const PelletShape& shape) {
    const MassProperties& m = shape.rigid.mass_properties;
    const auto write = [&](const char* member, const std::vector<double>& row, const char* unit) {
        file.write(numbered("shapes", index, member), row, row.size(), unit);
    };
    std::vector<double> spheres;
    for (const Sphere& sphere : shape.rigid.spheres) {
        push(spheres, sphere.centre);
        spheres.push_back(sphere.radius);
    }
    const Quat& q = m.principal_axes;
    file.write_text(numbered("shapes", index, "name"), shape.rigid.name);
    file.write(numbered("shapes", index, "spheres"), spheres, 4, "m");
    write("bounding_radius", {shape.rigid.bounding_radius}, "m");
    write("volume", {m.volume}, "m^3");
    write("density", {m.density}, "kg/m^3");
    write("mass", {m.mass}, "kg");
    write("centre_of_mass_mesh", {m.centre_of_mass_mesh[0], m.centre_of_mass_mesh[1], m.centre_of_mass_mesh[2]}, "m");
    write("principal_axes", {q.w(), q.x(), q.y(), q.z()}, "1");
    write("principal_inertia", {m.principal_inertia[0], m.principal_inertia[1], m.principal_inertia[2]}, "kg*m^2");
    write_mesh(file, numbered("shapes", index, "surface_"), shape.surface_body);
}

PelletShape read_shape(const Storage& file, std::size_t index, const std::string& name) {
    const auto row = [&](const char* member, std::size_t columns) {
        auto numbers = file.numbers(numbered("shapes", index, member), columns);
        if (numbers.size() != columns)
            throw bad_input("the entry '" + numbered("shapes", index, member) + "' is missing", "the file is damaged: make it again", {name});
        return numbers;
    };
    PelletShape shape;
    shape.rigid.name = file.text(numbered("shapes", index, "name"));
    const auto spheres = file.numbers(numbered("shapes", index, "spheres"), 4);
    for (std::size_t i = 0; i < spheres.size(); i += 4) shape.rigid.spheres.push_back({vector_at(spheres, i), spheres[i + 3]});
    shape.rigid.bounding_radius = row("bounding_radius", 1)[0];
    MassProperties& m = shape.rigid.mass_properties;
    m.volume = row("volume", 1)[0];
    m.density = row("density", 1)[0];
    m.mass = row("mass", 1)[0];
    m.centre_of_mass_mesh = vector_at(row("centre_of_mass_mesh", 3), 0);
    m.principal_axes = quaternion_at(row("principal_axes", 4), 0);
    m.principal_inertia = vector_at(row("principal_inertia", 3), 0);
    shape.surface_body = read_mesh(file, numbered("shapes", index, "surface_"), name);
    return shape;
}

void write_provenance(Storage& file, const Provenance& p) {
    file.write_text("/provenance/tool", p.tool);
    file.write_text("/provenance/version", p.version);
    file.write_text("/provenance/git_hash", p.git_hash);
    file.write_text("/provenance/verb", p.verb);
    file.write("/provenance/seed", p.seed);
    file.write("/provenance/input_count", p.input_hashes.size());
    std::size_t index = 0;
    for (const auto& [name, hash] : p.input_hashes) {
        file.write_text(numbered("provenance/inputs", index, "file"), name);
        file.write_text(numbered("provenance/inputs", index, "sha256"), hash);
        ++index;
    }
}

Provenance read_provenance(const Storage& file) {
    Provenance p;
    p.tool = file.text("/provenance/tool");
    p.version = file.text("/provenance/version");
    p.git_hash = file.text("/provenance/git_hash");
    p.verb = file.text("/provenance/verb");
    p.seed = file.whole("/provenance/seed");
    const std::uint64_t count = file.whole("/provenance/input_count");
    for (std::size_t i = 0; i < count; ++i)
        p.input_hashes[file.text(numbered("provenance/inputs", i, "file"))] = file.text(numbered("provenance/inputs", i, "sha256"));
    return p;
}

void write_header(Storage& file, const TrajectoryHeader& header) {
    file.write_text("/format", format_name);
    file.write("/format_version", format_version);
    file.write_text("/case/name", header.case_name);
    file.write_text("/case/resolved", header.resolved_case);
    file.write("/case/gravity", std::span<const double>(header.gravity.data(), 3), 3, "m/s^2");
    write_provenance(file, header.provenance);
    file.write("/shape_count", header.shapes.size());
    for (std::size_t i = 0; i < header.shapes.size(); ++i) write_shape(file, i, header.shapes[i]);
    file.write("/wall_count", header.walls.size());
    for (std::size_t i = 0; i < header.walls.size(); ++i) {
        file.write_text(numbered("walls", i, "name"), header.walls[i].name);
        write_mesh(file, numbered("walls", i, ""), header.walls[i].mesh);
    }
    file.write("/body_count", header.shape_of_body.size());
    file.write("/shape_of_body", header.shape_of_body, 1);
}

TrajectoryHeader read_header(const Storage& file, const std::string& name) {
    if (!file.has("/format") || file.text("/format") != format_name)
        throw bad_input("this HDF5 file is no trajectory of pelletlab", "name a run.h5 made by `pelletlab fill` or `pelletlab drum`", {name});
    if (file.whole("/format_version") != format_version)
        throw bad_input("this version of the trajectory format is not known to this pelletlab", "use the pelletlab that wrote the file", {name});
    TrajectoryHeader header;
    header.case_name = file.text("/case/name");
    header.resolved_case = file.text("/case/resolved");
    const auto gravity = file.numbers("/case/gravity", 3);
    if (gravity.size() != 3) throw bad_input("gravity is missing", "the file is damaged: make it again", {name});
    header.gravity = vector_at(gravity, 0);
    header.provenance = read_provenance(file);
    const std::uint64_t shapes = file.whole("/shape_count"), walls = file.whole("/wall_count"), bodies = file.whole("/body_count");
    for (std::size_t i = 0; i < shapes; ++i) header.shapes.push_back(read_shape(file, i, name));
    for (std::size_t i = 0; i < walls; ++i) header.walls.push_back({file.text(numbered("walls", i, "name")), read_mesh(file, numbered("walls", i, ""), name)});
    header.shape_of_body = file.indices("/shape_of_body", 1);
    const bool known = std::all_of(header.shape_of_body.begin(), header.shape_of_body.end(), [shapes](std::uint32_t shape) { return shape < shapes; });
    if (header.shape_of_body.size() != bodies || !known) throw bad_input("the bodies do not fit the shapes", "the file is damaged: make it again", {name});
    return header;
}

// ---- frames -------------------------------------------------------------------------------------------------------------------

struct FrameArray {
    const char* path;
    std::vector<std::size_t> row_shape;
    const char* unit;
};

/// Growing arrays of a file with so many bodies and walls; those without items are left out.
std::vector<FrameArray> frame_arrays(std::size_t bodies, std::size_t walls) {
    std::vector<FrameArray> arrays{{"/frames/time", {}, "s"}};
    if (bodies > 0) {
        arrays.push_back({"/frames/position", {bodies, 3}, "m"});
        arrays.push_back({"/frames/orientation", {bodies, 4}, "1"});
        arrays.push_back({"/frames/velocity", {bodies, 3}, "m/s"});
        arrays.push_back({"/frames/spin", {bodies, 3}, "rad/s"});
    }
    if (walls > 0) arrays.push_back({"/frames/wall_pose", {walls, 7}, "m (3), 1 (4)"});
    return arrays;
}

/// A trajectory that stays on the disk: one frame is read at a time.
class StoredTrajectory final : public FrameSource {
public:
    explicit StoredTrajectory(const fs::path& file) : file_(Storage::open(file)), header_(read_header(file_, file.string())) {
        const std::size_t frames = file_.row_count("/frames/time", {});
        for (const FrameArray& array : frame_arrays(header_.shape_of_body.size(), header_.walls.size()))
            if (file_.row_count(array.path, array.row_shape) != frames)
                throw bad_input("the array '" + std::string(array.path) + "' has another number of frames than the others",
                                "the file is damaged: make it again", {file.string()});
        times_.resize(frames);
        for (std::size_t i = 0; i < frames; ++i) file_.read_row("/frames/time", i, {&times_[i], 1});
    }

    const TrajectoryHeader& header() const override { return header_; }
    std::size_t frame_count() const override { return times_.size(); }
    double time(std::size_t index) const override { return times_.at(index); }

    Frame frame(std::size_t index) const override {
        Frame frame;
        frame.time = times_.at(index);
        const std::size_t bodies = header_.shape_of_body.size(), walls = header_.walls.size();
        std::vector<double> numbers(bodies * 4);
        if (bodies > 0) {
            file_.read_row("/frames/orientation", index, numbers);
            for (std::size_t i = 0; i < bodies; ++i) frame.orientations.push_back(quaternion_at(numbers, 4 * i));
            frame.positions = read_vectors("/frames/position", index, bodies);
            frame.velocities = read_vectors("/frames/velocity", index, bodies);
            frame.spins = read_vectors("/frames/spin", index, bodies);
        }
        if (walls > 0) {
            numbers.resize(walls * 7);
            file_.read_row("/frames/wall_pose", index, numbers);
            for (std::size_t i = 0; i < walls; ++i) frame.wall_poses.push_back({vector_at(numbers, 7 * i), quaternion_at(numbers, 7 * i + 3)});
        }
        return frame;
    }

private:
    std::vector<Vec3> read_vectors(const char* path, std::size_t index, std::size_t count) const {
        std::vector<double> numbers(count * 3);
        file_.read_row(path, index, numbers);
        return vectors_of(numbers);
    }

    Storage file_;
    TrajectoryHeader header_;
    std::vector<double> times_;
};

}  // namespace

struct TrajectoryWriter::File {
    fs::path target, part;
    Storage storage;
    std::size_t bodies, walls;
    bool finished = false;

    File(const fs::path& file, const TrajectoryHeader& header)
        : target(file), part(fs::path(file) += ".part"), storage(Storage::create(part)), bodies(header.shape_of_body.size()), walls(header.walls.size()) {}
    ~File() {
        std::error_code ignored;
        if (!finished) fs::remove(part, ignored);
    }
    File(const File&) = delete;
    File& operator=(const File&) = delete;
};

TrajectoryWriter::TrajectoryWriter(const fs::path& file, const TrajectoryHeader& header) : file_(std::make_unique<File>(file, header)) {
    write_header(file_->storage, header);
    for (const FrameArray& array : frame_arrays(file_->bodies, file_->walls)) file_->storage.create_rows(array.path, array.row_shape, array.unit);
}

TrajectoryWriter::~TrajectoryWriter() = default;

void TrajectoryWriter::append(const Frame& frame) {
    const std::size_t n = file_->bodies;
    if (frame.positions.size() != n || frame.orientations.size() != n || frame.velocities.size() != n || frame.spins.size() != n ||
        frame.wall_poses.size() != file_->walls)
        throw bad_input("a frame has another number of bodies or walls than its trajectory", "this is a defect of pelletlab: please report it",
                        {file_->target.string()});
    Storage& storage = file_->storage;
    storage.append_row("/frames/time", {&frame.time, 1});
    std::vector<double> numbers;
    if (n > 0) {
        for (const Quat& q : frame.orientations) push(numbers, q);
        storage.append_row("/frames/orientation", numbers);
        storage.append_row("/frames/position", flat(frame.positions));
        storage.append_row("/frames/velocity", flat(frame.velocities));
        storage.append_row("/frames/spin", flat(frame.spins));
    }
    if (file_->walls == 0) return;
    numbers.clear();
    for (const Pose& pose : frame.wall_poses) {
        push(numbers, pose.position);
        push(numbers, pose.orientation);
    }
    storage.append_row("/frames/wall_pose", numbers);
}

void TrajectoryWriter::finish() {
    file_->storage.close();
    std::error_code failure;
    fs::rename(file_->part, file_->target, failure);
    if (failure) throw bad_input("the file cannot be written: " + failure.message(), "choose another name or folder", {file_->target.string()});
    file_->finished = true;
}

std::unique_ptr<FrameSource> open_trajectory(const fs::path& file) {
    return std::make_unique<StoredTrajectory>(file);
}

}  // namespace pelletlab::io
