#include "automata/reference/ripples.hpp"

#include <algorithm>
#include <cmath>

namespace sandlane::automata::reference {

namespace {

// Where the sand of a site lands: `share` on the second cell, the rest on the first.
struct Landing {
    std::int64_t first, second; // columns
    double share;               // of q
    bool clamped;
};

Landing land(double height, std::int64_t x, std::int64_t y, std::int64_t columns, const RippleRules& rules,
             std::uint32_t t) {
    const double flight = rules.length + rules.wind * height;
    const double length = std::max(0.0, flight);
    double cells = std::floor(length);
    double share = length - cells;
    if (rules.landing == scene::RippleLanding::whole) {
        cells = std::floor(length + 0.5);
        share = 0;
    }
    if (rules.landing == scene::RippleLanding::stochastic) {
        const PhiloxCounter r =
            philox({static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), t, 5}, rules.seed);
        const std::uint64_t bits = (std::uint64_t{r[0]} << 32 | r[1]) >> 11;
        share = static_cast<double>(bits) * 0x1p-53 < share ? 1 : 0;
    }
    const std::int64_t first = (x + static_cast<std::int64_t>(cells)) % columns;
    return {first, (first + 1) % columns, share, flight < 0};
}

// Every bond of a site to its right and upper neighbours.
template <class Bond> void for_bonds(std::int64_t columns, std::int64_t rows, const Bond& bond) {
    for (std::int64_t y = 0; y < rows; ++y)
        for (std::int64_t x = 0; x < columns; ++x) {
            const std::int64_t right = (x + 1) % columns, left = (x + columns - 1) % columns,
                               up = (y + 1) % rows;
            const std::int64_t own = y * columns + x;
            if (rows == 1) {
                bond(own, right, 0.5);
                continue;
            }
            bond(own, y * columns + right, 1.0 / 6);
            bond(own, up * columns + x, 1.0 / 6);
            bond(own, up * columns + right, 1.0 / 12);
            bond(own, up * columns + left, 1.0 / 12);
        }
}

} // namespace

std::int64_t step(std::vector<double>& heights, std::int64_t columns, std::int64_t rows,
                  const RippleRules& rules, std::uint32_t t) {
    std::int64_t clamped = 0;
    const std::vector<double> old = heights;
    for (double& h : heights) h -= rules.transport;
    for (std::int64_t y = 0; y < rows; ++y)
        for (std::int64_t x = 0; x < columns; ++x) {
            const Landing l = land(old[static_cast<std::size_t>(y * columns + x)], x, y, columns, rules, t);
            clamped += l.clamped ? 1 : 0;
            heights[static_cast<std::size_t>(y * columns + l.first)] += (1 - l.share) * rules.transport;
            heights[static_cast<std::size_t>(y * columns + l.second)] += l.share * rules.transport;
        }
    const std::vector<double> landed = heights;
    for_bonds(columns, rows, [&](std::int64_t a, std::int64_t b, double weight) {
        const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
        const double flux = rules.creep * weight * (landed[i] - landed[j]);
        heights[i] -= flux;
        heights[j] += flux;
    });
    return clamped;
}

std::int64_t step(std::vector<std::int64_t>& heights, std::int64_t columns, std::int64_t rows,
                  const RippleRules& rules, std::uint32_t t) {
    std::int64_t clamped = 0;
    const std::int64_t transport = rules.fixed_transport();
    const std::vector<std::int64_t> old = heights;
    for (std::int64_t& h : heights) h -= transport;
    for (std::int64_t y = 0; y < rows; ++y)
        for (std::int64_t x = 0; x < columns; ++x) {
            const double height =
                static_cast<double>(old[static_cast<std::size_t>(y * columns + x)]) / ripple_unit;
            const Landing l = land(height, x, y, columns, rules, t);
            clamped += l.clamped ? 1 : 0;
            const auto second =
                static_cast<std::int64_t>(std::floor(l.share * static_cast<double>(transport)));
            heights[static_cast<std::size_t>(y * columns + l.first)] += transport - second;
            heights[static_cast<std::size_t>(y * columns + l.second)] += second;
        }
    const std::vector<std::int64_t> landed = heights;
    for_bonds(columns, rows, [&](std::int64_t one, std::int64_t other, double weight) {
        const auto a = static_cast<std::size_t>(std::min(one, other)),
                   b = static_cast<std::size_t>(std::max(one, other));
        const auto flux = static_cast<std::int64_t>(
            std::floor(rules.creep * weight * static_cast<double>(landed[a] - landed[b])));
        heights[a] -= flux;
        heights[b] += flux;
    });
    return clamped;
}

} // namespace sandlane::automata::reference
