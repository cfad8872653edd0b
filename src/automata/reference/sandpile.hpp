// The sandpile as the specification says it: one number per site, all sites at once or one after the other.
#pragma once

#include <cstdint>
#include <vector>

namespace sandlane::automata::reference {

struct Pile {
    std::int64_t columns = 0, rows = 0;
    std::vector<std::int64_t> height, topplings; // row by row

    Pile(std::int64_t width, std::int64_t tall, std::int64_t start = 0)
        : columns(width), rows(tall), height(static_cast<std::size_t>(width * tall), start),
          topplings(height.size(), 0) {}
    [[nodiscard]] std::int64_t& at(std::int64_t x, std::int64_t y) {
        return height[static_cast<std::size_t>(y * columns + x)];
    }
};

// One sweep: topples every unstable site once (unit), or as often as its height allows, from the old heights.
// Returns the number of topplings.
std::int64_t sweep(Pile& pile, bool unit);
// Until no site has four grains; returns the sweeps in which a site toppled.
std::int64_t relax(Pile& pile, bool unit);

} // namespace sandlane::automata::reference
