// Free flight in a uniform field, on R = double or a block of lanes.
#pragma once

#include "core/real.hpp"

namespace sandlane::motion {

// r + v t, and r + v t + G t^2/2; half_square = t^2/2.
template <class R> SANDLANE_INLINE R straight(const R& place, const R& velocity, const R& time) {
    return place + velocity * time;
}
template <class R> SANDLANE_INLINE R bent(const R& straight_place, const R& field, const R& half_square) {
    return straight_place + field * half_square;
}

} // namespace sandlane::motion
