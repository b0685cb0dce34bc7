#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>

#include "core/error.hpp"
#include "core/units.hpp"
#include "meshes/detail/polygons.hpp"
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
    const detail::Polygons polygons = extension == "stl"   ? detail::parse_stl(bytes, file)
                                      : extension == "obj" ? detail::parse_obj(bytes, file)
                                                           : detail::parse_ply(bytes, file);
    if (polygons.count() == 0) throw bad_input("the mesh file holds no triangles", "export the body as a triangulated surface", {file.string()});

    const std::string text = detail::plain_obj(polygons);
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFileFromMemory(text.data(), text.size(), aiProcess_Triangulate, "obj");
    if (scene == nullptr)
        throw bad_input(std::string("the mesh file cannot be understood: ") + importer.GetErrorString(), "check the file in a mesh viewer, or export it again",
                        {file.string()});
    TriangleMesh mesh = collect(*scene, file);
    if (mesh.faces.size() != polygons.triangles())
        throw bad_input("some polygons of the mesh cannot be cut into triangles: " + std::to_string(polygons.triangles()) + " were expected, " +
                            std::to_string(mesh.faces.size()) + " made",
                        "export it as triangles", {file.string()});
    mesh = detail::weld(mesh);
    for (Vec3& vertex : mesh.vertices) vertex *= factor;
    return mesh;
}

}  // namespace pelletlab::meshes
