// Heaps: a grain on each of eight heaps at once, a heap to a lane. All grains start at the same column, so
// that those which still roll are always on the same one.
#pragma once

#include "simd/automata/tables.hpp"
#include "simd/automata/words.hpp"

#include <algorithm>

namespace sandlane::simd {

// rough: thresholds are drawn. general: two sides, or avalanches.
template <class Arch, bool rough, bool general> struct HeapLanes {
    using W = WordBatch<Arch>;
    using D = xsimd::batch<double, Arch>;
    using B = xsimd::batch_bool<double, Arch>;
    static constexpr int lanes = static_cast<int>(D::size);

    // All bits of the lanes.
    static SANDLANE_INLINE W ones_where(const B& where) {
        return xsimd::bitwise_cast<W>(
            xsimd::select(where, xsimd::bitwise_cast<D>(W(~std::uint64_t{0})), D(0.0)));
    }

    // A part of the heaps as wide as a register, and their seeds.
    struct Part {
        const HeapView& v;
        int first;
        W low, high;

        Part(const HeapView& view, int lane) : v(view), first(lane) {
            alignas(64) std::uint64_t l[lanes], h[lanes];
            for (int k = 0; k < lanes; ++k) {
                l[k] = v.seed[first + k][0];
                h[k] = v.seed[first + k][1];
            }
            low = W::load_aligned(l);
            high = W::load_aligned(h);
        }
        SANDLANE_INLINE double* row(std::int64_t place) const {
            return v.heights + place * heap_lanes + first;
        }
        SANDLANE_INLINE D heights(std::int64_t place) const { return D::load_unaligned(row(place)); }
        SANDLANE_INLINE void add(std::int64_t place, const B& where, double grains) const {
            (heights(place) + xsimd::select(where, D(grains), D(0.0))).store_unaligned(row(place));
        }
        void count(std::int64_t* counts, const B& where) const {
            alignas(64) std::uint64_t ones[lanes];
            (ones_where(where) & W(std::uint64_t{1})).store_aligned(ones);
            for (int l = 0; l < lanes; ++l) counts[first + l] += static_cast<std::int64_t>(ones[l]);
        }
    };
    // Grains that start at column x of the right side or, where `left`, of the left one.
    struct Start {
        std::int64_t x;
        double energy;
        B left, rolling;
    };

    static void drop(const HeapView& v, std::uint32_t first_grain, std::int64_t grains) {
        for (int first = 0; first < heap_lanes; first += lanes) {
            const Part part(v, first);
            for (std::int64_t g = 0; g < grains; ++g) {
                const std::uint32_t grain = first_grain + static_cast<std::uint32_t>(g);
                Start start{0, v.start_energy, B(false), B(true)};
                if constexpr (general) {
                    if (v.left != 0) start.left = steeper_sides(part, grain);
                }
                std::int64_t reach = roll(part, grain, start).reach;
                if (!general || v.steepest == 0) continue;
                reach = std::max(reach, avalanche(part, grain));
                if constexpr (rough) forget_visits(part, reach);
            }
        }
    }

private:
    // The side of the larger drop, either one by a random bit if they are equal.
    static B steeper_sides(const Part& p, std::uint32_t grain) {
        const W zero(std::uint64_t{0});
        const W random =
            random_words<Arch>(zero, W(std::uint64_t{grain}), zero, W(std::uint64_t{3}), p.low, p.high);
        const B odd = to_double<Arch>(random & W(std::uint64_t{1})) > D(0.0);
        const D right = p.heights(1), left = p.heights(1 + p.v.left);
        return (left < right) | ((left == right) & odd);
    }

    // By the number of visits of this grain before. One that only rolls is nowhere twice; those that an
    // avalanche releases count as the grain that set it off.
    static SANDLANE_INLINE W visits(const Part& p, std::int64_t x, const B& left, const B& rolling) {
        if (!general || p.v.steepest == 0) return W(std::uint64_t{0});
        const W one(std::uint64_t{1});
        const auto visit = [&](std::int64_t place, const B& where) {
            std::uint64_t* row = p.v.visits + place * heap_lanes + p.first;
            const W old = load_words<Arch>(row), here = ones_where(where);
            (old + (here & one)).store_unaligned(row);
            return old & here;
        };
        if (p.v.left == 0 || x == 0) return visit(x, rolling);
        return visit(x, rolling & !left) | visit(x + p.v.left, rolling & left);
    }
    static void forget_visits(const Part& p, std::int64_t reach) {
        for (std::int64_t x = 0; x <= reach; ++x)
            for (const std::int64_t place : {x, x + p.v.left})
                W(std::uint64_t{0}).store_unaligned(p.v.visits + place * heap_lanes + p.first);
    }

    static SANDLANE_INLINE D threshold(const Part& p, std::uint32_t grain, std::int64_t x, const B& left,
                                       const B& rolling) {
        const HeapView& v = p.v;
        if constexpr (!rough) return D(v.sticking);
        W place(static_cast<std::uint64_t>(x));
        if constexpr (general) {
            if (x > 0) place = place + (ones_where(left) & W(static_cast<std::uint64_t>(v.left)));
        }
        const D u = to_unit<Arch>(random_words<Arch>(
            place, W(std::uint64_t{grain}), visits(p, x, left, rolling), W(std::uint64_t{2}), p.low, p.high));
        return D(v.sticking) * (D(1 - v.roughness) + D(2 * v.roughness) * u);
    }

    struct Rolled {
        B moved;            // grains that have left the column where they began
        std::int64_t reach; // the last column that was visited
    };
    static Rolled roll(const Part& p, std::uint32_t grain, const Start& start) {
        const HeapView& v = p.v;
        const auto heights = [&](std::int64_t x) {
            if constexpr (!general) return p.heights(x);
            if (v.left == 0 || x == 0) return p.heights(x);
            return xsimd::select(start.left, p.heights(x + v.left), p.heights(x));
        };
        B rolling = start.rolling, moved = rolling;
        D energy(start.energy), here = heights(start.x);
        std::int64_t x = start.x;
        for (;; ++x) {
            const D next = heights(x + 1), sum = energy + (here - next);
            energy = D(v.retained) * sum;
            const B goes = (sum > D(0.0)) & (energy > threshold(p, grain, x, start.left, rolling)),
                    stays = rolling & !goes;
            if (xsimd::any(stays)) {
                if (!general || v.left == 0 || x == 0) {
                    p.add(x, stays, 1);
                } else {
                    p.add(x, stays & !start.left, 1);
                    p.add(x + v.left, stays & start.left, 1);
                }
                rolling = rolling & goes;
                if (x == start.x) moved = rolling;
                if (!xsimd::any(rolling)) break;
            }
            if (x + 2 == v.columns) {
                p.count(v.lost, rolling);
                break;
            }
            here = next;
        }
        return {moved, x};
    }

    // Columns of all heaps together, from the wall outwards; heaps at rest wait for the others. Returns the
    // last column that was visited.
    static std::int64_t avalanche(const Part& p, std::uint32_t grain) {
        const HeapView& v = p.v;
        const D steepest(static_cast<double>(v.steepest));
        std::int64_t reach = 0;
        for (B active(true); xsimd::any(active);) {
            B moved(false);
            for (int side = 0; side < (v.left != 0 ? 2 : 1); ++side)
                for (std::int64_t x = 0; x + 1 < v.columns; ++x) {
                    const std::int64_t left = side * v.left, place = x > 0 ? x + left : 0;
                    const B steep = active & (p.heights(place) - p.heights(x + 1 + left) > steepest);
                    if (!xsimd::any(steep)) continue;
                    p.add(place, steep, -1);
                    const Rolled rolled = roll(p, grain, {x, 0, B(side != 0), steep});
                    p.count(v.released, rolled.moved);
                    moved = moved | rolled.moved;
                    reach = std::max(reach, rolled.reach);
                }
            active = active & moved;
        }
        return reach;
    }
};

} // namespace sandlane::simd
