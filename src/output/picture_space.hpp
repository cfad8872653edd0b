// Spheres and their walls on a canvas.
#pragma once

#include "output/camera.hpp"
#include "output/picture_frame.hpp"

#include <vector>

namespace sandlane::output {

// Holds the domain; world x and y are those of the camera.
[[nodiscard]] View make_space_view(const analysis::Snapshot& snapshot, const Camera& camera,
                                   int wanted_width);

// One colour per grain. Walls are translucent, wherever they stand, with their edges and outlines drawn.
void draw_space(Canvas& canvas, const View& view, const analysis::Snapshot& snapshot, const Camera& camera,
                const std::vector<Rgb>& colours);

} // namespace sandlane::output
