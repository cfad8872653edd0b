// Ripples as the specification says them, one site after the other; periodic, row by row.
#pragma once

#include "automata/ripples.hpp"

#include <cstdint>
#include <vector>

namespace sandlane::automata::reference {

// One step; returns the number of lengths clamped to 0.
std::int64_t step(std::vector<double>& heights, std::int64_t columns, std::int64_t rows,
                  const RippleRules& rules, std::uint32_t t);
// In numbers of 2^-32.
std::int64_t step(std::vector<std::int64_t>& heights, std::int64_t columns, std::int64_t rows,
                  const RippleRules& rules, std::uint32_t t);

} // namespace sandlane::automata::reference
