// What the tests of meshes share: joining meshes, expecting an Error, a folder that goes away.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "core/error.hpp"
#include "core/triangle_mesh.hpp"

namespace pelletlab::meshes::test {

inline TriangleMesh joined(const TriangleMesh& a, const TriangleMesh& b) {
    TriangleMesh both = a;
    const auto first = static_cast<std::uint32_t>(a.vertices.size());
    both.vertices.insert(both.vertices.end(), b.vertices.begin(), b.vertices.end());
    for (const Triangle& t : b.faces) both.faces.push_back({t[0] + first, t[1] + first, t[2] + first});
    return both;
}

inline TriangleMesh moved(TriangleMesh mesh, const Vec3& by) {
    for (Vec3& v : mesh.vertices) v += by;
    return mesh;
}

inline TriangleMesh flipped(TriangleMesh mesh) {
    for (Triangle& t : mesh.faces) std::swap(t[1], t[2]);
    return mesh;
}

/// Runs the deed, expects Error(bad_input) and returns «problem | remedy | file:line» for a look at the words.
template <class Deed>
std::string refusal(const Deed& deed) {
    try {
        deed();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::bad_input) << error.what();
        EXPECT_FALSE(error.remedy().empty()) << "no remedy: " << error.problem();
        return error.problem() + " | " + error.remedy() + " | " + error.place().file + ":" + std::to_string(error.place().line);
    }
    ADD_FAILURE() << "no Error was thrown";
    return {};
}

class TemporaryFolder {
public:
    TemporaryFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "pelletlab-meshes-XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
        path_ = name;
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

}  // namespace pelletlab::meshes::test
