#include "output/canvas.hpp"

#include "output/font.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sandlane::output {

namespace {

unsigned char byte(float value) {
    return static_cast<unsigned char>(std::lround(std::clamp(value, 0.0F, 1.0F) * 255));
}

// Share of a pixel inside an edge whose signed distance from the pixel's centre is `inside`.
float coverage(double inside) {
    return static_cast<float>(std::clamp(inside + 0.5, 0.0, 1.0));
}

Rgb mix(Rgb a, Rgb b, float t) {
    return {a.r + (b.r - a.r) * t, a.g + (b.g - a.g) * t, a.b + (b.b - a.b) * t};
}

// First and last pixel, inside [low, high), that a figure between `from` and `to` can touch.
struct Range {
    int first, last;
};
Range pixels_between(double from, double to, int low, int high) {
    if (!(from <= to)) return {low, low}; // also for what is not a number
    const double first = std::clamp(std::floor(from), static_cast<double>(low), static_cast<double>(high));
    const double last = std::clamp(std::ceil(to), static_cast<double>(low), static_cast<double>(high));
    return {static_cast<int>(first), static_cast<int>(last)};
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
    const Range columns = pixels_between(left, right, left_, right_);
    const Range rows = pixels_between(top, bottom, top_, bottom_);
    for (int y = rows.first; y < rows.last; ++y) {
        const double high = std::min(y + 1.0, bottom) - std::max<double>(y, top);
        for (int x = columns.first; x < columns.last; ++x) {
            const double wide = std::min(x + 1.0, right) - std::max<double>(x, left);
            blend(x, y, colour, static_cast<float>(std::clamp(wide * high, 0.0, 1.0)));
        }
    }
}

void Canvas::disc(double cx, double cy, double radius, Rgb fill, Rgb rim, double rim_width) {
    // A disc smaller than a pixel keeps its area by fading.
    const double drawn = std::max(radius, 0.5);
    const auto fade = static_cast<float>(radius * radius / (drawn * drawn));
    const Range columns = pixels_between(cx - drawn - 1, cx + drawn + 1, left_, right_);
    const Range rows = pixels_between(cy - drawn - 1, cy + drawn + 1, top_, bottom_);
    for (int y = rows.first; y < rows.last; ++y) {
        for (int x = columns.first; x < columns.last; ++x) {
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
    const double half = width / 2, reach = half + 1;
    const double ux = x1 - x0, uy = y1 - y0;
    const double length2 = ux * ux + uy * uy;
    const Range rows = pixels_between(std::min(y0, y1) - reach, std::max(y0, y1) + reach, top_, bottom_);
    for (int y = rows.first; y < rows.last; ++y) {
        // The part of the line near this row bounds the columns to look at.
        double from = std::min(x0, x1), to = std::max(x0, x1);
        if (std::abs(uy) > 1e-9) {
            const double a = std::clamp((y - reach - y0) / uy, 0.0, 1.0);
            const double b = std::clamp((y + 1 + reach - y0) / uy, 0.0, 1.0);
            from = std::min(x0 + a * ux, x0 + b * ux);
            to = std::max(x0 + a * ux, x0 + b * ux);
        }
        const Range columns = pixels_between(from - reach, to + reach, left_, right_);
        for (int x = columns.first; x < columns.last; ++x) {
            const double px = x + 0.5 - x0, py = y + 0.5 - y0;
            const double t = length2 > 0 ? std::clamp((px * ux + py * uy) / length2, 0.0, 1.0) : 0;
            blend(x, y, colour, opacity * coverage(half - std::hypot(px - t * ux, py - t * uy)));
        }
    }
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
