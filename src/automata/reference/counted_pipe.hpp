// The pipe whose sites hold any number of rest particles (variant P2, spec 3.4.4), site by site.
#pragma once

#include "automata/gas.hpp"

#include <cstdint>
#include <vector>

namespace sandlane::automata::reference {

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

inline constexpr std::uint32_t most_hops = 64;    // rounds of a step
inline constexpr std::uint32_t hop_stream = 1024; // of random numbers, plus the round

// Movers (bits of the six directions) and rest particles of a site.
struct CountedSite {
    int movers, resting;
};
[[nodiscard]] CountedSite collide(CountedSite s, bool xi, bool dissipative);
// After at most one particle was turned towards +x; a rest particle is the first.
[[nodiscard]] CountedSite pull(CountedSite s);

// Collision, gravity, hops of resting particles, propagation. Returns the number of sites that still have
// several resting particles after the last round.
std::int64_t step(CountedPipe& pipe, const GasRules& rules, std::uint32_t t);

} // namespace sandlane::automata::reference
