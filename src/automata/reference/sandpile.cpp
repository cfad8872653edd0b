#include "automata/reference/sandpile.hpp"

namespace sandlane::automata::reference {

std::int64_t sweep(Pile& pile, bool unit) {
    const std::vector<std::int64_t> old = pile.height;
    std::int64_t sum = 0;
    for (std::int64_t y = 0; y < pile.rows; ++y)
        for (std::int64_t x = 0; x < pile.columns; ++x) {
            const std::int64_t h = old[static_cast<std::size_t>(y * pile.columns + x)];
            const std::int64_t k = unit ? (h >= 4 ? 1 : 0) : h / 4;
            if (k == 0) continue;
            sum += k;
            pile.topplings[static_cast<std::size_t>(y * pile.columns + x)] += k;
            pile.at(x, y) -= 4 * k;
            if (x > 0) pile.at(x - 1, y) += k;
            if (x + 1 < pile.columns) pile.at(x + 1, y) += k;
            if (y > 0) pile.at(x, y - 1) += k;
            if (y + 1 < pile.rows) pile.at(x, y + 1) += k;
        }
    return sum;
}

std::int64_t relax(Pile& pile, bool unit) {
    std::int64_t sweeps = 0;
    while (sweep(pile, unit) > 0) ++sweeps;
    return sweeps;
}

} // namespace sandlane::automata::reference
