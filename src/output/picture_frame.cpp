#include "output/picture_frame.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sandlane::output {

using analysis::WallShape;

namespace {

constexpr Rgb ground{0.965F, 0.969F, 0.976F}, frame{0.80F, 0.82F, 0.85F};
constexpr Rgb wall_ink{0.19F, 0.22F, 0.28F};
constexpr double tallest = 1.5; // height of the domain's image in units of the picture's width, at most

Rgb darker(Rgb c) {
    return {0.62F * c.r, 0.62F * c.g, 0.62F * c.b};
}

bool is_light(Rgb c) {
    return 0.3F * c.r + 0.59F * c.g + 0.11F * c.b > 0.5F;
}

std::string label(double value, std::string_view unit) {
    return fmt::format("{:.4g} {}", value, unit);
}

std::string length_label(double metres) {
    if (metres >= 1000) return label(metres / 1000, "km");
    if (metres >= 1) return label(metres, "m");
    if (metres >= 0.01) return label(metres * 100, "cm");
    if (metres >= 0.001) return label(metres * 1000, "mm");
    return label(metres * 1e6, "um");
}

} // namespace

View make_view(Vec lower, Vec upper, int wanted_width) {
    View v;
    v.width = std::max(wanted_width, 64) / 2 * 2; // even, as the usual video formats want
    v.unit = std::clamp(v.width / 800.0, 0.25, 4.0);
    const double margin = 16 * v.unit, footer = 64 * v.unit;
    const double wide = upper.x > lower.x ? upper.x - lower.x : 1;
    const double high = upper.y > lower.y ? upper.y - lower.y : 1;
    v.scale = std::min((v.width - 2 * margin) / wide, tallest * v.width / high);
    v.left = v.width / 2.0 - wide * v.scale / 2;
    v.right = v.left + wide * v.scale;
    v.top = margin;
    v.bottom = margin + std::max(high * v.scale, 8.0);
    v.height = static_cast<int>(std::ceil((v.bottom + footer) / 2)) * 2;
    v.x_origin = lower.x;
    v.y_origin = lower.y;
    return v;
}

void clip_to_view(Canvas& canvas, const View& v) {
    const double overhang = 6 * v.unit;
    canvas.clip(static_cast<int>(v.left - overhang), static_cast<int>(v.top - overhang),
                static_cast<int>(v.right + overhang), static_cast<int>(v.bottom + overhang));
}

void draw_ground(Canvas& canvas, const View& v) {
    const double line = 1;
    canvas.rectangle(v.left - line, v.top - line, v.right + line, v.bottom + line, frame);
    canvas.rectangle(v.left, v.top, v.right, v.bottom, ground);
}

void draw_disc(Canvas& canvas, double x, double y, double radius, double angle, Rgb colour) {
    const double rim = std::clamp(0.12 * radius - 0.2, 0.0, 1.6);
    canvas.disc(x, y, radius, colour, darker(colour), rim);
    if (radius < 6) return;
    const Rgb tick = is_light(colour) ? ink : paper;
    canvas.stroke(x + 0.3 * radius * std::cos(angle), y - 0.3 * radius * std::sin(angle),
                  x + 0.78 * radius * std::cos(angle), y - 0.78 * radius * std::sin(angle),
                  std::clamp(0.09 * radius, 1.0, 3.0), tick, 0.75F);
}

void draw_wall(Canvas& canvas, const View& v, const WallShape& wall) {
    const double width = 3 * v.unit;
    switch (wall.kind) {
    case WallShape::Kind::segment:
        canvas.stroke(v.px(wall.a.x), v.py(wall.a.y), v.px(wall.b.x), v.py(wall.b.y), width, wall_ink);
        break;
    case WallShape::Kind::arc: {
        double to = wall.angle_to;
        while (to < wall.angle_from) to += 2 * std::numbers::pi;
        canvas.arc(v.px(wall.centre.x), v.py(wall.centre.y), wall.radius * v.scale, -to, -wall.angle_from,
                   width, wall_ink);
        break;
    }
    case WallShape::Kind::disc:
        draw_disc(canvas, v.px(wall.centre.x), v.py(wall.centre.y), wall.radius * v.scale, wall.angle,
                  wall_grey);
        break;
    case WallShape::Kind::triangle:
        break;
    }
}

// The longest of 1, 2, 5 times a power of ten that takes at most a quarter of the width.
void draw_scale_bar(Canvas& canvas, const View& v) {
    const double baseline = v.baseline();
    const double room = 0.22 * v.width / v.scale;
    const double power = std::pow(10, std::floor(std::log10(room)));
    const double length = room >= 5 * power ? 5 * power : room >= 2 * power ? 2 * power : power;
    const double x0 = 17 * v.unit, x1 = x0 + length * v.scale, y = baseline - 21 * v.unit;
    canvas.stroke(x0, y, x1, y, 2 * v.unit, ink);
    for (const double x : {x0, x1}) canvas.stroke(x, y - 4 * v.unit, x, y + 4 * v.unit, 2 * v.unit, ink);
    canvas.text(x0, baseline, 10 * v.unit, length_label(length), ink);
}

void draw_colour_bar(Canvas& canvas, const View& v, std::string_view low, std::string_view high,
                     std::string_view name) {
    const double x1 = v.width - 17 * v.unit, x0 = x1 - 0.30 * v.width;
    const double top = v.baseline() - 27 * v.unit, bottom = top + 10 * v.unit;
    const int columns = static_cast<int>(std::ceil(x1 - x0));
    for (int k = 0; k < columns; ++k)
        canvas.rectangle(x0 + k, top, std::min(x0 + k + 1, x1), bottom, map_colour((k + 0.5) / columns));
    const double size = 10 * v.unit;
    canvas.text(x0, v.baseline(), size, low, ink);
    canvas.text((x0 + x1) / 2, v.baseline(), size, name, ink, Canvas::Anchor::middle);
    canvas.text(x1, v.baseline(), size, high, ink, Canvas::Anchor::end);
}

} // namespace sandlane::output
