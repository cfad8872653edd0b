// The pipe whose sites hold any number of rest particles (variant P2, spec 3.4.4), site by site.
#pragma once

#include "automata/gas.hpp"

#include <cstdint>
#include <vector>

namespace sandlane::automata {

struct CountedPipe {
    std::int64_t length, width;
    std::vector<std::uint8_t> movers;   // bits of the six directions, row by row
    std::vector<std::uint16_t> resting; // R

    CountedPipe(std::int64_t columns, std::int64_t rows)
        : length(columns), width(rows), movers(static_cast<std::size_t>(columns * rows), 0),
          resting(movers.size(), 0) {}
    [[nodiscard]] std::int64_t particles() const;
    [[nodiscard]] std::int64_t moving() const;
};

inline constexpr int most_hops = 64; // rounds of a step

// Collision, gravity, hops of resting particles, propagation. Returns the number of sites that still have
// several resting particles after the last round.
std::int64_t step(CountedPipe& pipe, const GasRules& rules, std::uint32_t t);

} // namespace sandlane::automata
