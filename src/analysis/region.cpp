#include "analysis/region.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace sandlane::analysis {

bool is_whole_domain(const scene::AnalysisSpec& spec) {
    return spec.from == spec.to;
}

Region region_of(const scene::Scene& scene, const scene::AnalysisSpec& spec) {
    if (is_whole_domain(spec)) return {scene.domain.lower, scene.domain.upper};
    return {{std::min(spec.from.x, spec.to.x), std::min(spec.from.y, spec.to.y), 0},
            {std::max(spec.from.x, spec.to.x), std::max(spec.from.y, spec.to.y), 0}};
}

Vec wrapped(const Snapshot& s, Vec p) {
    const Vec size = s.upper - s.lower;
    if (s.periodic_x) p.x -= size.x * std::floor((p.x - s.lower.x) / size.x);
    if (s.periodic_y) p.y -= size.y * std::floor((p.y - s.lower.y) / size.y);
    return p;
}

namespace {

// Integral of sqrt(1 - x^2) from 0.
double half_disc_integral(double x) {
    const double inside = std::clamp(x, -1.0, 1.0);
    return 0.5 * (inside * std::sqrt(1 - inside * inside) + std::asin(inside));
}

// Area of the unit disc between two verticals and two horizontals: pieces between the places where its rim
// crosses the horizontals have one formula each.
double unit_disc_area(double left, double right, double bottom, double top) {
    const auto crossing = [](double y) { return std::sqrt(std::max(0.0, 1 - y * y)); };
    const double a = crossing(bottom), b = crossing(top);
    std::array<double, 6> cuts{left, right, -a, a, -b, b};
    left = std::max(left, -1.0);
    right = std::min(right, 1.0);
    if (!(left < right)) return 0;
    for (double& x : cuts) x = std::clamp(x, left, right);
    std::sort(cuts.begin(), cuts.end());
    double area = 0;
    for (std::size_t n = 1; n < cuts.size(); ++n) {
        const double width = cuts[n] - cuts[n - 1], middle = 0.5 * (cuts[n] + cuts[n - 1]);
        const double rim = crossing(middle),
                     under_rim = half_disc_integral(cuts[n]) - half_disc_integral(cuts[n - 1]);
        if (std::min(rim, top) <= std::max(-rim, bottom)) continue;
        area += (rim < top ? under_rim : top * width) - (-rim > bottom ? -under_rim : bottom * width);
    }
    return area;
}

} // namespace

double disc_area_inside(Vec centre, double radius, const Region& region) {
    const Vec low = (1 / radius) * (region.lower - centre), high = (1 / radius) * (region.upper - centre);
    if (low.x <= -1 && low.y <= -1 && high.x >= 1 && high.y >= 1) return std::numbers::pi * radius * radius;
    if (low.x >= 1 || low.y >= 1 || high.x <= -1 || high.y <= -1) return 0;
    return radius * radius * unit_disc_area(low.x, high.x, low.y, high.y);
}

double packing_fraction(const Snapshot& s, const Region& region) {
    const Vec size = s.upper - s.lower;
    const int x_images = s.periodic_x ? 1 : 0, y_images = s.periodic_y ? 1 : 0;
    double area = 0;
    for (std::size_t i = 0; i < s.size(); ++i)
        for (int ky = -y_images; ky <= y_images; ++ky)
            for (int kx = -x_images; kx <= x_images; ++kx)
                area +=
                    disc_area_inside({s.x[i] + kx * size.x, s.y[i] + ky * size.y, 0}, s.radius[i], region);
    return area / region.area();
}

} // namespace sandlane::analysis
