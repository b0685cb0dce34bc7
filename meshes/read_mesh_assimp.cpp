#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>

#include "core/error.hpp"
#include "core/units.hpp"
#include "meshes/detail/mesh_text.hpp"
#include "meshes/detail/weld.hpp"
#include "meshes/read_mesh.hpp"

namespace pelletlab::meshes {
namespace {

std::string lower_case_extension(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    if (!extension.empty()) extension.erase(0, 1);
    std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension;
}

/// Faces with three or more corners, and the triangles they make.
struct Count {
    std::uint64_t polygons = 0, triangles = 0;
};

Count count_faces(const aiScene& scene) {
    Count count;
    for (unsigned m = 0; m < scene.mNumMeshes; ++m)
        for (unsigned f = 0; f < scene.mMeshes[m]->mNumFaces; ++f) {
            const unsigned corners = scene.mMeshes[m]->mFaces[f].mNumIndices;
            if (corners < 3) continue;
            ++count.polygons;
            count.triangles += corners - 2;
        }
    return count;
}

/// All triangles of the scene as they are, not welded, in the file's unit.
TriangleMesh collect(const aiScene& scene, const std::filesystem::path& file) {
    TriangleMesh mesh;
    for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
        const aiMesh& part = *scene.mMeshes[m];
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        for (unsigned v = 0; v < part.mNumVertices; ++v) mesh.vertices.emplace_back(part.mVertices[v].x, part.mVertices[v].y, part.mVertices[v].z);
        for (unsigned f = 0; f < part.mNumFaces; ++f) {
            const aiFace& face = part.mFaces[f];
            if (face.mNumIndices != 3) continue;
            Triangle triangle{};
            for (unsigned k = 0; k < 3; ++k) {
                if (face.mIndices[k] >= part.mNumVertices)
                    throw bad_input("face " + std::to_string(f + 1) + " names a vertex that does not exist", "export the mesh again", {file.string()});
                triangle[k] = first + face.mIndices[k];
            }
            mesh.faces.push_back(triangle);
        }
    }
    return mesh;
}

}  // namespace

TriangleMesh read_mesh(const std::filesystem::path& file, const std::string& unit) {
    if (unit.empty())
        throw bad_input("the mesh has no unit: a mesh file stores bare numbers",
                        "say which unit they are in, for instance --unit mm, or mesh_unit = \"mm\" in a case", {file.string()});
    const double factor = unit_factor(unit, dimension::length);
    const std::string extension = lower_case_extension(file);
    const std::string bytes = detail::read_bytes(file);
    if (extension != "stl" && extension != "obj" && extension != "ply")
        throw bad_input("«." + extension + "» is not a mesh format that can be read", "export the body as STL, OBJ or PLY", {file.string()});
    const detail::FileOutline outline = detail::outline(bytes, extension, file);
    if (outline.faces == 0) throw bad_input("the mesh file holds no triangles", "export the body as a triangulated surface", {file.string()});

    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFileFromMemory(bytes.data(), bytes.size(), 0, extension.c_str());
    if (scene == nullptr)
        throw bad_input(std::string("the mesh file cannot be understood: ") + importer.GetErrorString(), "check the file in a mesh viewer, or export it again",
                        {file.string()});
    const Count before = count_faces(*scene);
    if (before.polygons != outline.faces)
        throw bad_input("the file announces " + std::to_string(outline.faces) + " faces, but only " + std::to_string(before.polygons) +
                            " of three or more corners could be read",
                        "the file is damaged or holds faces of two corners: export it again", {file.string()});
    scene = importer.ApplyPostProcessing(aiProcess_Triangulate);
    if (scene == nullptr) throw bad_input("the polygons of the mesh cannot be cut into triangles", "export it as triangles", {file.string()});
    TriangleMesh mesh = collect(*scene, file);
    if (mesh.faces.size() != before.triangles)
        throw bad_input("some polygons of the mesh cannot be cut into triangles: " + std::to_string(before.triangles) + " were expected, " +
                            std::to_string(mesh.faces.size()) + " made",
                        "export it as triangles", {file.string()});

    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
        for (int k = 0; k < 3; ++k)
            if (!mesh.corner(f, k).allFinite()) {
                const int line = outline.format == detail::MeshFormat::stl_binary ? 0 : detail::line_of_bad_number(bytes);
                throw bad_input("corner " + std::to_string(k + 1) + " of triangle " + std::to_string(f + 1) + " has a coordinate that is not a finite number",
                                "export the mesh again", {file.string(), line});
            }
    mesh = detail::weld(mesh);
    for (Vec3& vertex : mesh.vertices) vertex *= factor;
    return mesh;
}

}  // namespace pelletlab::meshes
