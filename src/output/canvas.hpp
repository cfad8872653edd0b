// A small software rasteriser: anti-aliased discs, strokes and text on an RGB image. Coordinates in pixels, y
// down.
#pragma once

#include "output/colours.hpp"

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

private:
    void blend(int x, int y, Rgb colour, float opacity);

    int width_, height_;
    int left_ = 0, top_ = 0, right_ = 0, bottom_ = 0;
    std::vector<unsigned char> pixels_;
};

} // namespace sandlane::output
