#include "shapegen/detail/union_boundary.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/parallel.hpp"

namespace pelletlab::shapegen::detail {

namespace {

constexpr double pi = std::numbers::pi;
constexpr double same_circle = 1e-12;  // [rad], caps closer than this are one cap

double angle_between(const Vec3& a, const Vec3& b) {
    return 2.0 * std::asin(std::min(1.0, 0.5 * (a - b).norm()));
}

double opening(const Cap& cap) {
    return std::atan2(cap.sine, cap.cosine);
}

struct Interval {
    double begin, end;
};

// Caps of sphere `index`, without those inside another cap. Returns false when the sphere is covered entirely.
bool collect_caps(std::span<const Sphere> spheres, std::uint32_t index, std::span<const std::uint32_t> neighbours, std::vector<Cap>& caps) {
    const Sphere& self = spheres[index];
    std::vector<Cap> all;
    all.reserve(neighbours.size());
    for (const std::uint32_t j : neighbours) {
        const Sphere& other = spheres[j];
        const Vec3 offset = other.centre - self.centre;
        const double distance = offset.norm();
        if (distance == 0.0) {
            if (other.radius > self.radius || (other.radius == self.radius && j < index)) return false;
            continue;
        }
        Cap cap;
        cap.neighbour = j;
        cap.cosine = (distance * distance + (self.radius - other.radius) * (self.radius + other.radius)) / (2.0 * distance * self.radius);
        if (cap.cosine >= 1.0) continue;       // the other one does not reach this surface
        if (cap.cosine <= -1.0) return false;  // this sphere lies inside the other one
        cap.axis = offset / distance;
        cap.sine = std::sqrt((1.0 - cap.cosine) * (1.0 + cap.cosine));
        all.push_back(cap);
    }
    std::sort(all.begin(), all.end(), [](const Cap& a, const Cap& b) { return a.cosine != b.cosine ? a.cosine < b.cosine : a.neighbour < b.neighbour; });
    for (const Cap& cap : all) {
        bool inside_another = false;
        for (const Cap& kept : caps) {
            // Both tests first by cosines, which are cheap, and by angles, which are sharp, only where it is close.
            const double between = cap.axis.dot(kept.axis), both = cap.cosine * kept.cosine, sines = cap.sine * kept.sine;
            if (between > both + sines - 1e-6 && angle_between(cap.axis, kept.axis) + opening(cap) <= opening(kept) + same_circle) {
                inside_another = true;
                break;
            }
            if (cap.cosine + kept.cosine < 1e-6 && between < both - sines + 1e-6 &&
                2.0 * pi - angle_between(cap.axis, kept.axis) - opening(cap) <= opening(kept) + same_circle) {
                return false;  // the two of them cover everything
            }
        }
        if (!inside_another) caps.push_back(cap);
    }
    return true;
}

// Angles of the circle of `cap` inside the cap `other`, as up to two intervals in [0, 2π]; returns false when all of it is.
bool add_covered(const ExposedArc& circle, const Cap& cap, const Cap& other, std::vector<Interval>& covered) {
    const double a = cap.sine * circle.u.dot(other.axis);
    const double b = cap.sine * circle.v.dot(other.axis);
    const double level = other.cosine - cap.cosine * cap.axis.dot(other.axis);
    const double squared = a * a + b * b;
    if (level * level >= squared) return level >= 0.0;
    const double amplitude = std::sqrt(squared);
    const double middle = std::atan2(b, a);
    const double half = std::acos(level / amplitude);
    double begin = middle - half, end = middle + half;
    if (begin < 0.0) {
        begin += 2.0 * pi;
        end += 2.0 * pi;
    }
    if (end <= 2.0 * pi) {
        covered.push_back({begin, end});
    } else {
        covered.push_back({begin, 2.0 * pi});
        covered.push_back({0.0, end - 2.0 * pi});
    }
    return true;
}

// The exposed pieces of one cap's circle.
void add_arcs(const std::vector<Cap>& caps, std::size_t which, std::uint32_t index, std::vector<Interval>& covered, std::vector<ExposedArc>& arcs) {
    const Cap& cap = caps[which];
    ExposedArc arc;
    arc.sphere = index;
    arc.neighbour = cap.neighbour;
    arc.axis = cap.axis;
    arc.u = cap.axis.unitOrthogonal();
    arc.v = cap.axis.cross(arc.u);
    arc.cos_opening = cap.cosine;
    arc.sin_opening = cap.sine;
    covered.clear();
    for (std::size_t k = 0; k < caps.size(); ++k) {
        if (k != which && !add_covered(arc, cap, caps[k], covered)) return;
    }
    if (covered.empty()) {
        arc.begin = 0.0;
        arc.end = 2.0 * pi;
        arc.full_circle = true;
        arcs.push_back(arc);
        return;
    }
    std::sort(covered.begin(), covered.end(), [](const Interval& a, const Interval& b) { return a.begin < b.begin; });
    // Walk the gaps; the one across t = 0 is made of the last and the first piece.
    const double first_begin = covered.front().begin;
    double reach = covered.front().end;
    for (const Interval& interval : covered) {
        if (interval.begin > reach) {
            arc.begin = reach;
            arc.end = interval.begin;
            arcs.push_back(arc);
        }
        reach = std::max(reach, interval.end);
    }
    if (first_begin + 2.0 * pi > reach) {
        arc.begin = reach;
        arc.end = first_begin + 2.0 * pi;
        arcs.push_back(arc);
    }
}

Vec3 arc_point(const ExposedArc& arc, double t) {
    return arc.cos_opening * arc.axis + arc.sin_opening * (arc.u * std::cos(t) + arc.v * std::sin(t));
}

// Signed area of the spherical triangle (a, b, c), modulo 4π (Van Oosterom & Strackee 1983).
double triangle_area(const Vec3& a, const Vec3& b, const Vec3& c) {
    return 2.0 * std::atan2(a.dot(b.cross(c)), 1.0 + a.dot(b) + b.dot(c) + c.dot(a));
}

// Area swept by the ray from `pole` along the arc in the direction of growing t, modulo 4π.
double fan_area(const ExposedArc& arc, const Vec3& pole) {
    const double turn = arc.end - arc.begin;
    const double sector = (1.0 - arc.cos_opening) * turn;
    if (arc.full_circle) return sector;
    const double triangle = 2.0 * std::atan2((1.0 - arc.cos_opening) * std::sin(turn), (1.0 + arc.cos_opening) + (1.0 - arc.cos_opening) * std::cos(turn));
    return sector - triangle + triangle_area(pole, arc_point(arc, arc.begin), arc_point(arc, arc.end));
}

// A pole whose antipode, where the fan is singular, keeps away from all arc ends.
Vec3 choose_pole(const std::vector<ExposedArc>& arcs) {
    static const std::array<Vec3, 4> candidates = {Vec3(0.4819, -0.3517, 0.8026).normalized(), Vec3(-0.7431, 0.2213, 0.6315).normalized(),
                                                   Vec3(0.1273, 0.9418, -0.3111).normalized(), Vec3(-0.3343, -0.6021, -0.7251).normalized()};
    Vec3 best = candidates[0];
    double best_clearance = -1.0;
    for (const Vec3& candidate : candidates) {
        double clearance = 2.0;
        for (const ExposedArc& arc : arcs) {
            if (arc.full_circle) continue;
            clearance = std::min({clearance, 1.0 + candidate.dot(arc_point(arc, arc.begin)), 1.0 + candidate.dot(arc_point(arc, arc.end))});
        }
        if (clearance > best_clearance) {
            best_clearance = clearance;
            best = candidate;
        }
    }
    return best;
}

double exposed_solid_angle(const std::vector<ExposedArc>& arcs, const std::vector<Cap>& caps) {
    const Vec3 pole = choose_pole(arcs);
    double area = 0.0;
    for (const ExposedArc& arc : arcs) area -= fan_area(arc, pole);  // the exposed side lies to the right of growing t
    area -= 4.0 * pi * std::floor(area / (4.0 * pi));
    // Modulo 4π a sphere that shows a hair and one that hides a hair look alike: the caps know.
    double capped = 0.0;
    for (const Cap& cap : caps) capped += 2.0 * pi * (1.0 - cap.cosine);
    if (area > 4.0 * pi - 1e-6 && capped > 2.0 * pi) return 0.0;
    if (area < 1e-6 && capped < 2.0 * pi) area += 4.0 * pi;
    return area;
}

// ∮ ν ds along one arc of the unit sphere.
Vec3 conormal_integral(const ExposedArc& arc) {
    const double c = arc.cos_opening, s = arc.sin_opening;
    const double cosines = std::sin(arc.end) - std::sin(arc.begin), sines = std::cos(arc.begin) - std::cos(arc.end);
    return s * (s * (arc.end - arc.begin) * arc.axis - c * (cosines * arc.u + sines * arc.v));
}

// Integrals over the arc's angle of products of cos t and sin t.
struct ArcPowers {
    double one, c, s, cc, cs, ss, ccc, ccs, css, sss;
};

ArcPowers arc_powers(double begin, double end) {
    const double c0 = std::cos(begin), s0 = std::sin(begin), c1 = std::cos(end), s1 = std::sin(end);
    ArcPowers p{};
    p.one = end - begin;
    p.c = s1 - s0;
    p.s = c0 - c1;
    p.cs = 0.5 * (s1 * s1 - s0 * s0);
    const double half_double = 0.5 * (s1 * c1 - s0 * c0);
    p.cc = 0.5 * p.one + half_double;
    p.ss = 0.5 * p.one - half_double;
    p.css = (s1 * s1 * s1 - s0 * s0 * s0) / 3.0;
    p.ccs = (c0 * c0 * c0 - c1 * c1 * c1) / 3.0;
    p.ccc = p.c - p.css;
    p.sss = p.s - p.ccs;
    return p;
}

// ∮ ν nᵀ ds and ∮ n nᵀ (ν·w) ds along one arc.
void add_second_integrals(const ExposedArc& arc, const Vec3& w, Mat3& conormal_normal, Mat3& weighted) {
    const ArcPowers p = arc_powers(arc.begin, arc.end);
    const double c = arc.cos_opening, s = arc.sin_opening;
    Mat3 frame;
    frame << arc.axis, arc.u, arc.v;
    // Local components: n = (c, s cos t, s sin t), ν = (s, −c cos t, −c sin t), ds = s dt.
    Mat3 local;
    local << s * c * p.one, s * s * p.c, s * s * p.s,  //
        -c * c * p.c, -c * s * p.cc, -c * s * p.cs,    //
        -c * c * p.s, -c * s * p.cs, -c * s * p.ss;
    conormal_normal += s * frame * local * frame.transpose();
    const Vec3 wl = frame.transpose() * w;
    const double k0 = s * wl[0], kc = -c * wl[1], ks = -c * wl[2];  // ν·w = k0 + kc cos t + ks sin t
    Mat3 q;
    q(0, 0) = c * c * (k0 * p.one + kc * p.c + ks * p.s);
    q(0, 1) = q(1, 0) = c * s * (k0 * p.c + kc * p.cc + ks * p.cs);
    q(0, 2) = q(2, 0) = c * s * (k0 * p.s + kc * p.cs + ks * p.ss);
    q(1, 1) = s * s * (k0 * p.cc + kc * p.ccc + ks * p.ccs);
    q(1, 2) = q(2, 1) = s * s * (k0 * p.cs + kc * p.ccs + ks * p.css);
    q(2, 2) = s * s * (k0 * p.ss + kc * p.css + ks * p.sss);
    weighted += s * frame * q * frame.transpose();
}

}  // namespace

ExposedPart exposed_part(std::span<const Sphere> spheres, std::uint32_t index, std::span<const std::uint32_t> neighbours) {
    ExposedPart part;
    std::vector<Cap> caps;
    if (spheres[index].radius <= 0.0 || !collect_caps(spheres, index, neighbours, caps)) return part;
    if (caps.empty()) {
        part.solid_angle = 4.0 * pi;
        return part;
    }
    std::vector<Interval> covered;
    for (std::size_t k = 0; k < caps.size(); ++k) add_arcs(caps, k, index, covered, part.arcs);
    if (part.arcs.empty()) return part;
    part.solid_angle = exposed_solid_angle(part.arcs, caps);
    for (const ExposedArc& arc : part.arcs) part.normal_integral -= 0.5 * conormal_integral(arc);
    part.caps = std::move(caps);
    return part;
}

std::vector<std::vector<std::uint32_t>> overlapping_neighbours(std::span<const Sphere> spheres) {
    std::vector<std::vector<std::uint32_t>> neighbours(spheres.size());
    parallel_for(spheres.size(), 64, [&](std::size_t i) {
        for (std::size_t j = 0; j < spheres.size(); ++j) {
            const double reach = spheres[i].radius + spheres[j].radius;
            if (j != i && (spheres[i].centre - spheres[j].centre).squaredNorm() < reach * reach) neighbours[i].push_back(static_cast<std::uint32_t>(j));
        }
    });
    return neighbours;
}

std::vector<ExposedPart> union_boundary(std::span<const Sphere> spheres) {
    const auto neighbours = overlapping_neighbours(spheres);
    std::vector<ExposedPart> boundary(spheres.size());
    parallel_for(spheres.size(), 16, [&](std::size_t i) { boundary[i] = exposed_part(spheres, static_cast<std::uint32_t>(i), neighbours[i]); });
    return boundary;
}

UnionMoments union_moments(std::span<const Sphere> spheres, std::span<const ExposedPart> boundary, const Vec3& origin) {
    UnionMoments total;
    for (std::size_t i = 0; i < spheres.size(); ++i) {
        const ExposedPart& part = boundary[i];
        if (part.solid_angle == 0.0) continue;
        const Vec3 c = spheres[i].centre - origin;
        const double r = spheres[i].radius, area = part.solid_angle;
        const Vec3& m = part.normal_integral;
        Mat3 conormal_normal = Mat3::Zero(), weighted = Mat3::Zero();
        for (const ExposedArc& arc : part.arcs) add_second_integrals(arc, c, conormal_normal, weighted);
        Mat3 second = (area * Mat3::Identity() - conormal_normal) / 3.0;  // ∫ n nᵀ dA
        second = (0.5 * (second + second.transpose())).eval();
        const Mat3 third = (c * m.transpose() + m * c.transpose() - weighted) / 4.0;  // ∫ n nᵀ (n·c) dA
        const Vec3 sc = second * c;
        // x = c + r n; V = ⅓∮ x·n, ∫x = ¼∮ x (x·n), ∫x xᵀ = ⅕∮ x xᵀ (x·n), all with dA = r² dω and x·n = c·n + r.
        total.volume += r * r / 3.0 * (c.dot(m) + r * area);
        total.first += r * r / 4.0 * (c * (c.dot(m) + r * area) + r * (sc + r * m));
        total.second += r * r / 5.0 *
                        (c * c.transpose() * (c.dot(m) + r * area) + r * (c * sc.transpose() + sc * c.transpose()) +
                         r * r * (c * m.transpose() + m * c.transpose()) + r * r * third + r * r * r * second);
    }
    return total;
}

}  // namespace pelletlab::shapegen::detail
