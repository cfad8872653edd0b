#include "output/picture.hpp"

#include "core/file.hpp"
#include "output/canvas.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sandlane::output {

namespace {

using analysis::Snapshot;
using analysis::WallShape;

constexpr Rgb paper{1, 1, 1}, ground{0.965F, 0.969F, 0.976F}, frame{0.80F, 0.82F, 0.85F};
constexpr Rgb ink{0.15F, 0.18F, 0.23F}, wall_ink{0.19F, 0.22F, 0.28F}, wall_grey{0.62F, 0.65F, 0.69F};
constexpr double tallest = 1.5; // height of the domain's image in units of the picture's width, at most

// Where the domain lies in the picture. World y points up, pixel y down.
struct View {
    int width = 0, height = 0;
    double unit = 1;  // size of the labels: 1 at 800 pixels
    double scale = 1; // pixels per metre
    double left = 0, top = 0, right = 0, bottom = 0;
    double x_origin = 0, y_origin = 0;

    [[nodiscard]] double px(double x) const { return left + (x - x_origin) * scale; }
    [[nodiscard]] double py(double y) const { return bottom - (y - y_origin) * scale; }
};

View make_view(const Snapshot& s, int wanted_width) {
    View v;
    v.width = std::max(wanted_width, 64) / 2 * 2; // even, as the usual video formats want
    v.unit = std::clamp(v.width / 800.0, 0.25, 4.0);
    const double margin = 16 * v.unit, footer = 64 * v.unit;
    const double wide = s.upper.x > s.lower.x ? s.upper.x - s.lower.x : 1;
    const double high = s.upper.y > s.lower.y ? s.upper.y - s.lower.y : 1;
    v.scale = std::min((v.width - 2 * margin) / wide, tallest * v.width / high);
    v.left = v.width / 2.0 - wide * v.scale / 2;
    v.right = v.left + wide * v.scale;
    v.top = margin;
    v.bottom = margin + std::max(high * v.scale, 8.0);
    v.height = static_cast<int>(std::ceil((v.bottom + footer) / 2)) * 2;
    v.x_origin = s.lower.x;
    v.y_origin = s.lower.y;
    return v;
}

struct ColourScale {
    double low = 0, high = 1;
    [[nodiscard]] Rgb of(double value) const { return map_colour((value - low) / (high - low)); }
};

ColourScale make_scale(const std::vector<double>& values, const PictureStyle& style) {
    ColourScale scale;
    const double largest = largest_finite(values);
    const double smallest = values.empty() ? 0 : *std::min_element(values.begin(), values.end());
    scale.high = style.scale_max > 0 ? style.scale_max : largest > 0 ? round_up(largest) : 1;
    const bool from_smallest = style.colour == scene::Colour::radius && smallest < 0.999 * largest;
    if (from_smallest && style.scale_max <= 0) scale.high = largest;
    scale.low = from_smallest && smallest < scale.high ? smallest : 0;
    return scale;
}

Rgb darker(Rgb c) {
    return {0.62F * c.r, 0.62F * c.g, 0.62F * c.b};
}

bool is_light(Rgb c) {
    return 0.3F * c.r + 0.59F * c.g + 0.11F * c.b > 0.5F;
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

// A grain that crosses a periodic face is drawn on both sides.
void draw_grain(Canvas& canvas, const View& v, const Snapshot& s, std::size_t i, Rgb colour) {
    const double x = v.px(s.x[i]), y = v.py(s.y[i]), r = s.radius[i] * v.scale;
    const double wide = v.right - v.left, high = v.bottom - v.top;
    const int from_x = s.periodic_x && x + r > v.right ? -1 : 0,
              to_x = s.periodic_x && x - r < v.left ? 1 : 0;
    const int from_y = s.periodic_y && y + r > v.bottom ? -1 : 0,
              to_y = s.periodic_y && y - r < v.top ? 1 : 0;
    for (int ky = from_y; ky <= to_y; ++ky)
        for (int kx = from_x; kx <= to_x; ++kx)
            draw_disc(canvas, x + kx * wide, y + ky * high, r, s.angle[i], colour);
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
    }
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

// The longest of 1, 2, 5 times a power of ten that takes at most a quarter of the width.
void draw_scale_bar(Canvas& canvas, const View& v, double baseline) {
    const double room = 0.22 * v.width / v.scale;
    const double power = std::pow(10, std::floor(std::log10(room)));
    const double length = room >= 5 * power ? 5 * power : room >= 2 * power ? 2 * power : power;
    const double x0 = 17 * v.unit, x1 = x0 + length * v.scale, y = baseline - 21 * v.unit;
    canvas.stroke(x0, y, x1, y, 2 * v.unit, ink);
    for (const double x : {x0, x1}) canvas.stroke(x, y - 4 * v.unit, x, y + 4 * v.unit, 2 * v.unit, ink);
    canvas.text(x0, baseline, 10 * v.unit, length_label(length), ink);
}

void draw_colour_bar(Canvas& canvas, const View& v, const ColourScale& scale, const PictureStyle& style,
                     double baseline) {
    const Quantity shown = quantity(style.colour, style.body);
    const double x1 = v.width - 17 * v.unit, x0 = x1 - 0.30 * v.width;
    const double top = baseline - 27 * v.unit, bottom = top + 10 * v.unit;
    const int columns = static_cast<int>(std::ceil(x1 - x0));
    for (int k = 0; k < columns; ++k)
        canvas.rectangle(x0 + k, top, std::min(x0 + k + 1, x1), bottom, map_colour((k + 0.5) / columns));
    const bool millimetres = style.colour == scene::Colour::radius && scale.high < 0.1;
    const double factor = millimetres ? 1000 : 1;
    const std::string_view unit = millimetres ? "mm" : shown.unit;
    const double size = 10 * v.unit;
    canvas.text(x0, baseline, size, fmt::format("{:.3g}", scale.low * factor), ink);
    canvas.text((x0 + x1) / 2, baseline, size, fmt::format("{} ({})", shown.name, unit), ink,
                Canvas::Anchor::middle);
    canvas.text(x1, baseline, size, fmt::format("{:.3g}", scale.high * factor), ink, Canvas::Anchor::end);
}

void draw_domain(Canvas& canvas, const View& v) {
    const double line = 1;
    canvas.rectangle(v.left - line, v.top - line, v.right + line, v.bottom + line, frame);
    canvas.rectangle(v.left, v.top, v.right, v.bottom, ground);
}

} // namespace

void write_picture(const std::filesystem::path& path, const Snapshot& s, const PictureStyle& style) {
    const View v = make_view(s, style.width);
    Canvas canvas(v.width, v.height, paper);
    draw_domain(canvas, v);

    const double overhang = 6 * v.unit; // walls on the border keep their full width
    canvas.clip(static_cast<int>(v.left - overhang), static_cast<int>(v.top - overhang),
                static_cast<int>(v.right + overhang), static_cast<int>(v.bottom + overhang));
    const std::vector<double> values = colour_values(s, style.colour);
    const ColourScale scale = make_scale(values, style);
    for (std::size_t i = 0; i < s.size(); ++i) draw_grain(canvas, v, s, i, scale.of(values[i]));
    for (const WallShape& wall : s.walls) draw_wall(canvas, v, wall);
    canvas.clip_nothing();

    const double baseline = v.height - 18 * v.unit;
    draw_scale_bar(canvas, v, baseline);
    canvas.text(v.width / 2.0 - 0.04 * v.width, baseline - 10 * v.unit, 13 * v.unit,
                fmt::format("t = {:.4g} s", s.time), ink, Canvas::Anchor::middle);
    draw_colour_bar(canvas, v, scale, style, baseline);
    write_file_atomically(path, canvas.png());
}

} // namespace sandlane::output
