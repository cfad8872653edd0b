// Sandpile: one sweep of tiles. Several heights lie in a word; no sum leaves its place, so words are added as
// they are.
#pragma once

#include "simd/automata/tables.hpp"
#include "simd/automata/words.hpp"

namespace sandlane::simd {

// Heights of `bytes` bytes. unit: a site topples once, else as often as its height allows. counting:
// topplings of each site are added up.
template <class Arch, int bytes, bool unit, bool counting = false> struct PileSweeps {
    using W = WordBatch<Arch>;
    static constexpr int bits = 8 * bytes;
    static constexpr std::uint64_t one = bytes == 1 ? 0x0101010101010101ULL : 0x0001000100010001ULL;
    static constexpr std::ptrdiff_t register_bytes = static_cast<std::ptrdiff_t>(8 * W::size);
    static constexpr int parts = static_cast<int>(strip_bytes / register_bytes);

    static SANDLANE_INLINE W load(const std::uint8_t* from) {
        return xsimd::bitwise_cast<W>(xsimd::batch<std::uint8_t, Arch>::load_unaligned(from));
    }
    static SANDLANE_INLINE void store(std::uint8_t* to, const W& words) {
        xsimd::bitwise_cast<xsimd::batch<std::uint8_t, Arch>>(words).store_unaligned(to);
    }
    // Topplings of each height.
    static SANDLANE_INLINE W topplings(const W& h) {
        constexpr std::uint64_t quarter = (std::uint64_t{1} << (bits - 2)) - 1;
        const W many = right<2>(h) & W(quarter * one);
        if constexpr (!unit) return many;
        return right<bits - 2>(many + W(quarter * one)) & W(one);
    }
    // Sums of neighbouring numbers, so that many can be added: of 16 bits, or 32 bits.
    static SANDLANE_INLINE W halved(const W& k) {
        constexpr std::uint64_t even = bytes == 1 ? 0x00ff00ff00ff00ffULL : 0x0000ffff0000ffffULL;
        return (k & W(even)) + (right<bits>(k) & W(even));
    }
    static std::uint64_t total(const W& sums) {
        alignas(64) std::uint64_t words[W::size];
        sums.store_aligned(words);
        std::uint64_t sum = 0;
        for (const std::uint64_t word : words)
            for (int at = 0; at < 64; at += 2 * bits)
                sum += word >> at & ((std::uint64_t{1} << (2 * bits)) - 1);
        return sum;
    }

    static void sweep(const PileView& v, const PileTiles& tiles) {
        const W all(~std::uint64_t{0});
        for (std::int32_t strip = tiles.first; strip < tiles.last; ++strip)
            for (int part = 0; part < parts; ++part) {
                const std::ptrdiff_t at = strip * std::ptrdiff_t{strip_bytes} + part * register_bytes;
                const W inner = strip + 1 == v.strips
                                    ? load_words<Arch>(v.inner + part * static_cast<int>(W::size))
                                    : all;
                const std::uint8_t* from = v.from + tiles.first_row * v.stride + at;
                std::uint8_t* to = v.to + tiles.first_row * v.stride + at;
                [[maybe_unused]] std::uint8_t* count =
                    counting ? v.odometer + tiles.first_row * v.stride + at : nullptr;
                W below = topplings(load(from - v.stride)), h = load(from), own = topplings(h);
                W sums(std::uint64_t{0}), change(std::uint64_t{0});
                for (std::int32_t row = tiles.first_row; row < tiles.last_row; ++row) {
                    const W next = load(from + v.stride), above = topplings(next);
                    const W in =
                        (below + above) + (topplings(load(from - bytes)) + topplings(load(from + bytes)));
                    const W kept = unit ? h - left<2>(own) : h & W(3 * one);
                    const W now = (kept + in) & inner;
                    store(to, now);
                    if constexpr (counting) {
                        store(count, load(count) + own);
                        count += v.stride;
                    }
                    sums = sums + halved(own);
                    change = change | (h ^ now);
                    below = own;
                    own = above;
                    h = next;
                    from += v.stride;
                    to += v.stride;
                }
                tiles.topplings[strip] += total(sums);
                if (xsimd::any(change != W(std::uint64_t{0}))) tiles.changed[strip] = 1;
            }
    }
};

} // namespace sandlane::simd
