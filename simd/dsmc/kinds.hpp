// Kinds of particles of a mixture, in lanes.
#pragma once

#include "simd/dsmc/tables.hpp"
#include "simd/words.hpp"

namespace sandlane::simd {

// Numbers of a table at eight places; kinds of particles; number of a pair of kinds.
template <class Arch> SANDLANE_INLINE Block<Arch> look_up(const double* table, const Words<Arch>& at) {
    alignas(64) std::uint64_t place[width];
    alignas(64) double found[width];
    at.store(place);
    for (int l = 0; l < width; ++l) found[l] = table[place[l]];
    return load<Arch>(found);
}
template <class Arch> SANDLANE_INLINE Words<Arch> kind_of(const Block<Arch>& word) {
    return right<60>(words_of(word));
}
template <class Arch> SANDLANE_INLINE Words<Arch> pair_of(const Words<Arch>& i, const Words<Arch>& j) {
    static_assert(most_kinds == 1 << 4);
    return left<4>(i) + j;
}

} // namespace sandlane::simd
