// The only file that knows Embree: one small scene an object, instanced at its poses into one scene of opaque things and one of glass.
#include <embree3/rtcore.h>

#include <string>

#include "core/error.hpp"
#include "report/detail/tracer.hpp"

namespace pelletlab::report::detail {
namespace {

constexpr unsigned triangles_id = 0, spheres_id = 1, edges_id = 2;  // geometry ids inside an object's scene

struct ReleaseDevice {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct ReleaseScene {
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using DeviceHandle = std::unique_ptr<RTCDeviceTy, ReleaseDevice>;
using SceneHandle = std::unique_ptr<RTCSceneTy, ReleaseScene>;

template <class T>
T* new_buffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, std::size_t stride, std::size_t count) {
    return static_cast<T*>(rtcSetNewGeometryBuffer(geometry, type, 0, format, stride, count));
}

void attach(RTCScene scene, RTCGeometry geometry, unsigned id) {
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, id);
    rtcReleaseGeometry(geometry);
}

void add_triangles(RTCDevice device, RTCScene scene, const PreparedObject& object) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = new_buffer<float>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, 3 * sizeof(float), object.vertices.size());
    auto* indices = new_buffer<unsigned>(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), object.faces.size());
    for (const Vec3f& vertex : object.vertices)
        for (int k = 0; k < 3; ++k) *vertices++ = vertex[k];
    for (const Triangle& face : object.faces)
        for (const std::uint32_t index : face) *indices++ = index;
    attach(scene, geometry, triangles_id);
}

void add_spheres(RTCDevice device, RTCScene scene, const PreparedObject& object) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
    auto* points = new_buffer<float>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, 4 * sizeof(float), object.spheres.size());
    for (const Eigen::Vector4f& sphere : object.spheres)
        for (int k = 0; k < 4; ++k) *points++ = sphere[k];
    attach(scene, geometry, spheres_id);
}

void add_edges(RTCDevice device, RTCScene scene, const PreparedObject& object, float radius) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE);
    auto* points = new_buffer<float>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, 4 * sizeof(float), 2 * object.edges.size());
    auto* indices = new_buffer<unsigned>(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT, sizeof(unsigned), object.edges.size());
    for (std::size_t e = 0; e < object.edges.size(); ++e) {
        for (const Vec3f& end : object.edges[e]) {
            for (int k = 0; k < 3; ++k) *points++ = end[k];
            *points++ = radius;
        }
        *indices++ = static_cast<unsigned>(2 * e);
    }
    attach(scene, geometry, edges_id);
}

SceneHandle object_scene(RTCDevice device, const PreparedObject& object, double line_radius) {
    SceneHandle scene(rtcNewScene(device));
    if (!object.faces.empty()) add_triangles(device, scene.get(), object);
    if (!object.spheres.empty()) add_spheres(device, scene.get(), object);
    if (!object.edges.empty() && line_radius > 0.0) add_edges(device, scene.get(), object, static_cast<float>(line_radius));
    rtcCommitScene(scene.get());
    return scene;
}

SceneHandle instanced_scene(RTCDevice device, const std::vector<PreparedInstance>& instances, const std::vector<SceneHandle>& objects) {
    SceneHandle scene(rtcNewScene(device));
    for (unsigned i = 0; i < instances.size(); ++i) {
        RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
        rtcSetGeometryInstancedScene(geometry, objects[instances[i].object].get());
        Eigen::Matrix<float, 3, 4> to_world;  // column by column
        to_world << instances[i].rotation, instances[i].translation;
        rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, to_world.data());
        attach(scene.get(), geometry, i);
    }
    rtcCommitScene(scene.get());
    return scene;
}

void fill(const RayPacket& rays, std::size_t i, RTCRay16& ray) {
    ray.org_x[i] = rays.origin[0][i];
    ray.org_y[i] = rays.origin[1][i];
    ray.org_z[i] = rays.origin[2][i];
    ray.dir_x[i] = rays.direction[0][i];
    ray.dir_y[i] = rays.direction[1][i];
    ray.dir_z[i] = rays.direction[2][i];
    ray.tnear[i] = rays.nearest[i];
    ray.tfar[i] = rays.farthest[i];
    ray.time[i] = 0.0f;
    ray.mask[i] = 0xffffffffu;
    ray.id[i] = 0;
    ray.flags[i] = 0;
}

}  // namespace

