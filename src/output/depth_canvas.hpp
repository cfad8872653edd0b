// Figures in space on a canvas: the nearest opaque surface of each pixel is known, so that others, drawn in
// any order, pass before or behind it. Coordinates in pixels, y down; z is the height towards the viewer.
#pragma once

#include "core/vec.hpp"
#include "output/canvas.hpp"

#include <array>
#include <limits>
#include <vector>

namespace sandlane::output {

class DepthCanvas {
public:
    explicit DepthCanvas(Canvas& canvas);

    // Opaque and lit. Spheres that do not overlap show correctly if those with the larger z come later.
    void sphere(Vec centre, double radius, Rgb colour);
    // Translucent: `before` is the opacity over a sphere, `opacity` that over the ground.
    void triangle(const std::array<Vec, 3>& corners, Rgb colour, float opacity, float before);
    // Hidden where a sphere is nearer.
    void line(Vec from, Vec to, double width, Rgb colour);

private:
    static constexpr float nothing = -std::numeric_limits<float>::infinity();

    [[nodiscard]] float& nearest(int x, int y) {
        return depth_[static_cast<std::size_t>(y) * static_cast<std::size_t>(canvas_.width()) +
                      static_cast<std::size_t>(x)];
    }

    Canvas& canvas_;
    std::vector<float> depth_; // z of the surface
};

// Light of a surface with this unit normal (to the right, up, towards the viewer): 1 where it is brightest.
[[nodiscard]] double light_on(Vec normal);

} // namespace sandlane::output
