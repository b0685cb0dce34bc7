#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "solver/detail/wall_query.hpp"

namespace pelletlab::solver::detail {

struct WallQuery::Scene {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    double rounding = 0.0;  ///< [m], error of float coordinates
    ~Scene() {
        if (scene) rtcReleaseScene(scene);
        if (device) rtcReleaseDevice(device);
    }
};

namespace {

/// Called for every triangle of the leaves that the query touches; the exact test comes afterwards.
bool collect(RTCPointQueryFunctionArguments* args) {
    static_cast<std::vector<std::uint32_t>*>(args->userPtr)->push_back(args->primID);
    return false;  // the radius stays
}

}  // namespace

WallQuery::WallQuery(const WallMesh& mesh) : scene_(std::make_unique<Scene>()) {
    scene_->device = rtcNewDevice("threads=1,set_affinity=0");
    if (!scene_->device)
        throw numerical_failure("Embree cannot start on this machine", "check that the library libembree3 is installed and fits the processor");
    scene_->scene = rtcNewScene(scene_->device);
    rtcSetSceneFlags(scene_->scene, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(scene_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices =
        static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.vertices.size()));
    auto* faces = static_cast<std::uint32_t*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), mesh.faces.size()));
    double largest = 0.0;
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
        for (int k = 0; k < 3; ++k) {
            vertices[3 * v + static_cast<std::size_t>(k)] = static_cast<float>(mesh.vertices[v][k]);
            largest = std::max(largest, std::abs(mesh.vertices[v][k]));
        }
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
        for (std::size_t k = 0; k < 3; ++k) faces[3 * f + k] = mesh.faces[f][k];
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_->scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_->scene);
    if (rtcGetDeviceError(scene_->device) != RTC_ERROR_NONE)
        throw numerical_failure("Embree cannot build the search tree of a wall", "check the mesh and the free memory");
    scene_->rounding = 1e-6 * largest;
}

WallQuery::~WallQuery() = default;
WallQuery::WallQuery(WallQuery&&) noexcept = default;
WallQuery& WallQuery::operator=(WallQuery&&) noexcept = default;

void WallQuery::faces_near(const WallMesh& mesh, const Vec3& centre, double radius, std::vector<std::uint32_t>& faces) const {
    faces.clear();
    RTCPointQuery query;
    query.x = static_cast<float>(centre.x());
    query.y = static_cast<float>(centre.y());
    query.z = static_cast<float>(centre.z());
    query.time = 0.0f;
    // The centre may lie far from the wall: its own rounding counts too.
    query.radius = static_cast<float>((radius + scene_->rounding + 1e-6 * centre.cwiseAbs().maxCoeff()) * 1.000001);
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(scene_->scene, &query, &context, &collect, &faces);
    const auto far = [&](std::uint32_t f) { return closest_point(mesh, f, centre).distance2 > radius * radius; };
    faces.erase(std::remove_if(faces.begin(), faces.end(), far), faces.end());
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
}

}  // namespace pelletlab::solver::detail
