#include "analysis/region.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace sandlane::analysis {

bool is_whole_domain(const scene::AnalysisSpec& spec) {
    return spec.from == spec.to;
}

Region region_of(const scene::Scene& scene, const scene::AnalysisSpec& spec) {
    const auto dimension = static_cast<int>(scene.domain.dimension);
    if (is_whole_domain(spec)) return {scene.domain.lower, scene.domain.upper, dimension};
    const Vec a = spec.from, b = spec.to;
    return {{std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)},
            {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)},
            dimension};
}

Vec wrapped(const Snapshot& s, Vec p) {
    const Vec size = s.upper - s.lower;
    if (s.periodic_x) p.x -= size.x * std::floor((p.x - s.lower.x) / size.x);
    if (s.periodic_y) p.y -= size.y * std::floor((p.y - s.lower.y) / size.y);
    if (s.periodic_z) p.z -= size.z * std::floor((p.z - s.lower.z) / size.z);
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

// Heights at which the section of the unit sphere begins or ceases to meet a side or an edge of the box: in
// between, its area inside is smooth.
std::vector<double> kinks(Vec low, Vec high) {
    const double bottom = std::max(low.z, -1.0), top = std::min(high.z, 1.0);
    std::vector<double> heights{bottom, top};
    const auto add = [&](double distance) {
        if (distance >= 1) return;
        const double z = std::sqrt(1 - distance * distance);
        heights.insert(heights.end(), {std::clamp(-z, bottom, top), std::clamp(z, bottom, top)});
    };
    for (const double x : {low.x, high.x}) {
        add(std::abs(x));
        for (const double y : {low.y, high.y}) add(std::hypot(x, y));
    }
    for (const double y : {low.y, high.y}) add(std::abs(y));
    std::sort(heights.begin(), heights.end());
    return heights;
}

// Gauss-Legendre with 12 points on [-1, 1]: half of the nodes, and their weights.
constexpr std::array<std::array<double, 2>, 6> gauss{{{0.1252334085114689, 0.2491470458134028},
                                                      {0.3678314989981802, 0.2334925365383548},
                                                      {0.5873179542866175, 0.2031674267230659},
                                                      {0.7699026741943047, 0.1600783285433462},
                                                      {0.9041172563704749, 0.1069393259953184},
                                                      {0.9815606342467193, 0.0471753363865118}}};

// Volume of the unit sphere in a box: areas of its sections, integrated over the height. At a kink the area
// grows with a power 3/2 of the distance; the substitution z = a + (b - a) u^2 (3 - 2u) smooths that.
double unit_sphere_volume(Vec low, Vec high) {
    const std::vector<double> heights = kinks(low, high);
    double volume = 0;
    for (std::size_t n = 1; n < heights.size(); ++n) {
        const double from = heights[n - 1], width = heights[n] - from;
        if (!(width > 0)) continue;
        for (const auto& [node, weight] : gauss)
            for (const double u : {0.5 - 0.5 * node, 0.5 + 0.5 * node}) {
                const double z = from + width * u * u * (3 - 2 * u), r = std::sqrt(1 - z * z);
                const double area = r * r * unit_disc_area(low.x / r, high.x / r, low.y / r, high.y / r);
                volume += 0.5 * weight * width * 6 * u * (1 - u) * area;
            }
    }
    return volume;
}

} // namespace

double disc_area_inside(Vec centre, double radius, const Region& region) {
    const Vec low = (1 / radius) * (region.lower - centre), high = (1 / radius) * (region.upper - centre);
    if (low.x <= -1 && low.y <= -1 && high.x >= 1 && high.y >= 1) return std::numbers::pi * radius * radius;
    if (low.x >= 1 || low.y >= 1 || high.x <= -1 || high.y <= -1) return 0;
    return radius * radius * unit_disc_area(low.x, high.x, low.y, high.y);
}

double sphere_volume_inside(Vec centre, double radius, const Region& region) {
    const Vec low = (1 / radius) * (region.lower - centre), high = (1 / radius) * (region.upper - centre);
    if (std::max({low.x, low.y, low.z}) <= -1 && std::min({high.x, high.y, high.z}) >= 1)
        return 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
    if (std::max({low.x, low.y, low.z}) >= 1 || std::min({high.x, high.y, high.z}) <= -1) return 0;
    return radius * radius * radius * unit_sphere_volume(low, high);
}

double packing_fraction(const Snapshot& s, const Region& region) {
    const Vec size = s.upper - s.lower;
    const int x_images = s.periodic_x ? 1 : 0, y_images = s.periodic_y ? 1 : 0,
              z_images = s.periodic_z ? 1 : 0;
    const auto part_inside = s.dimension == 3 ? sphere_volume_inside : disc_area_inside;
    double covered = 0;
    for (std::size_t i = 0; i < s.size(); ++i)
        for (int kz = -z_images; kz <= z_images; ++kz)
            for (int ky = -y_images; ky <= y_images; ++ky)
                for (int kx = -x_images; kx <= x_images; ++kx)
                    covered += part_inside(s.position(i) + Vec{kx * size.x, ky * size.y, kz * size.z},
                                           s.radius[i], region);
    return covered / region.measure();
}

} // namespace sandlane::analysis
