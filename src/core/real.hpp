// The operations that formula headers use, for R = double. A block of lanes brings its own overloads
// (simd/lanes.hpp). min and max follow the x86 instructions (second operand on a tie or NaN), so that both
// types give the same bits.
#pragma once

#include <cmath>

// Formula templates must vanish into the kernels that use them: a call per block would cost more than the
// formula.
#define SANDLANE_INLINE inline __attribute__((always_inline))

namespace sandlane {

using std::sqrt;

[[nodiscard]] constexpr double max(double a, double b) {
    return a > b ? a : b;
}
[[nodiscard]] constexpr double min(double a, double b) {
    return a < b ? a : b;
}
[[nodiscard]] constexpr double select(bool condition, double yes, double no) {
    return condition ? yes : no;
}

// Whether a condition holds in any lane: what no lane needs may be left out.
[[nodiscard]] constexpr bool any(bool condition) {
    return condition;
}

} // namespace sandlane
