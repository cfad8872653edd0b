// Classes of grains of about the same radius: what finds pairs keeps a grid of cells for each, so that small
// grains are not looked for in cells made for large ones (docs/physics.md 9).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace sandlane::scene {

struct SizeClass {
    double largest = 0; // m, radius
    std::size_t grains = 0;
};

// Radii that differ by less are one class.
inline constexpr double wide_ratio = 2;
// One grid is as fast as several where a cell as wide as the largest grains holds so many grains per class,
// or fewer.
inline constexpr double grains_per_class = 5;

// From the smallest radii up, each within a factor of two; empty ones left out. radius(i) of `count` grains.
template <class Radius> std::vector<SizeClass> size_classes(std::size_t count, const Radius& radius) {
    double smallest = std::numeric_limits<double>::infinity(), largest = 0;
    for (std::size_t i = 0; i < count; ++i) {
        smallest = std::min(smallest, radius(i));
        largest = std::max(largest, radius(i));
    }
    if (count == 0) return {};
    if (!(largest > wide_ratio * smallest)) return {{largest, count}};
    std::vector<SizeClass> classes;
    for (std::size_t i = 0; i < count; ++i) {
        const auto octave = static_cast<std::size_t>(std::max(0, std::ilogb(radius(i) / smallest)));
        if (octave >= classes.size()) classes.resize(octave + 1);
        classes[octave].largest = std::max(classes[octave].largest, radius(i));
        ++classes[octave].grains;
    }
    std::erase_if(classes, [](const SizeClass& c) { return c.grains == 0; });
    return classes;
}

[[nodiscard]] inline std::size_t class_of(const std::vector<SizeClass>& classes, double radius) {
    std::size_t c = 0;
    while (c + 1 < classes.size() && radius > classes[c].largest) ++c;
    return c;
}

} // namespace sandlane::scene
