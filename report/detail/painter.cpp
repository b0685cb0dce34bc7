#include "report/detail/painter.hpp"

#include <algorithm>
#include <cmath>

namespace pelletlab::report::detail {
namespace {

constexpr float surface_gap = 5e-5f;  // start of rays above a surface, in half diagonals of the scene: hides single-precision noise
constexpr float far_away = 1e6f;
constexpr float ground_radius = 2.2f;  // beyond, in half diagonals, no shadow is worth a ray
constexpr int most_glass_layers = 12;

Light as_light(const Colour& colour) {
    return {colour[0], colour[1], colour[2]};
}

}  // namespace

/// Up to sixteen camera rays of one pixel.
struct Painter::Packet {
    std::size_t count = 0;
    RayPacket rays;
    Lanes<Sight> seen;
    bool one_thing = true;  ///< all rays meet the same instance (or the ground, or nothing)
};

Painter::Painter(const Scene& scene, const PreparedScene& prepared, const Tracer& tracer, const CameraRays& camera, const Lighting& light, std::uint32_t width,
                 std::uint32_t samples)
    : prepared_(prepared),
      tracer_(tracer),
      camera_(camera),
      light_(light),
      background_(as_light(scene.background)),
      ground_{scene.ground, static_cast<float>((scene.ground_level - prepared.centre.z()) * prepared.scale)},
      width_(width),
      samples_(samples) {}

namespace {

/// Normal between those of the hit triangle's corners; a sphere's own normal.
Vec3f smooth_normal(const PreparedScene& scene, const PreparedInstance& instance, const Hit& hit) {
    if (hit.part != Part::triangles) return hit.normal;
    const auto& corners = scene.objects[instance.object].corner_normals[hit.primitive];
    const Vec3f normal = instance.rotation * ((1.0f - hit.u - hit.v) * corners[0] + hit.u * corners[1] + hit.v * corners[2]);
    return normal.squaredNorm() > 0.0f ? Vec3f(normal.normalized()) : hit.normal;
}

}  // namespace

void Painter::read_surface(const Hit& hit, Sight& seen) const {
    const PreparedInstance& instance = prepared_.opaque[hit.instance];
    const PreparedObject& object = prepared_.objects[instance.object];
    seen.surface = as_light(instance.colour);
    seen.normal = smooth_normal(prepared_, instance, hit);
    if (hit.part != Part::triangles || object.vertex_colours.empty()) return;
    const Triangle& face = object.faces[hit.primitive];
    const auto colour = [&object, &face](std::size_t k) { return as_light(object.vertex_colours[face[k]]); };
    seen.surface = (1.0f - hit.u - hit.v) * colour(0) + hit.u * colour(1) + hit.v * colour(2);
}

Sight Painter::sight(const RayPacket& rays, std::size_t lane, const Hit& hit) const {
    Sight seen;
    const Vec3f view = rays.along(lane);
    seen.t = far_away;
    seen.view = view;
    if (hit.found) {
        seen.thing = hit.instance;
        seen.t = hit.t;
        seen.true_normal = hit.normal;
        read_surface(hit, seen);
        if (seen.true_normal.dot(view) > 0.0f) seen.true_normal = -seen.true_normal;
        if (seen.normal.dot(seen.true_normal) < 0.0f) seen.normal = -seen.normal;
    } else if (ground_.drawn && view.z() < 0.0f) {
        const float t = (ground_.level - rays.origin[2][lane]) / view.z();
        if (t > 0.0f && rays.at(lane, t).head<2>().squaredNorm() < ground_radius * ground_radius) {
            seen.thing = PixelRecord::ground;
            seen.t = t;
        }
    }
    seen.point = rays.at(lane, seen.t) + surface_gap * seen.true_normal;
    return seen;
}

/// Camera ray through the point (x, y) of the picture.
void Painter::aim(RayPacket& rays, std::size_t lane, double x, double y) const {
    const Ray ray = camera_.ray(x, y);
    // Everything lies within 1 of the origin: rays from afar start 2 before it, else single precision would blur them.
    Vec3 origin = prepared_.scaled(ray.origin);
    origin += std::max(0.0, -origin.dot(ray.direction) - 2.0) * ray.direction;
    rays.set(lane, origin.cast<float>(), ray.direction.cast<float>(), 0.0f, far_away);
}

Painter::Packet Painter::look(std::uint32_t x, std::uint32_t y, const PixelSamples& pattern, std::size_t first) const {
    Packet packet;
    packet.count = std::min<std::size_t>(packet_size, samples_ - first);
    for (std::size_t i = 0; i < packet.count; ++i) {
        const Point2 film = pattern.film(first + i);
        aim(packet.rays, i, x + film[0], y + film[1]);
    }
    Lanes<Hit> hits;
    tracer_.first_hits(Layer::opaque, packet.rays, hits);
    for (std::size_t i = 0; i < packet.count; ++i) {
        packet.seen[i] = sight(packet.rays, i, hits[i]);
        packet.one_thing &= packet.seen[i].thing == packet.seen[0].thing;
    }
    return packet;
}

/// Lights of a point before anything stands in their way.
void Painter::shade(Sight& seen) const {
    const float towards_key = std::max(0.0f, seen.normal.dot(light_.to_key));
    const float key = light_.key_strength * towards_key, sky = open_sky(light_, seen.normal);
    if (seen.thing == PixelRecord::ground) {  // share of what an empty ground would receive
        const Light share = background_ / (key + sky);
        seen.key = key * share;
        seen.open_sky = sky * share;
        seen.blocked_sky = light_.bounce * sky * share;
        return;
    }
    seen.key = key * seen.surface;
    seen.open_sky = sky * seen.surface;
    seen.blocked_sky = light_.bounce * sky * seen.surface * (0.35f + 0.65f * seen.surface);
    if (towards_key > 0.0f) {
        float highlight = std::max(0.0f, seen.normal.dot((light_.to_key - seen.view).normalized()));
        for (int square = 0; square < 5; ++square) highlight *= highlight;  // (n·h)^32
        seen.key += light_.gloss * highlight;
    }
}

/// Pixels at edges: every camera ray has its own ray to the key light and to the sky.
void Painter::light_every_ray(Packet& packet, const PixelSamples& pattern, std::size_t first) const {
    RayPacket key_rays, sky_rays;
    for (std::size_t i = 0; i < packet.count; ++i) {
        Sight& seen = packet.seen[i];
        if (seen.thing == PixelRecord::nothing) continue;
        const Vec3f sky_direction = above(cosine_direction(seen.normal, pattern.sky(first + i)), seen.true_normal);
        shade(seen);
        sky_rays.set(i, seen.point, sky_direction, 0.0f, far_away);
        if (seen.normal.dot(light_.to_key) > 0.0f)
            key_rays.set(i, seen.point, above(cone_direction(light_.to_key, light_.key_spread, pattern.key(first + i)), seen.true_normal), 0.0f, far_away);
    }
    Lanes<bool> key_blocked, sky_blocked;
    tracer_.blocked(key_rays, key_blocked);
    tracer_.blocked(sky_rays, sky_blocked);
    for (std::size_t i = 0; i < packet.count; ++i) {
        packet.seen[i].key_seen = key_blocked[i] ? 0.0f : 1.0f;
        packet.seen[i].sky_seen = sky_blocked[i] ? 0.0f : 1.0f;
    }
}

/// Pixels inside a surface: one packet holds up to eight rays to the key light and eight to the sky; smoothing over neighbours makes up for the rest.
/// Returns how many of the camera rays it took.
std::size_t Painter::light_some_rays(Packet& packet, const PixelSamples& pattern, std::size_t first) const {
    constexpr std::size_t half = packet_size / 2;
    RayPacket rays;
    const std::size_t count = std::min(half, packet.count);
    float key_tried = 0.0f, key_passed = 0.0f, sky_passed = 0.0f;
    for (std::size_t i = 0; i < count; ++i) {
        Sight& seen = packet.seen[i];
        shade(seen);
        rays.set(half + i, seen.point, above(cosine_direction(seen.normal, pattern.sky(first + i)), seen.true_normal), 0.0f, far_away);
        if (seen.normal.dot(light_.to_key) <= 0.0f) continue;
        rays.set(i, seen.point, above(cone_direction(light_.to_key, light_.key_spread, pattern.key(first + i)), seen.true_normal), 0.0f, far_away);
        key_tried += 1.0f;
    }
    Lanes<bool> blocked;
    tracer_.blocked(rays, blocked);
    for (std::size_t i = 0; i < count; ++i) {
        if (rays.active[i] && !blocked[i]) key_passed += 1.0f;
        if (!blocked[half + i]) sky_passed += 1.0f;
    }
    packet.seen[0].key_seen = key_tried > 0.0f ? key_passed / key_tried : 0.0f;
    packet.seen[0].sky_seen = sky_passed / static_cast<float>(count);
    return count;
}

void Painter::glance(std::uint32_t x, std::uint32_t y, std::span<Sight> seen) const {
    RayPacket rays;
    for (std::size_t i = 0; i < seen.size(); ++i) aim(rays, i, x + static_cast<double>(i) + 0.5, y + 0.5);
    Lanes<Hit> hits;
    tracer_.first_hits(Layer::opaque, rays, hits);
    for (std::size_t i = 0; i < seen.size(); ++i) seen[i] = sight(rays, i, hits[i]);
}

void Painter::light_plain(std::span<const PlainPixel> pixels, std::size_t each, std::uint32_t side) const {
    RayPacket rays;
    for (std::size_t p = 0; p < pixels.size(); ++p) {
        Sight& seen = *pixels[p].seen;
        shade(seen);
        const bool lit = seen.normal.dot(light_.to_key) > 0.0f;
        for (std::size_t i = 0; i < each; ++i) {
            const Point2 sample = shared_point(pixels[p].x, pixels[p].y, side, each, i);
            const std::size_t lane = 2 * each * p + i;
            rays.set(lane + each, seen.point, above(cosine_direction(seen.normal, sample), seen.true_normal), 0.0f, far_away);
            if (lit) rays.set(lane, seen.point, above(cone_direction(light_.to_key, light_.key_spread, sample), seen.true_normal), 0.0f, far_away);
        }
    }
    Lanes<bool> blocked;
    tracer_.blocked(rays, blocked);
    for (std::size_t p = 0; p < pixels.size(); ++p) {
        const Sight& seen = *pixels[p].seen;
        PixelRecord& record = *pixels[p].record;
        record.thing = seen.thing;
        record.normal = seen.normal;
        record.key = seen.key;
        record.open_sky = seen.open_sky;
        record.blocked_sky = seen.blocked_sky;
        record.key_seen = record.sky_seen = 0.0f;
        for (std::size_t i = 0; i < each; ++i) {
            const std::size_t lane = 2 * each * p + i;
            if (rays.active[lane] && !blocked[lane]) record.key_seen += 1.0f / static_cast<float>(each);
            if (!blocked[lane + each]) record.sky_seen += 1.0f / static_cast<float>(each);
        }
    }
}

/// Glass in front of what was seen: layer by layer from the eye, each lets 1 − opacity through.
void Painter::add_glass(Packet& packet) const {
    RayPacket rays = packet.rays;
    for (std::size_t i = 0; i < packet.count; ++i) rays.farthest[i] = packet.seen[i].t;
    Lanes<float> last_edge;
    last_edge.fill(-far_away);
    Lanes<Hit> hits;
    for (int layer = 0; layer < most_glass_layers; ++layer) {
        tracer_.first_hits(Layer::glass, rays, hits);
        bool any = false;
        for (std::size_t i = 0; i < packet.count; ++i) {
            rays.active[i] = hits[i].found;
            if (!hits[i].found) continue;
            any = true;
            rays.nearest[i] = hits[i].t + surface_gap;
            const bool edge = hits[i].part == Part::edges;
            // A ray meets a line where it enters and perhaps where it leaves, and lines meet in corners: one coat of paint is enough.
            if (edge && hits[i].t - last_edge[i] < 8.0f * static_cast<float>(prepared_.line_radius)) continue;
            if (edge) last_edge[i] = hits[i].t;
            const GlassLayer glass = edge ? glass_edge() : glass_face(smooth_normal(prepared_, prepared_.glass[hits[i].instance], hits[i]).dot(rays.along(i)));
            Sight& seen = packet.seen[i];
            seen.veil += seen.through * glass.opacity * as_light(glass.colour);
            seen.through *= 1.0f - glass.opacity;
        }
        if (!any) return;
    }
}

/// One instance (or the ground, or nothing) fills the pixel.
PixelRecord Painter::whole_pixel(Packet& packet, const PixelSamples& pattern, std::size_t first) const {
    PixelRecord record;
    record.thing = packet.seen[0].thing;
    if (record.thing == PixelRecord::nothing) {
        record.open_sky = background_;
    } else {
        const std::size_t lit = light_some_rays(packet, pattern, first);
        const float share = 1.0f / static_cast<float>(lit);
        for (std::size_t i = 0; i < lit; ++i) {
            record.key += share * packet.seen[i].key;
            record.open_sky += share * packet.seen[i].open_sky;
            record.blocked_sky += share * packet.seen[i].blocked_sky;
            record.normal += packet.seen[i].normal;
        }
        record.normal.normalize();
        record.key_seen = packet.seen[0].key_seen;
        record.sky_seen = packet.seen[0].sky_seen;
    }
    if (!tracer_.has_glass()) return record;
    add_glass(packet);
    record.through = 0.0f;
    for (std::size_t i = 0; i < packet.count; ++i) {
        record.veil += packet.seen[i].veil / static_cast<float>(packet.count);
        record.through += packet.seen[i].through / static_cast<float>(packet.count);
    }
    return record;
}

/// Sum of the packet's colours, each ray on its own.
Light Painter::mixed_pixel(Packet& packet, const PixelSamples& pattern, std::size_t first) const {
    light_every_ray(packet, pattern, first);
    if (tracer_.has_glass()) add_glass(packet);
    Light sum = Light::Zero();
    for (std::size_t i = 0; i < packet.count; ++i) {
        const Sight& seen = packet.seen[i];
        const Light behind = seen.thing == PixelRecord::nothing
                                 ? background_
                                 : Light(seen.key_seen * seen.key + seen.sky_seen * seen.open_sky + (1.0f - seen.sky_seen) * seen.blocked_sky);
        sum += (seen.veil + seen.through * behind).min(1.0f);
    }
    return sum;
}

namespace {

PixelRecord mean_of(const PixelRecord& a, float weight_a, const PixelRecord& b, float weight_b) {
    const float share = weight_b / (weight_a + weight_b), rest = 1.0f - share;
    PixelRecord mean = a;
    mean.normal = (rest * a.normal + share * b.normal).normalized();
    mean.key = rest * a.key + share * b.key;
    mean.open_sky = rest * a.open_sky + share * b.open_sky;
    mean.blocked_sky = rest * a.blocked_sky + share * b.blocked_sky;
    mean.key_seen = rest * a.key_seen + share * b.key_seen;
    mean.sky_seen = rest * a.sky_seen + share * b.sky_seen;
    mean.veil = rest * a.veil + share * b.veil;
    mean.through = rest * a.through + share * b.through;
    return mean;
}

}  // namespace

PixelRecord Painter::pixel(std::uint32_t x, std::uint32_t y) const {
    const PixelSamples pattern(std::uint64_t{y} * width_ + x);
    PixelRecord whole;          // mean of the packets, as long as all of them see one and the same thing
    Light sum = Light::Zero();  // of all rays' colours, for the other case
    bool one_thing = true;
    for (std::size_t first = 0; first < samples_; first += packet_size) {
        Packet packet = look(x, y, pattern, first);
        if (!packet.one_thing) {
            one_thing = false;
            sum += mixed_pixel(packet, pattern, first);
            continue;
        }
        const PixelRecord record = whole_pixel(packet, pattern, first);
        one_thing &= first == 0 || record.thing == whole.thing;
        const auto count = static_cast<float>(packet.count);
        sum += count * record.colour(record.key_seen, record.sky_seen).min(1.0f);
        whole = first == 0 ? record : mean_of(whole, static_cast<float>(first), record, count);
    }
    if (one_thing) return whole;
    PixelRecord mixed;
    mixed.thing = PixelRecord::mixed;
    mixed.veil = sum / static_cast<float>(samples_);
    mixed.through = 0.0f;
    return mixed;
}

}  // namespace pelletlab::report::detail
