#include "output/colours.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <numbers>

namespace sandlane::output {

namespace {

// Stops of the map in Oklab's polar form: lightness rises evenly, the hue turns from violet over blue and
// green to yellow. Chroma is kept inside the sRGB gamut.
struct Stop {
    double lightness, chroma, hue; // hue in degrees
};
constexpr std::array<Stop, 7> stops{{{0.28, 0.115, 300},
                                     {0.39, 0.125, 278},
                                     {0.50, 0.105, 245},
                                     {0.61, 0.105, 195},
                                     {0.72, 0.145, 158},
                                     {0.83, 0.175, 128},
                                     {0.92, 0.180, 104}}};

double to_srgb(double linear) {
    const double c = std::clamp(linear, 0.0, 1.0);
    return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
}

// Oklab to sRGB with the constants of its definition (B. Ottosson, 2020).
Rgb from_oklab(double lightness, double a, double b) {
    const auto cube = [](double v) { return v * v * v; };
    const double l = cube(lightness + 0.3963377774 * a + 0.2158037573 * b);
    const double m = cube(lightness - 0.1055613458 * a - 0.0638541728 * b);
    const double s = cube(lightness - 0.0894841775 * a - 1.2914855480 * b);
    return {static_cast<float>(to_srgb(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s)),
            static_cast<float>(to_srgb(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s)),
            static_cast<float>(to_srgb(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s))};
}

std::array<Rgb, 256> build_map() {
    std::array<Rgb, 256> map{};
    for (std::size_t k = 0; k < map.size(); ++k) {
        const double at = static_cast<double>(k) / 255 * (stops.size() - 1);
        const auto left = std::min(static_cast<std::size_t>(at), stops.size() - 2);
        const double t = at - static_cast<double>(left);
        const Stop &from = stops[left], &to = stops[left + 1];
        const double hue = std::lerp(from.hue, to.hue, t) * std::numbers::pi / 180;
        const double chroma = std::lerp(from.chroma, to.chroma, t);
        map[k] = from_oklab(std::lerp(from.lightness, to.lightness, t), chroma * std::cos(hue),
                            chroma * std::sin(hue));
    }
    return map;
}

} // namespace

const std::array<Rgb, 256>& colour_map() {
    static const std::array<Rgb, 256> map = build_map();
    return map;
}

Quantity quantity(scene::Colour colour, std::int64_t dimension) {
    switch (colour) {
    case scene::Colour::speed:
        return {"speed", "m/s"};
    case scene::Colour::pressure:
        return {"pressure", analysis::pressure_unit(dimension)};
    case scene::Colour::spin:
        return {"spin", "rad/s"};
    case scene::Colour::radius:
        return {"radius", "m"};
    }
    return {"", ""};
}

std::vector<double> colour_values(const analysis::Snapshot& s, scene::Colour colour) {
    std::vector<double> values(s.size());
    for (std::size_t i = 0; i < s.size(); ++i) {
        switch (colour) {
        case scene::Colour::speed:
            values[i] = s.dimension == 3 ? norm(s.velocity(i)) : std::hypot(s.vx[i], s.vy[i]);
            break;
        case scene::Colour::pressure:
            values[i] = std::max(0.0, s.pressure[i]);
            break;
        case scene::Colour::spin:
            values[i] = s.dimension == 3 ? norm(s.angular_velocity(i)) : std::abs(s.omega[i]);
            break;
        case scene::Colour::radius:
            values[i] = s.radius[i];
            break;
        }
    }
    return values;
}

double largest_finite(const std::vector<double>& values) {
    double largest = 0;
    for (const double value : values)
        if (std::isfinite(value)) largest = std::max(largest, value);
    return largest;
}

double usual_high(const std::vector<double>& values) {
    const double largest = largest_finite(values);
    std::vector<double> finite;
    finite.reserve(values.size());
    std::copy_if(values.begin(), values.end(), std::back_inserter(finite),
                 [](double value) { return std::isfinite(value); });
    if (finite.empty()) return 0;
    const auto above = finite.begin() + static_cast<std::ptrdiff_t>(finite.size() / 100);
    std::nth_element(finite.begin(), above, finite.end(), std::greater<>());
    const bool far_above = *above > 0 && largest > 1.25 * *above;
    return far_above ? *above : largest;
}

double round_up(double value) {
    const double power = std::pow(10, std::floor(std::log10(value)));
    for (const double step : {1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0})
        if (value <= step * power * (1 + 1e-12)) return step * power;
    return 10 * power;
}

} // namespace sandlane::output
