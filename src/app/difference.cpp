#include "app/difference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace sandlane::app {

std::uint64_t ulp_distance(double a, double b) {
    if (std::isnan(a) || std::isnan(b))
        return std::isnan(a) && std::isnan(b) ? 0 : std::numeric_limits<std::uint64_t>::max();
    // Maps doubles to integers of the same order, with -0 and +0 adjacent at zero distance.
    const auto ordered = [](double x) {
        const auto raw = std::bit_cast<std::int64_t>(x);
        return raw < 0 ? std::numeric_limits<std::int64_t>::min() - raw : raw;
    };
    const std::int64_t x = ordered(a), y = ordered(b);
    return x > y ? static_cast<std::uint64_t>(x) - static_cast<std::uint64_t>(y)
                 : static_cast<std::uint64_t>(y) - static_cast<std::uint64_t>(x);
}

Difference difference(std::string quantity, std::string unit, const std::vector<std::int64_t>& ids,
                      const std::vector<double>& a, const std::vector<double>& b) {
    Difference d{std::move(quantity), std::move(unit), 0, 0, 0, -1};
    double scale = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        scale = std::max({scale, std::abs(a[i]), std::abs(b[i])});
        const double gap = std::abs(a[i] - b[i]);
        d.ulps = std::max(d.ulps, ulp_distance(a[i], b[i]));
        if (gap > d.absolute || std::isnan(gap)) {
            d.absolute = gap;
            d.id = ids[i];
        }
    }
    if (d.absolute > 0) d.relative = d.absolute / scale;
    return d;
}

std::string difference_table(const std::vector<Difference>& differences, const std::string& thing) {
    std::string text = fmt::format("{:<18}{:<8}{:>12}{:>12}{:>12}  {}\n", "quantity", "unit", "absolute",
                                   "relative", "ULP", thing);
    for (const Difference& d : differences)
        text += fmt::format("{:<18}{:<8}{:>12.3g}{:>12.3g}{:>12}  {}\n", d.quantity, d.unit, d.absolute,
                            d.relative, d.ulps, d.id < 0 ? "-" : std::to_string(d.id));
    return text;
}

double worst_relative(const std::vector<Difference>& differences) {
    double worst = 0;
    for (const Difference& d : differences)
        worst = std::max(worst, std::isnan(d.relative) ? INFINITY : d.relative);
    return worst;
}

} // namespace sandlane::app
