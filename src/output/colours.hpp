// Colours of quantities: which number of a grain is shown, its label and unit, and a colour map of even
// perceived steps from dark violet-blue to light yellow.
#pragma once

#include "analysis/snapshot.hpp"
#include "scene/scene.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <vector>

namespace sandlane::output {

struct Rgb {
    float r = 0, g = 0, b = 0; // sRGB, 0 to 1
};

// 256 entries, index 0 for the lowest value.
[[nodiscard]] const std::array<Rgb, 256>& colour_map();
[[nodiscard]] inline Rgb map_colour(double unit) {
    const double clamped = unit > 0 ? (unit < 1 ? unit : 1) : 0;
    return colour_map()[static_cast<std::size_t>(std::lround(clamped * 255))];
}

struct Quantity {
    std::string_view name, unit;
};
[[nodiscard]] Quantity quantity(scene::Colour colour, std::int64_t dimension);

// One value per grain, never negative: speed, contact pressure (tension counts as 0), size of the spin,
// radius. Not a number where the snapshot has none.
[[nodiscard]] std::vector<double> colour_values(const analysis::Snapshot& snapshot, scene::Colour colour);

// 0 if no value is finite and positive.
[[nodiscard]] double largest_finite(const std::vector<double>& values);

// Where a colour scale may end: the value that one grain in a hundred exceeds, or the largest if that is at
// most a quarter above it: a few fast grains must not leave all others dark. 0 if no value is finite and
// positive.
[[nodiscard]] double usual_high(const std::vector<double>& values);

// The smallest of 1, 1.5, 2, 3, 4, 5, 6, 8, 10 times a power of ten that is not below `value` (> 0).
[[nodiscard]] double round_up(double value);

} // namespace sandlane::output
