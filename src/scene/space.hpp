// What depends on the dimension of a scene, 2 or 3: the axes, areas and volumes, points at random, and how
// vectors are written.
#pragma once

#include "core/rng.hpp"
#include "core/vec.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <numbers>
#include <span>
#include <string>
#include <string_view>

namespace sandlane::scene {

struct AxisOfSpace {
    const char* name;
    double Vec::*component;
    std::size_t index;
};

inline constexpr std::array<AxisOfSpace, 3> space_axes = {
    {{"x", &Vec::x, 0}, {"y", &Vec::y, 1}, {"z", &Vec::z, 2}}};

[[nodiscard]] inline std::span<const AxisOfSpace> axes(std::int64_t dimension) {
    return {space_axes.data(), static_cast<std::size_t>(dimension)};
}

// Area or volume of a rectangle or box [m^2, m^3].
[[nodiscard]] constexpr double content(Vec size, std::int64_t dimension) {
    const double area = size.x * size.y;
    return dimension == 3 ? area * size.z : area;
}

// Area of a disc or volume of a sphere [m^2, m^3].
[[nodiscard]] constexpr double grain_content(double radius, std::int64_t dimension) {
    const double disc = std::numbers::pi * radius * radius;
    return dimension == 3 ? 4.0 / 3.0 * radius * disc : disc;
}

// Uniform in the unit square or cube; the coordinates of the plane are the same in both.
[[nodiscard]] inline Vec uniform_point(const Random& random, std::uint64_t index, std::int64_t dimension) {
    if (dimension == 3) {
        const auto [x, y, z] = random.uniform3(index);
        return {x, y, z};
    }
    const auto [x, y] = random.uniform2(index);
    return {x, y, 0};
}

// Uniform in [-amount, amount) along each axis.
[[nodiscard]] inline Vec uniform_shift(const Random& random, std::uint64_t index, double amount,
                                       std::int64_t dimension) {
    Vec shift;
    const Vec u = uniform_point(random, index, dimension);
    for (const AxisOfSpace& axis : axes(dimension))
        shift.*axis.component = amount * (2 * u.*axis.component - 1);
    return shift;
}

// Of independent standard normal deviates.
[[nodiscard]] inline Vec normal_vector(const Random& random, std::uint64_t index, std::int64_t dimension) {
    if (dimension == 3) {
        const auto [x, y, z] = random.normal3(index);
        return {x, y, z};
    }
    const auto [x, y] = random.normal2(index);
    return {x, y, 0};
}

// Component by component.
[[nodiscard]] constexpr Vec scaled(Vec factors, Vec v) {
    return {factors.x * v.x, factors.y * v.y, factors.z * v.z};
}

// For messages: "1, 2.5" or "1, 2.5, 0".
[[nodiscard]] inline std::string components(Vec v, std::int64_t dimension,
                                            std::string_view separator = ", ") {
    std::string text = fmt::format("{}{}{}", v.x, separator, v.y);
    return dimension == 3 ? fmt::format("{}{}{}", text, separator, v.z) : text;
}

// For messages: "1 x 2.5" or "1 x 2.5 x 0".
[[nodiscard]] inline std::string extents(Vec size, std::int64_t dimension) {
    return components(size, dimension, " x ");
}

} // namespace sandlane::scene
