// The body that a shape verb works on: a mesh file, checked and on demand repaired, or a parametric body.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/triangle_mesh.hpp"
#include "meshes/repair.hpp"

namespace pelletlab::apps {

struct BodyRequest {
    std::filesystem::path mesh_file;  ///< a mesh file …
    std::string unit;                 ///< … with its unit: «mm»
    std::string parametric;           ///< or a body by name: «trilobe:height=4mm» (meshes/named_body.hpp)
    std::optional<meshes::RepairMethod> repair;
    Vec3 stretch = Vec3::Ones();  ///< factors along the axes of the mesh: oval, long and large ones of a family
};

/// Settings of the request in one line, for a stage's key.
std::string describe(const BodyRequest& request);

/// Hash of what decides the body: the file's bytes or the text.
std::string hash_of(const BodyRequest& request);

/// A closed body with the mesh file that stands for it. A parametric, repaired or stretched body has no such file yet: it is written beside the result, and
/// removed again unless keep() is called.
class BodyOnDisk {
public:
    /// `stem`: where a new mesh file may go, without its ending. Unless quiet, says what was read and repaired. Throws Error(bad_input).
    BodyOnDisk(const BodyRequest& request, const std::filesystem::path& stem, bool quiet = false);
    ~BodyOnDisk();
    BodyOnDisk(const BodyOnDisk&) = delete;
    BodyOnDisk& operator=(const BodyOnDisk&) = delete;

    const TriangleMesh& mesh() const { return mesh_; }
    const std::filesystem::path& file() const { return file_; }
    const std::string& unit() const { return unit_; }
    bool made_here() const { return made_here_; }
    void keep() { remove_ = false; }

private:
    TriangleMesh mesh_;
    std::filesystem::path file_;
    std::string unit_;
    bool made_here_ = false, remove_ = false;
    std::vector<std::filesystem::path> made_folders_;  // the deepest first
    void remove_traces() const;
};

}  // namespace pelletlab::apps
