// Heaps: a grain on each of eight heaps at once, a heap to a lane, until all have stopped.
#pragma once

#include "simd/automata/tables.hpp"
#include "simd/automata/words.hpp"

#include <limits>

namespace sandlane::simd {

// rough: thresholds are drawn. general: two sides, or avalanches.
template <class Arch, bool rough, bool general> struct HeapLanes {
    using W = WordBatch<Arch>;
    using D = xsimd::batch<double, Arch>;
    static constexpr int lanes = static_cast<int>(D::size);

    struct Keys {
        W low, high;
    };
    // Where the grains are: column x of a side, and the place of that column among the heights. Beyond column
    // 0 the places of the left side are `left` further.
    struct Grains {
        alignas(64) std::uint64_t x[lanes], place[lanes], left[lanes];
        unsigned rolling; // a bit for each lane
    };

    static void drop(const HeapView& v, std::uint32_t first_grain, std::int64_t grains) {
        for (int part = 0; part < heap_lanes; part += lanes) {
            alignas(64) std::uint64_t low[lanes], high[lanes];
            for (int l = 0; l < lanes; ++l) {
                low[l] = v.seed[part + l][0];
                high[l] = v.seed[part + l][1];
            }
            const Keys keys{W::load_aligned(low), W::load_aligned(high)};
            for (std::int64_t g = 0; g < grains; ++g) {
                const std::uint32_t grain = first_grain + static_cast<std::uint32_t>(g);
                Grains at{};
                at.rolling = all;
                if constexpr (general) {
                    if constexpr (rough) forget_visits(v, part);
                    if (v.left != 0) choose_sides(v, part, grain, keys, at);
                }
                roll(v, part, grain, keys, v.start_energy, at);
                if constexpr (general)
                    if (v.steepest > 0) avalanche(v, part, grain, keys);
            }
        }
    }

private:
    static constexpr unsigned all = (1U << lanes) - 1;

    static SANDLANE_INLINE std::int32_t& height(const HeapView& v, int part, int lane, std::uint64_t place) {
        return v.heights[place * heap_lanes + static_cast<unsigned>(part + lane)];
    }

    // The side of the larger drop, either one if they are equal.
    static void choose_sides(const HeapView& v, int part, std::uint32_t grain, const Keys& keys, Grains& at) {
        const W zero(std::uint64_t{0});
        alignas(64) std::uint64_t random[lanes];
        random_words<Arch>(zero, W(std::uint64_t{grain}), zero, W(std::uint64_t{3}), keys.low, keys.high)
            .store_aligned(random);
        for (int l = 0; l < lanes; ++l) {
            const std::int32_t right = height(v, part, l, 1),
                               left = height(v, part, l, 1 + static_cast<std::uint64_t>(v.left));
            const bool goes_left = left < right || (left == right && (random[l] & 1) != 0);
            at.left[l] = goes_left ? static_cast<std::uint64_t>(v.left) : 0;
        }
    }

    // Of this grain at this place. A grain that only rolls is nowhere twice; the released ones of an
    // avalanche count as the grain that set it off.
    static SANDLANE_INLINE W visits(const HeapView& v, int part, const Grains& at) {
        if constexpr (!general) return W(std::uint64_t{0});
        alignas(64) std::uint64_t visit[lanes] = {};
        for (int l = 0; l < lanes; ++l) {
            if ((at.rolling >> l & 1) == 0) continue;
            visit[l] = v.visits[at.place[l] * heap_lanes + static_cast<unsigned>(part + l)]++;
            std::int64_t& reach = v.reach[part + l];
            if (static_cast<std::int64_t>(at.x[l]) > reach) reach = static_cast<std::int64_t>(at.x[l]);
        }
        return W::load_aligned(visit);
    }
    static void forget_visits(const HeapView& v, int part) {
        for (int l = 0; l < lanes; ++l) {
            for (std::int64_t x = 0; x <= v.reach[part + l]; ++x)
                for (const std::int64_t place : {x, x + v.left}) v.visits[place * heap_lanes + part + l] = 0;
            v.reach[part + l] = -1;
        }
    }

    static SANDLANE_INLINE D threshold(const HeapView& v, int part, std::uint32_t grain, const Keys& keys,
                                       const Grains& at) {
        if constexpr (!rough) return D(v.sticking);
        const D u =
            to_unit<Arch>(random_words<Arch>(W::load_aligned(at.place), W(std::uint64_t{grain}),
                                             visits(v, part, at), W(std::uint64_t{2}), keys.low, keys.high));
        return D(v.sticking) * (D(1 - v.roughness) + D(2 * v.roughness) * u);
    }

    // Returns a bit for each lane whose grain has left the column where it began.
    static unsigned roll(const HeapView& v, int part, std::uint32_t grain, const Keys& keys, double start,
                         Grains& at) {
        alignas(64) double here[lanes] = {}, next[lanes] = {};
        alignas(64) bool goes[lanes] = {};
        const auto last = static_cast<std::uint64_t>(v.columns - 1);
        D energy(start);
        unsigned moved = 0;
        while (at.rolling != 0) {
            for (int l = 0; l < lanes; ++l) {
                const bool rolls = (at.rolling >> l & 1) != 0;
                here[l] = height(v, part, l, at.place[l]);
                next[l] = rolls ? height(v, part, l, at.x[l] + 1 + at.left[l]) : here[l];
            }
            const D sum = energy + (D::load_aligned(here) - D::load_aligned(next));
            energy = D(v.retained) * sum;
            ((sum > D(0.0)) & (energy > threshold(v, part, grain, keys, at))).store_aligned(goes);
            for (int l = 0; l < lanes; ++l) {
                if ((at.rolling >> l & 1) == 0) continue;
                if (!goes[l]) {
                    ++height(v, part, l, at.place[l]);
                } else {
                    moved |= 1U << l;
                    at.place[l] = ++at.x[l] + at.left[l];
                    if (at.x[l] != last) continue;
                    ++v.lost[part + l];
                }
                at.rolling &= ~(1U << l);
            }
        }
        return moved;
    }

    static constexpr std::int64_t block = 8; // columns that are looked at together

    // Whether columns x, x + 1, ... of a block, from their place on, have no drop above the steepest, on any
    // heap.
    static SANDLANE_INLINE bool is_quiet(const HeapView& v, std::int64_t place) {
        using I = xsimd::batch<std::int32_t, Arch>;
        const I steepest(static_cast<std::int32_t>(v.steepest));
        const std::int32_t* h = v.heights + place * heap_lanes;
        I most(std::numeric_limits<std::int32_t>::min());
        for (std::int64_t n = 0; n < block * heap_lanes; n += static_cast<std::int64_t>(I::size))
            most = xsimd::max(most, I::load_unaligned(h + n) - I::load_unaligned(h + n + heap_lanes));
        return !xsimd::any(most > steepest);
    }

    // Columns of all heaps together, from the wall outwards; heaps at rest wait for the others.
    static void avalanche(const HeapView& v, int part, std::uint32_t grain, const Keys& keys) {
        const auto steepest = static_cast<std::int32_t>(v.steepest);
        for (unsigned active = all; active != 0;) {
            unsigned moved = 0;
            for (int side = 0; side < (v.left != 0 ? 2 : 1); ++side)
                for (std::int64_t x = 0; x + 1 < v.columns;) {
                    const std::int64_t left = side * v.left, place = x > 0 ? x + left : 0;
                    if (x > 0 && x + block < v.columns && is_quiet(v, place)) {
                        x += block;
                        continue;
                    }
                    unsigned steep = 0;
                    for (int l = 0; l < lanes; ++l) {
                        const std::int32_t drop =
                            height(v, part, l, static_cast<std::uint64_t>(place)) -
                            height(v, part, l, static_cast<std::uint64_t>(x + 1 + left));
                        steep |= (drop > steepest ? 1U : 0U) << l;
                    }
                    steep &= active;
                    if (steep != 0) moved |= release(v, part, grain, keys, x, place, left, steep);
                    ++x;
                }
            active &= moved;
        }
    }
    static unsigned release(const HeapView& v, int part, std::uint32_t grain, const Keys& keys,
                            std::int64_t x, std::int64_t place, std::int64_t left, unsigned steep) {
        Grains at{};
        at.rolling = steep;
        for (int l = 0; l < lanes; ++l) {
            at.x[l] = static_cast<std::uint64_t>(x);
            at.place[l] = static_cast<std::uint64_t>(place);
            at.left[l] = static_cast<std::uint64_t>(left);
            if ((steep >> l & 1) != 0) --height(v, part, l, at.place[l]);
        }
        const unsigned moved = roll(v, part, grain, keys, 0, at);
        for (int l = 0; l < lanes; ++l) v.released[part + l] += moved >> l & 1;
        return moved;
    }
};

} // namespace sandlane::simd
