// Heaps: a grain on each of eight heaps at once, a heap to a lane, until all have stopped.
#pragma once

#include "simd/automata/tables.hpp"
#include "simd/automata/words.hpp"

namespace sandlane::simd {

template <class Arch, bool rough> struct HeapLanes {
    using W = WordBatch<Arch>;
    using D = xsimd::batch<double, Arch>;
    static constexpr int lanes = static_cast<int>(D::size);

    struct Keys {
        W low, high;
    };

    static void drop(const HeapView& v, std::uint32_t first_grain, std::int64_t grains) {
        for (int part = 0; part < heap_lanes; part += lanes) {
            alignas(64) std::uint64_t low[lanes], high[lanes];
            for (int l = 0; l < lanes; ++l) {
                low[l] = v.seed[part + l][0];
                high[l] = v.seed[part + l][1];
            }
            const Keys keys{W::load_aligned(low), W::load_aligned(high)};
            for (std::int64_t g = 0; g < grains; ++g)
                roll(v, part, first_grain + static_cast<std::uint32_t>(g), keys);
        }
    }

    // The threshold of a visit: grains do not come back, so that every visit is the first.
    static SANDLANE_INLINE D threshold(const HeapView& v, const std::uint64_t* x, std::uint32_t grain,
                                       const Keys& keys) {
        if constexpr (!rough) return D(v.sticking);
        const D u =
            to_unit<Arch>(random_words<Arch>(W::load_aligned(x), W(std::uint64_t{grain}), W(std::uint64_t{0}),
                                             W(std::uint64_t{2}), keys.low, keys.high));
        return D(v.sticking) * (D(1 - v.roughness) + D(2 * v.roughness) * u);
    }

    static void roll(const HeapView& v, int part, std::uint32_t grain, const Keys& keys) {
        alignas(64) std::uint64_t x[lanes] = {};
        alignas(64) double here[lanes] = {}, next[lanes] = {};
        alignas(64) bool goes[lanes] = {};
        const auto last = static_cast<std::uint64_t>(v.columns - 1);
        D energy(v.start_energy);
        unsigned rolling = (1U << lanes) - 1;
        while (rolling != 0) {
            for (int l = 0; l < lanes; ++l) {
                const std::int32_t* h = v.heights + x[l] * heap_lanes + static_cast<unsigned>(part + l);
                here[l] = h[0];
                next[l] = (rolling >> l & 1) != 0 ? h[heap_lanes] : h[0];
            }
            const D sum = energy + (D::load_aligned(here) - D::load_aligned(next));
            energy = D(v.retained) * sum;
            ((sum > D(0.0)) & (energy > threshold(v, x, grain, keys))).store_aligned(goes);
            for (int l = 0; l < lanes; ++l) {
                if ((rolling >> l & 1) == 0) continue;
                if (!goes[l])
                    ++v.heights[x[l] * heap_lanes + static_cast<unsigned>(part + l)];
                else if (++x[l] == last)
                    ++v.lost[part + l];
                else
                    continue;
                rolling &= ~(1U << l);
            }
        }
    }
};

} // namespace sandlane::simd
