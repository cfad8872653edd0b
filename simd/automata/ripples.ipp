// Ripples in fixed numbers: saltation of a row into a buffer of its own, and creep of the rows of a tile.
#pragma once

#include "simd/automata/tables.hpp"
#include "simd/automata/words.hpp"

namespace sandlane::simd {

template <class Arch> struct RippleRows {
    using W = WordBatch<Arch>;
    using D = xsimd::batch<double, Arch>;
    static constexpr std::int32_t lanes = static_cast<std::int32_t>(W::size);

    static SANDLANE_INLINE W load(const std::int64_t* from) {
        return xsimd::bitwise_cast<W>(xsimd::batch<std::int64_t, Arch>::load_unaligned(from));
    }
    static SANDLANE_INLINE void store(std::int64_t* to, const W& value) {
        xsimd::bitwise_cast<xsimd::batch<std::int64_t, Arch>>(value).store_unaligned(to);
    }
    static SANDLANE_INLINE D column_numbers(std::int32_t first) {
        alignas(64) double n[D::size];
        for (std::int32_t i = 0; i < lanes; ++i) n[i] = first + i;
        return D::load_aligned(n);
    }

    // landing: 0 interpolated, 1 whole, 2 stochastic. Columns beyond the last are computed and not used.
    template <int landing>
    static void saltate(const RippleView& v, std::int32_t row, std::int64_t* scratch, RippleResult& result) {
        const std::int64_t* from = v.heights + row * v.stride;
        std::int64_t* to = v.landed + row * v.stride;
        std::int64_t *first = scratch,
                     *second = scratch + v.stride; // where to, and how much one cell farther
        const D unit(0x1p-32), length(v.length), wind(v.wind), zero(0.0),
            columns(static_cast<double>(v.columns)), transport(static_cast<double>(v.transport)),
            high(v.highest);
        const W q(static_cast<std::uint64_t>(v.transport));
        D tallest(0.0);
        for (std::int32_t x = 0; x < v.columns; x += lanes) {
            const W whole = load(from + x);
            const D h = to_double<Arch>(whole);
            tallest = xsimd::max(tallest, xsimd::max(h, zero - h));
            const D flight = length + wind * (h * unit);
            const D far = xsimd::max(zero, flight);
            D cells = xsimd::floor(far), share = far - cells;
            if constexpr (landing == 1) {
                cells = xsimd::floor(far + D(0.5));
                share = zero;
            }
            if constexpr (landing == 2) {
                const W index = to_whole<Arch>(column_numbers(x));
                const WordSource source{{v.seed[0], v.seed[1]}, static_cast<std::uint32_t>(row), v.step};
                const D u = to_unit<Arch>(random_words<Arch>(index, source, 5));
                share = xsimd::select(u < share, D(1.0), zero);
            }
            if (xsimd::any(flight < zero)) result.clamped += clamped(flight, v.columns - x);
            D at = column_numbers(x) + cells;
            if (xsimd::any(cells >= columns)) at = at - columns * xsimd::floor(at / columns);
            at = xsimd::select(at >= columns, at - columns, at);
            store(first + x, to_whole<Arch>(at));
            store(second + x, to_whole<Arch>(xsimd::floor(share * transport)));
            store(to + x, whole - q);
        }
        if (xsimd::any(tallest > high)) result.too_high = true;
        std::int64_t beyond = 0; // one cell beyond the last is the first
        for (std::int32_t x = 0; x < v.columns; ++x) {
            const std::int64_t at = first[x], share = second[x];
            to[at] += v.transport - share;
            std::int64_t& next = at + 1 == v.columns ? beyond : to[at + 1];
            next += share;
        }
        to[0] += beyond;
        to[-1] = to[v.columns - 1];
        to[v.columns] = to[0];
    }
    static std::int64_t clamped(const D& flight, std::int32_t left) {
        alignas(64) double values[D::size];
        flight.store_aligned(values);
        std::int64_t count = 0;
        for (std::int32_t i = 0; i < lanes && i < left; ++i) count += values[i] < 0 ? 1 : 0;
        return count;
    }

    template <int landing>
    static RippleResult saltation(const RippleView& v, std::int32_t first, std::int32_t last,
                                  std::int64_t* scratch) {
        RippleResult result;
        for (std::int32_t row = first; row < last; ++row) saltate<landing>(v, row, scratch, result);
        return result;
    }

    // floor(weight (a - b)).
    static SANDLANE_INLINE W flux(const W& a, const W& b, const D& weight) {
        return to_whole<Arch>(xsimd::floor(weight * to_double<Arch>(a - b)));
    }

    // What flows from a row to the one above, straight, to the right and to the left, [3][columns]. turned:
    // the upper row has the smaller index (periodic sides).
    static void flow_up(const RippleView& v, const std::int64_t* lower, const std::int64_t* upper,
                        bool turned, std::int64_t* out) {
        const D straight(v.near), diagonal(v.far);
        const W zero(std::uint64_t{0});
        const auto bond = [&](const std::int64_t* a, const std::int64_t* b, const D& weight) {
            return turned ? zero - flux(load(b), load(a), weight) : flux(load(a), load(b), weight);
        };
        for (std::int32_t x = 0; x < v.columns; x += lanes) {
            store(out + x, bond(lower + x, upper + x, straight));
            store(out + v.stride + x, bond(lower + x, upper + x + 1, diagonal));
            store(out + 2 * v.stride + x, bond(lower + x, upper + x - 1, diagonal));
        }
    }

    static void creep(const RippleView& v, std::int32_t first, std::int32_t last, std::int64_t* scratch) {
        const std::ptrdiff_t n = v.stride;
        std::int64_t *level = scratch + pad, *below = level + n, *above = below + 3 * n;
        const auto row = [&](std::int32_t y) { return v.landed + ((y + v.rows) % v.rows) * n; };
        const D straight(v.rows == 1 ? v.line : v.near);
        const bool plane = v.rows > 1;
        if (plane) flow_up(v, row(first - 1), row(first), first == 0, below);
        for (std::int32_t y = first; y < last; ++y) {
            const std::int64_t* h = row(y);
            for (std::int32_t x = 0; x < v.columns; x += lanes)
                store(level + x, flux(load(h + x), load(h + x + 1), straight));
            // From the last to the first column: the first has the smaller index.
            const double turned =
                (v.rows == 1 ? v.line : v.near) * static_cast<double>(h[0] - h[v.columns - 1]);
            level[v.columns - 1] = -static_cast<std::int64_t>(floor_of(turned));
            level[-1] = level[v.columns - 1];
            std::int64_t* to = v.heights + y * n;
            if (!plane) {
                for (std::int32_t x = 0; x < v.columns; x += lanes)
                    store(to + x, load(h + x) + load(level + x - 1) - load(level + x));
                continue;
            }
            flow_up(v, h, row(y + 1), y + 1 == v.rows, above);
            below[n - 1] = below[n + v.columns - 1]; // what comes in across the periodic ends
            below[2 * n + v.columns] = below[2 * n];
            for (std::int32_t x = 0; x < v.columns; x += lanes) {
                const W in = (load(level + x - 1) + load(below + x)) +
                             (load(below + n + x - 1) + load(below + 2 * n + x + 1));
                const W out =
                    (load(level + x) + load(above + x)) + (load(above + n + x) + load(above + 2 * n + x));
                store(to + x, load(h + x) + in - out);
            }
            std::int64_t* swapped = below;
            below = above;
            above = swapped;
        }
    }
    static constexpr std::ptrdiff_t pad = ripple_pad;
    static double floor_of(double value) {
        const auto whole = static_cast<double>(static_cast<std::int64_t>(value));
        return whole > value ? whole - 1 : whole;
    }
};

} // namespace sandlane::simd
