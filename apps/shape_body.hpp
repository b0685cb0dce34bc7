// The body that a shape verb works on: a mesh file, checked and on demand repaired, or a parametric body.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/triangle_mesh.hpp"
#include "meshes/repair.hpp"

namespace pelletlab::apps {

struct BodyRequest {
    std::filesystem::path mesh_file;  ///< a mesh file …
    std::string unit;                 ///< … with its unit: «mm»
    std::string parametric;           ///< or a body by name: «trilobe:height=4mm» (meshes/named_body.hpp)
    std::optional<meshes::RepairMethod> repair;
};

/// Settings of the request in one line, for a stage's key.
std::string describe(const BodyRequest& request);

/// Hash of what decides the body: the file's bytes or the text.
std::string hash_of(const BodyRequest& request);

/// A closed body with the mesh file that stands for it. A parametric or repaired body has no such file yet: it is written beside the result, and removed
/// again unless keep() is called.
class BodyOnDisk {
public:
    /// `stem`: where a new mesh file may go, without its ending. Says what was read and repaired. Throws Error(bad_input).
    BodyOnDisk(const BodyRequest& request, const std::filesystem::path& stem);
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
};

}  // namespace pelletlab::apps
