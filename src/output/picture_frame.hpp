// What pictures of a plane share: where it lies on the canvas, its ground, walls, scale bar and colour bar.
#pragma once

#include "analysis/snapshot.hpp"
#include "output/canvas.hpp"

#include <string_view>

namespace sandlane::output {

inline constexpr Rgb paper{1, 1, 1}, ink{0.15F, 0.18F, 0.23F};
inline constexpr Rgb wall_grey{0.62F, 0.65F, 0.69F};

// Where a rectangle of the plane lies in the picture. World y points up, pixel y down.
struct View {
    int width = 0, height = 0;
    double unit = 1;  // size of the labels: 1 at 800 pixels
    double scale = 1; // pixels per metre
    double left = 0, top = 0, right = 0, bottom = 0;
    double x_origin = 0, y_origin = 0;

    [[nodiscard]] double px(double x) const { return left + (x - x_origin) * scale; }
    [[nodiscard]] double py(double y) const { return bottom - (y - y_origin) * scale; }
    [[nodiscard]] double baseline() const { return height - 18 * unit; } // of the labels
};

[[nodiscard]] View make_view(Vec lower, Vec upper, int wanted_width);

// Clips to the rectangle and its border, where walls keep their full width.
void clip_to_view(Canvas& canvas, const View& view);
void draw_ground(Canvas& canvas, const View& view);
void draw_disc(Canvas& canvas, double x, double y, double radius, double angle, Rgb colour);
// 2D; triangles are left out.
void draw_wall(Canvas& canvas, const View& view, const analysis::WallShape& wall);
void draw_scale_bar(Canvas& canvas, const View& view);
// Labels the ends of the colour map and the map.
void draw_colour_bar(Canvas& canvas, const View& view, std::string_view low, std::string_view high,
                     std::string_view label);

} // namespace sandlane::output
