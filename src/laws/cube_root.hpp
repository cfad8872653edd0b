// The cube root by operations that give the same bits in every lane of every instruction set.
#pragma once

#include "core/real.hpp"

namespace sandlane::laws {

// x in [0, 1], about 1e-15 relative. x^(1/4 + 1/16 + 1/64) is within x^(1/192) of the root, and each step of
// Halley's method cubes the error.
template <class R> SANDLANE_INLINE R cube_root(const R& x) {
    const R a = sqrt(sqrt(x)), b = sqrt(sqrt(a)), c = sqrt(sqrt(b)), two(2.0);
    R y = a * b * c;
    for (int step = 0; step < 3; ++step) {
        const R cube = y * y * y;
        y = y * (cube + two * x) / (two * cube + x);
    }
    return select(x > R(0.0), y, R(0.0));
}

} // namespace sandlane::laws
