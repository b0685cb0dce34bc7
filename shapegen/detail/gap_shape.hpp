// How a distance between the two surfaces is charged: f(φ) = w s² |φ/s|ᵖ, with one weight where the union misses the body and another where it pokes out.
#pragma once

#include <cmath>

namespace pelletlab::shapegen::detail {

struct GapShape {
    int power = 2;         ///< p, even; large ones charge only the largest distances
    double scale = 1.0;    ///< s, about the largest distance, so that powers stay near 1
    double missing = 1.0;  ///< w where the union's surface lies inside the body
    double poking = 1.0;   ///< w where it lies outside

    bool plain() const { return power == 2 && missing == 1.0 && poking == 1.0; }
};

struct GapCharge {
    double value = 0.0;       ///< f
    double half_slope = 0.0;  ///< ½ df/dφ
    double half_bend = 0.0;   ///< ½ d²f/dφ²
};

inline GapCharge operator*(double weight, const GapCharge& charge) {
    return {weight * charge.value, weight * charge.half_slope, weight * charge.half_bend};
}

/// `outward` > 0 where the union's surface is outside the body at this point.
inline GapCharge charge(const GapShape& shape, double distance, bool outward) {
    const double weight = outward ? shape.poking : shape.missing;
    if (shape.power == 2) return {weight * distance * distance, weight * distance, weight};
    const double a = distance / shape.scale;
    double rest = 1.0;  // a^(p−2)
    for (int k = 2; k < shape.power; k += 2) rest *= a * a;
    const double p = shape.power;
    return {weight * distance * distance * rest, 0.5 * p * weight * distance * rest, 0.5 * p * (p - 1.0) * weight * rest};
}

}  // namespace pelletlab::shapegen::detail
