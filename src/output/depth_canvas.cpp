#include "output/depth_canvas.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace sandlane::output {

namespace {

// Unit vectors to the lamp, over the viewer's left shoulder, and halfway between it and the viewer.
constexpr Vec lamp{-0.36, 0.48, 0.8};
constexpr Vec half_way = (1 / 1.8973665961010275) * (lamp + Vec{0, 0, 1}); // sqrt(3.6)
constexpr double ambient = 0.45, gloss = 0.35;

Rgb scaled(Rgb c, double factor) {
    const auto f = static_cast<float>(factor);
    return {f * c.r, f * c.g, f * c.b};
}

// Diffuse light, and a highlight with the power 24 of the cosine (Blinn and Phong).
Rgb lit(Rgb colour, Vec normal) {
    const double cosine = std::max(0.0, dot(normal, half_way));
    const double cube = cosine * cosine * cosine, power6 = cube * cube, power12 = power6 * power6;
    return mix(scaled(colour, light_on(normal)), {1, 1, 1}, static_cast<float>(gloss * power12 * power12));
}

// Where a horizontal line crosses the triangle. Sides are taken from their lower to their upper end, so that
// triangles with a common side find the same number and leave no gap.
struct Span {
    double from, to;
};
std::optional<Span> span_at(const std::array<Vec, 3>& corners, double y) {
    std::array<double, 3> at{};
    std::size_t count = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        Vec a = corners[k], b = corners[(k + 1) % 3];
        if (std::pair(b.y, b.x) < std::pair(a.y, a.x)) std::swap(a, b);
        if (a.y <= y && y < b.y) at[count++] = a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x);
    }
    if (count < 2) return std::nullopt;
    return Span{std::min(at[0], at[1]), std::max(at[0], at[1])};
}

} // namespace

double light_on(Vec normal) {
    return ambient + (1 - ambient) * std::max(0.0, dot(normal, lamp));
}

DepthCanvas::DepthCanvas(Canvas& canvas)
    : canvas_(canvas),
      depth_(static_cast<std::size_t>(canvas.width()) * static_cast<std::size_t>(canvas.height()), nothing) {}

void DepthCanvas::sphere(Vec centre, double radius, Rgb colour) {
    // A sphere smaller than a pixel keeps its area by fading.
    const double drawn = std::max(radius, 0.5);
    const auto fade = static_cast<float>(radius * radius / (drawn * drawn));
    const PixelRange down = canvas_.rows(centre.y - drawn - 1, centre.y + drawn + 1);
    const PixelRange across = canvas_.columns(centre.x - drawn - 1, centre.x + drawn + 1);
    for (int y = down.first; y < down.last; ++y)
        for (int x = across.first; x < across.last; ++x) {
            const Vec n{(x + 0.5 - centre.x) / drawn, (centre.y - y - 0.5) / drawn, 0};
            const double squared = dot(n, n);
            const float cover = coverage(drawn * (1 - std::sqrt(squared)));
            if (cover <= 0) continue;
            const double height = std::sqrt(std::max(0.0, 1 - squared));
            canvas_.blend(x, y, lit(colour, {n.x, n.y, height}), cover * fade);
            if (cover > 0.5F)
                nearest(x, y) = std::max(nearest(x, y), static_cast<float>(centre.z + drawn * height));
        }
}

void DepthCanvas::triangle(const std::array<Vec, 3>& corners, Rgb colour, float opacity, float before) {
    const auto& [a, b, c] = corners;
    const Vec normal = cross(b - a, c - a);
    if (normal.z == 0) return; // seen from the side
    const PixelRange down = canvas_.rows(std::min({a.y, b.y, c.y}), std::max({a.y, b.y, c.y}));
    for (int y = down.first; y < down.last; ++y) {
        const std::optional<Span> span = span_at(corners, y + 0.5);
        if (!span) continue;
        // Pixels with their centre in [from, to).
        const PixelRange across = canvas_.columns(std::ceil(span->from - 0.5), std::ceil(span->to - 0.5));
        for (int x = across.first; x < across.last; ++x) {
            const double z = a.z - ((x + 0.5 - a.x) * normal.x + (y + 0.5 - a.y) * normal.y) / normal.z;
            const float behind = nearest(x, y);
            if (z > behind) canvas_.blend(x, y, colour, behind == nothing ? opacity : before);
        }
    }
}

void DepthCanvas::line(Vec from, Vec to, double width, Rgb colour) {
    canvas_.for_stroke(from.x, from.y, to.x, to.y, width, [&](int x, int y, double t, float cover) {
        if (cover > 0 && from.z + t * (to.z - from.z) >= nearest(x, y)) canvas_.blend(x, y, colour, cover);
    });
}

} // namespace sandlane::output
