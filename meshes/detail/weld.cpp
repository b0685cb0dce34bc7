#include "meshes/detail/weld.hpp"

#include <bit>
#include <cstdint>
#include <unordered_map>

namespace pelletlab::meshes::detail {
namespace {

struct PointKey {
    std::array<std::uint64_t, 3> bits;
    bool operator==(const PointKey&) const = default;
};

PointKey key_of(const Vec3& p) {
    // Adding +0 turns −0 into +0, which compare equal but differ in their bits.
    return {{std::bit_cast<std::uint64_t>(p.x() + 0.0), std::bit_cast<std::uint64_t>(p.y() + 0.0), std::bit_cast<std::uint64_t>(p.z() + 0.0)}};
}

struct PointHash {
    std::size_t operator()(const PointKey& key) const {
        std::uint64_t hash = 0x9e3779b97f4a7c15ULL;
        for (const std::uint64_t word : key.bits) {
            hash ^= word + (hash << 6) + (hash >> 2);
            hash *= 0xbf58476d1ce4e5b9ULL;
            hash ^= hash >> 29;
        }
        return hash;
    }
};

}  // namespace

TriangleMesh weld(const TriangleMesh& mesh) {
    TriangleMesh welded;
    welded.faces.reserve(mesh.faces.size());
    std::unordered_map<PointKey, std::uint32_t, PointHash> index_of;
    index_of.reserve(mesh.vertices.size());
    for (const Triangle& face : mesh.faces) {
        Triangle joined{};
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3& point = mesh.vertices[face[k]];
            const auto [place, is_new] = index_of.try_emplace(key_of(point), static_cast<std::uint32_t>(welded.vertices.size()));
            if (is_new) welded.vertices.push_back(point);
            joined[k] = place->second;
        }
        welded.faces.push_back(joined);
    }
    return welded;
}

}  // namespace pelletlab::meshes::detail
