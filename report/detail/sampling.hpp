// Sample points of a pixel: an even (low-discrepancy) pattern, shifted by random numbers that depend on the pixel alone, or shared out among neighbours.
#pragma once

#include <array>
#include <cmath>
#include <numbers>

#include "core/random.hpp"
#include "report/detail/prepared_scene.hpp"

namespace pelletlab::report::detail {

using Point2 = std::array<double, 2>;

/// n-th point of Roberts' R2 sequence on the unit square (M. Roberts 2018, "The unreasonable effectiveness of quasirandom sequences"), shifted.
inline Point2 even_point(std::size_t n, const Point2& shift) {
    constexpr double a1 = 0.7548776662466927, a2 = 0.5698402909980532;  // 1/g and 1/g², g³ = g + 1
    const double x = shift[0] + static_cast<double>(n) * a1, y = shift[1] + static_cast<double>(n) * a2;
    return {x - std::floor(x), y - std::floor(y)};
}

/// Sample i of the `each` that a pixel takes when every square of side × side pixels is to hold one even set: the mean over such a square, wherever it lies, is
/// that of side² · each even points, so it shows no noise from pixel to pixel.
inline Point2 shared_point(std::uint32_t x, std::uint32_t y, std::uint32_t side, std::size_t each, std::size_t i) {
    return even_point((std::size_t{y % side} * side + x % side) * each + i, {0.5, 0.5});
}

/// Three patterns on the unit square for one pixel: where rays start, where the key light is met, where the sky is met. Each is
/// even_point() with a random shift (Cranley & Patterson 1976; key cranley1976).
class PixelSamples {
public:
    explicit PixelSamples(std::uint64_t pixel) {
        RandomStream random(0x70656c6c65746c61u, pixel);
        for (Point2& shift : shifts_) shift = {random.uniform(), random.uniform()};
    }
    Point2 film(std::size_t i) const { return point(0, i); }
    Point2 key(std::size_t i) const { return point(1, i); }
    Point2 sky(std::size_t i) const { return point(2, i); }

private:
    Point2 point(std::size_t pattern, std::size_t i) const {
        // Another order of the same sixteen points for each pattern: where a ray starts must not decide where its light comes from.
        constexpr std::array<std::size_t, 3> stride = {1, 7, 11};
        return even_point((i & ~std::size_t{15}) + ((i & 15) * stride[pattern] & 15), shifts_[pattern]);
    }
    std::array<Point2, 3> shifts_;
};

/// Two unit vectors that make a right-handed frame with the unit vector n (Duff et al. 2017; key duff2017).
inline std::array<Vec3f, 2> tangents(const Vec3f& n) {
    const float sign = std::copysign(1.0f, n.z());
    const float a = -1.0f / (sign + n.z()), b = n.x() * n.y() * a;
    return {Vec3f(1.0f + sign * n.x() * n.x() * a, sign * b, -sign * n.x()), Vec3f(b, sign + n.y() * n.y() * a, -n.y())};
}

/// Direction of the hemisphere round n with density cos/π.
inline Vec3f cosine_direction(const Vec3f& n, const Point2& sample) {
    const auto square = static_cast<float>(sample[0]), angle = static_cast<float>(2.0 * std::numbers::pi * sample[1]);
    const float radius = std::sqrt(square);
    const auto [s, t] = tangents(n);
    return (radius * std::cos(angle) * s + radius * std::sin(angle) * t + std::sqrt(1.0f - square) * n).normalized();
}

/// Even direction within a cone round n whose half angle has this tangent (small angles).
inline Vec3f cone_direction(const Vec3f& n, float tangent, const Point2& sample) {
    const float radius = tangent * std::sqrt(static_cast<float>(sample[0]));
    const auto angle = static_cast<float>(2.0 * std::numbers::pi * sample[1]);
    const auto [s, t] = tangents(n);
    return (n + radius * std::cos(angle) * s + radius * std::sin(angle) * t).normalized();
}

/// The direction, mirrored to the outer side of a surface with that true normal: a smooth normal may send rays into its own facet.
inline Vec3f above(const Vec3f& direction, const Vec3f& true_normal) {
    const float height = direction.dot(true_normal);
    return height < 0.0f ? Vec3f(direction - 2.0f * height * true_normal) : direction;
}

}  // namespace pelletlab::report::detail
