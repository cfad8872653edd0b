// What figures on a raster share: colours that mix, edges that cover a part of a pixel, pixels in reach.
#pragma once

#include "output/colours.hpp"

#include <algorithm>
#include <cmath>

namespace sandlane::output {

[[nodiscard]] inline Rgb mix(Rgb a, Rgb b, float t) {
    return {a.r + (b.r - a.r) * t, a.g + (b.g - a.g) * t, a.b + (b.b - a.b) * t};
}

// Share of a pixel inside an edge whose signed distance from the pixel's centre is `inside`.
[[nodiscard]] inline float coverage(double inside) {
    return static_cast<float>(std::clamp(inside + 0.5, 0.0, 1.0));
}

// First and last pixel, inside [low, high), that a figure between `from` and `to` can touch.
struct PixelRange {
    int first, last; // exclusive
};
[[nodiscard]] inline PixelRange pixels_between(double from, double to, int low, int high) {
    if (!(from <= to)) return {low, low}; // also for what is not a number
    const double first = std::clamp(std::floor(from), static_cast<double>(low), static_cast<double>(high));
    const double last = std::clamp(std::ceil(to), static_cast<double>(low), static_cast<double>(high));
    return {static_cast<int>(first), static_cast<int>(last)};
}

} // namespace sandlane::output
