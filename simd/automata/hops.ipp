// Rest particles that share a site: where they hop (spec 3.4.4).
#pragma once

#include "simd/automata/tables.hpp"
#include "simd/automata/words.hpp"

namespace sandlane::simd {

template <class Arch> void hop_directions(const HopView& v) {
    using W = WordBatch<Arch>;
    const W low(0xffffffffULL), six(std::uint64_t{6}), k0(std::uint64_t{v.seed[0]}),
        k1(std::uint64_t{v.seed[1]}), step(std::uint64_t{v.step}), stream(std::uint64_t{v.stream});
    for (std::int64_t n = 0; n < v.count; n += static_cast<std::int64_t>(W::size)) {
        const W site = load_words<Arch>(v.sites + n);
        const W random = random_words<Arch>(site & low, right<32>(site), step, stream, k0, k1);
        right<32>(multiply_low(random, six)).store_unaligned(v.directions + n);
    }
}

} // namespace sandlane::simd
