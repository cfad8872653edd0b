#include "output/picture.hpp"

#include "core/file.hpp"
#include "output/picture_frame.hpp"
#include "output/picture_space.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace sandlane::output {

namespace {

using analysis::Snapshot;
using analysis::WallShape;

struct ColourScale {
    double low = 0, high = 1;
    bool cut = false; // there are values above
    [[nodiscard]] Rgb of(double value) const { return map_colour((value - low) / (high - low)); }
};

ColourScale make_scale(const std::vector<double>& values, const PictureStyle& style) {
    ColourScale scale;
    const double largest = largest_finite(values);
    const double smallest = values.empty() ? 0 : *std::min_element(values.begin(), values.end());
    const double usual = style.colour == scene::Colour::radius ? largest : usual_high(values);
    scale.high = style.scale_max > 0 ? style.scale_max : usual > 0 ? round_up(usual) : 1;
    const bool from_smallest = style.colour == scene::Colour::radius && smallest < 0.999 * largest;
    if (from_smallest && style.scale_max <= 0) scale.high = largest;
    scale.low = from_smallest && smallest < scale.high ? smallest : 0;
    scale.cut = largest > scale.high;
    return scale;
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

void draw_plane(Canvas& canvas, const View& v, const Snapshot& s, const std::vector<Rgb>& colours) {
    for (std::size_t i = 0; i < s.size(); ++i) draw_grain(canvas, v, s, i, colours[i]);
    for (const WallShape& wall : s.walls) draw_wall(canvas, v, wall);
}

void label_colours(Canvas& canvas, const View& v, const ColourScale& scale, scene::Colour colour,
                   int dimension) {
    const Quantity shown = quantity(colour, dimension);
    const bool millimetres = colour == scene::Colour::radius && scale.high < 0.1;
    const double factor = millimetres ? 1000 : 1;
    draw_colour_bar(canvas, v, fmt::format("{:.3g}", scale.low * factor),
                    fmt::format("{}{:.3g}", scale.cut ? "> " : "", scale.high * factor),
                    fmt::format("{} ({})", shown.name, millimetres ? "mm" : shown.unit));
}

} // namespace

PictureStyle picture_style(const scene::Scene& scene) {
    PictureStyle style;
    style.colour = scene.output.colour;
    style.width = static_cast<int>(scene.output.picture_width);
    style.camera = camera_of(scene);
    return style;
}

void write_picture(const std::filesystem::path& path, const Snapshot& s, const PictureStyle& style) {
    const bool space = s.dimension == 3;
    const View v =
        space ? make_space_view(s, style.camera, style.width) : make_view(s.lower, s.upper, style.width);
    Canvas canvas(v.width, v.height, paper);
    draw_ground(canvas, v);

    clip_to_view(canvas, v);
    const std::vector<double> values = colour_values(s, style.colour);
    const ColourScale scale = make_scale(values, style);
    std::vector<Rgb> colours;
    colours.reserve(values.size());
    for (const double value : values) colours.push_back(scale.of(value));
    if (space)
        draw_space(canvas, v, s, style.camera, colours);
    else
        draw_plane(canvas, v, s, colours);
    canvas.clip_nothing();

    draw_scale_bar(canvas, v);
    canvas.text(v.width / 2.0 - 0.04 * v.width, v.baseline() - 10 * v.unit, 13 * v.unit,
                fmt::format("t = {:.4g} s", s.time), ink, Canvas::Anchor::middle);
    label_colours(canvas, v, scale, style.colour, s.dimension);
    write_file_atomically(path, canvas.png());
}

} // namespace sandlane::output
