#include "output/canvas.hpp"

#include "output/font.hpp"
#include "output/raster.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sandlane::output {

namespace {

unsigned char byte(float value) {
    return static_cast<unsigned char>(std::lround(std::clamp(value, 0.0F, 1.0F) * 255));
}

} // namespace

Canvas::Canvas(int width, int height, Rgb background)
    : width_(width), height_(height),
      pixels_(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {
    clip_nothing();
    for (std::size_t at = 0; at < pixels_.size(); at += 3) {
        pixels_[at] = byte(background.r);
        pixels_[at + 1] = byte(background.g);
        pixels_[at + 2] = byte(background.b);
    }
}

void Canvas::clip(int left, int top, int right, int bottom) {
    left_ = std::clamp(left, 0, width_);
    top_ = std::clamp(top, 0, height_);
    right_ = std::clamp(right, left_, width_);
    bottom_ = std::clamp(bottom, top_, height_);
}

void Canvas::blend(int x, int y, Rgb colour, float opacity) {
    if (opacity <= 0) return;
    unsigned char* pixel = &pixels_[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                                         static_cast<std::size_t>(x))];
    const auto over = [opacity](unsigned char below, float above) {
        const float old = static_cast<float>(below) / 255;
        return byte(old + (above - old) * opacity);
    };
    pixel[0] = over(pixel[0], colour.r);
    pixel[1] = over(pixel[1], colour.g);
    pixel[2] = over(pixel[2], colour.b);
}

void Canvas::rectangle(double left, double top, double right, double bottom, Rgb colour) {
    const PixelRange across = columns(left, right), down = rows(top, bottom);
    for (int y = down.first; y < down.last; ++y) {
        const double high = std::min(y + 1.0, bottom) - std::max<double>(y, top);
        for (int x = across.first; x < across.last; ++x) {
            const double wide = std::min(x + 1.0, right) - std::max<double>(x, left);
            blend(x, y, colour, static_cast<float>(std::clamp(wide * high, 0.0, 1.0)));
        }
    }
}

void Canvas::disc(double cx, double cy, double radius, Rgb fill, Rgb rim, double rim_width) {
    // A disc smaller than a pixel keeps its area by fading.
    const double drawn = std::max(radius, 0.5);
    const auto fade = static_cast<float>(radius * radius / (drawn * drawn));
    const PixelRange across = columns(cx - drawn - 1, cx + drawn + 1);
    const PixelRange down = rows(cy - drawn - 1, cy + drawn + 1);
    for (int y = down.first; y < down.last; ++y) {
        for (int x = across.first; x < across.last; ++x) {
            const double dx = x + 0.5 - cx, dy = y + 0.5 - cy;
            const double squared = dx * dx + dy * dy;
            if (squared > (drawn + 0.5) * (drawn + 0.5)) continue;
            const double distance = std::sqrt(squared);
            const Rgb colour = rim_width > 0 ? mix(rim, fill, coverage(drawn - rim_width - distance)) : fill;
            blend(x, y, colour, coverage(drawn - distance) * fade);
        }
    }
}

void Canvas::stroke(double x0, double y0, double x1, double y1, double width, Rgb colour, float opacity) {
    for_stroke(x0, y0, x1, y1, width,
               [&](int x, int y, double, float cover) { blend(x, y, colour, opacity * cover); });
}

void Canvas::arc(double cx, double cy, double radius, double from, double to, double width, Rgb colour) {
    const double turn = 2 * std::numbers::pi;
    const bool full = to - from >= turn - 1e-9;
    const int steps = std::clamp(static_cast<int>(std::ceil((to - from) * radius / 3)), 8, 4000);
    // Chords; opaque, so that overlapping round ends leave no marks.
    for (int k = 0; k < steps; ++k) {
        const double a = from + (full ? turn : to - from) * k / steps;
        const double b = from + (full ? turn : to - from) * (k + 1) / steps;
        stroke(cx + radius * std::cos(a), cy + radius * std::sin(a), cx + radius * std::cos(b),
               cy + radius * std::sin(b), width, colour);
    }
}

void Canvas::text(double x, double y, double size, std::string_view words, Rgb colour, Anchor anchor) {
    const double cell = size / (glyph_height - 1);
    const double length = text_width(words) * cell;
    double pen = x - (anchor == Anchor::start ? 0 : anchor == Anchor::middle ? length / 2 : length);
    for (const char c : words) {
        for (const GlyphLine& line : glyph(c).lines)
            stroke(pen + line.x0 * cell, y + (line.y0 - (glyph_height - 1)) * cell, pen + line.x1 * cell,
                   y + (line.y1 - (glyph_height - 1)) * cell, 0.95 * cell, colour);
        pen += (glyph(c).width + glyph_gap) * cell;
    }
}

} // namespace sandlane::output
