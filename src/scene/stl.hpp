// Triangles from an STL file, binary or text.
#pragma once

#include "core/vec.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace sandlane::scene {

struct TriangleMesh {
    std::vector<Vec> points;
    std::vector<std::array<std::uint32_t, 3>> triangles; // corners, indices of points
};

// Corners with equal coordinates are one point; triangles without area are left out. Throws
// Error(invalid_input) naming the file and the line or the triangle.
[[nodiscard]] TriangleMesh parse_stl(std::string_view content, const std::string& file);

} // namespace sandlane::scene
