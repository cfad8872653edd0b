// A small software rasteriser: anti-aliased discs, strokes and text on an RGB image. Coordinates in pixels, y
// down.
#pragma once

#include "output/raster.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace sandlane::output {

class Canvas {
public:
    Canvas(int width, int height, Rgb background);

    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }

    // Everything drawn later is cut off outside this rectangle.
    void clip(int left, int top, int right, int bottom);
    void clip_nothing() { clip(0, 0, width_, height_); }

    void rectangle(double left, double top, double right, double bottom, Rgb colour);
    void disc(double x, double y, double radius, Rgb fill, Rgb rim, double rim_width);
    // A line with round ends.
    void stroke(double x0, double y0, double x1, double y1, double width, Rgb colour, float opacity = 1);
    // Angles in the image's sense (y down), from < to.
    void arc(double x, double y, double radius, double from, double to, double width, Rgb colour);

    // `x` is where the text starts, or its middle or end; `y` is the baseline, `size` the height of a
    // capital.
    enum class Anchor { start, middle, end };
    void text(double x, double y, double size, std::string_view words, Rgb colour,
              Anchor anchor = Anchor::start);

    [[nodiscard]] std::string png() const; // throws Error(io) if the encoder fails

    // Pixels that others colour: columns [left, right) and rows [top, bottom) of the part that is not cut
    // off.
    [[nodiscard]] PixelRange columns(double from, double to) const {
        return pixels_between(from, to, left_, right_);
    }
    [[nodiscard]] PixelRange rows(double from, double to) const {
        return pixels_between(from, to, top_, bottom_);
    }
    void blend(int x, int y, Rgb colour, float opacity);
    // Calls paint(x, y, t, cover) for the pixels of a line with round ends: t from 0 to 1 along it, and the
    // share of the pixel that it covers.
    template <class Paint>
    void for_stroke(double x0, double y0, double x1, double y1, double width, const Paint& paint) const;

private:
    int width_, height_;
    int left_ = 0, top_ = 0, right_ = 0, bottom_ = 0;
    std::vector<unsigned char> pixels_;
};

template <class Paint>
void Canvas::for_stroke(double x0, double y0, double x1, double y1, double width, const Paint& paint) const {
    const double half = width / 2, reach = half + 1;
    const double ux = x1 - x0, uy = y1 - y0;
    const double length2 = ux * ux + uy * uy;
    const PixelRange lines = rows(std::min(y0, y1) - reach, std::max(y0, y1) + reach);
    for (int y = lines.first; y < lines.last; ++y) {
        // The part of the line near this row bounds the columns to look at.
        double from = std::min(x0, x1), to = std::max(x0, x1);
        if (std::abs(uy) > 1e-9) {
            const double a = std::clamp((y - reach - y0) / uy, 0.0, 1.0);
            const double b = std::clamp((y + 1 + reach - y0) / uy, 0.0, 1.0);
            from = std::min(x0 + a * ux, x0 + b * ux);
            to = std::max(x0 + a * ux, x0 + b * ux);
        }
        const PixelRange pixels = columns(from - reach, to + reach);
        for (int x = pixels.first; x < pixels.last; ++x) {
            const double px = x + 0.5 - x0, py = y + 0.5 - y0;
            const double t = length2 > 0 ? std::clamp((px * ux + py * uy) / length2, 0.0, 1.0) : 0;
            paint(x, y, t, coverage(half - std::hypot(px - t * ux, py - t * uy)));
        }
    }
}

} // namespace sandlane::output