struct Tracer::Scenes {
    const PreparedScene& prepared;
    DeviceHandle device;
    std::vector<SceneHandle> objects;
    SceneHandle opaque, glass;

    explicit Scenes(const PreparedScene& scene) : prepared(scene), device(rtcNewDevice(nullptr)) {
        if (!device) throw numerical_failure("the ray tracer Embree could not start", "error " + std::to_string(rtcGetDeviceError(nullptr)));
        for (const PreparedObject& object : scene.objects) objects.push_back(object_scene(device.get(), object, scene.line_radius));
        opaque = instanced_scene(device.get(), scene.opaque, objects);
        glass = instanced_scene(device.get(), scene.glass, objects);
        const RTCError error = rtcGetDeviceError(device.get());
        if (error == RTC_ERROR_OUT_OF_MEMORY) throw numerical_failure("not enough memory for the picture's scene", "draw fewer pellets or a coarser mesh");
        if (error != RTC_ERROR_NONE) throw numerical_failure("Embree refused the picture's scene: error " + std::to_string(error));
    }
};

Tracer::Tracer(const PreparedScene& scene) : scenes_(std::make_unique<Scenes>(scene)) {}
Tracer::~Tracer() = default;

bool Tracer::has_glass() const {
    return !scenes_->prepared.glass.empty();
}

void Tracer::first_hits(Layer layer, const RayPacket& rays, Lanes<Hit>& hits) const {
    alignas(64) RTCRayHit16 packet;
    alignas(64) int valid[packet_size];
    for (std::size_t i = 0; i < packet_size; ++i) {
        fill(rays, i, packet.ray);
        packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
        packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
        valid[i] = rays.active[i] ? -1 : 0;
    }
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect16(valid, layer == Layer::opaque ? scenes_->opaque.get() : scenes_->glass.get(), &context, &packet);

    const auto& instances = layer == Layer::opaque ? scenes_->prepared.opaque : scenes_->prepared.glass;
    for (std::size_t i = 0; i < packet_size; ++i) {
        Hit& hit = hits[i];
        hit.found = rays.active[i] && packet.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
        if (!hit.found) continue;
        hit.t = packet.ray.tfar[i];
        hit.instance = packet.hit.instID[0][i];
        hit.part = static_cast<Part>(packet.hit.geomID[i]);
        hit.primitive = packet.hit.primID[i];
        hit.u = packet.hit.u[i];
        hit.v = packet.hit.v[i];
        // Embree reports the normal in the object's frame.
        hit.normal = (instances[hit.instance].rotation * Vec3f(packet.hit.Ng_x[i], packet.hit.Ng_y[i], packet.hit.Ng_z[i])).normalized();
    }
}

void Tracer::blocked(const RayPacket& rays, Lanes<bool>& blocked) const {
    alignas(64) RTCRay16 packet;
    alignas(64) int valid[packet_size];
    for (std::size_t i = 0; i < packet_size; ++i) {
        fill(rays, i, packet);
        valid[i] = rays.active[i] ? -1 : 0;
    }
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded16(valid, scenes_->opaque.get(), &context, &packet);
    for (std::size_t i = 0; i < packet_size; ++i) blocked[i] = rays.active[i] && packet.tfar[i] < 0.0f;  // Embree marks a blocked ray by tfar = −∞
}

void RayPacket::set(std::size_t lane, const Vec3f& from, const Vec3f& along, float t_near, float t_far) {
    for (std::size_t k = 0; k < 3; ++k) {
        origin[k][lane] = from[static_cast<Eigen::Index>(k)];
        direction[k][lane] = along[static_cast<Eigen::Index>(k)];
    }
    nearest[lane] = t_near;
    farthest[lane] = t_far;
    active[lane] = true;
}

Vec3f RayPacket::at(std::size_t lane, float t) const {
    return Vec3f(origin[0][lane], origin[1][lane], origin[2][lane]) + t * along(lane);
}

}  // namespace pelletlab::report::detail
