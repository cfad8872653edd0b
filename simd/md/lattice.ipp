// The completely vectorised lattice algorithm (md-vectorised-lattice 1.2, 2.147-2.154): lanes are eight
// neighbouring sites, partners are contiguous shifted loads. The distance stage is branch-free; contacts are
// compressed to pairs and evaluated packed (item 24a).
#pragma once

#include "simd/md/pairs.ipp"

namespace sandlane::simd {

// Finds the contacts of the sites of one row with the mask offsets [k_begin, k_end).
template <class Arch, bool many_radii>
SANDLANE_INLINE std::int64_t sweep_row(const LatticeView& lattice, const PairView& view, PairKernel kernel,
                                       Target target, std::int32_t row, int k_begin, int k_end,
                                       PairBuffer& pairs) {
    using R = Block<Arch>;
    const R margin(candidate_margin);
    const R occupied_below(0.5 * empty_site);
    const R uniform(lattice.uniform_square * candidate_margin);
    std::int64_t occupied = 0;
    const std::ptrdiff_t row_start = lattice.origin + row * lattice.row_stride;
    for (std::int32_t column = 0; column < lattice.columns; column += width) {
        const std::ptrdiff_t site = row_start + column;
        const R x = load<Arch>(lattice.x + site);
        const std::int32_t left = lattice.columns - column;
        const unsigned inside = left >= width ? 0xffu : (1u << left) - 1u;
        const unsigned centres = bits(x < occupied_below) & inside;
        if (centres == 0) continue;
        occupied += __builtin_popcount(centres);
        const R y = load<Arch>(lattice.y + site);
        R radius;
        if constexpr (many_radii) radius = load<Arch>(lattice.radius + site);
        for (int k = k_begin; k < k_end; ++k) {
            const std::ptrdiff_t partner = site + lattice.offsets[k];
            const R dx = load<Arch>(lattice.x + partner) - x;
            const R dy = load<Arch>(lattice.y + partner) - y;
            const R square = dx * dx + dy * dy;
            unsigned hits;
            if constexpr (many_radii) {
                const R sum = load<Arch>(lattice.radius + partner) + radius;
                hits = bits(square < sum * sum * margin) & centres;
            } else {
                hits = bits(square < uniform) & centres;
            }
            Compress<Arch>::apply(lattice.owner + site, hits, pairs.i + pairs.count);
            Compress<Arch>::apply(lattice.owner + partner, hits, pairs.j + pairs.count);
            pairs.count += __builtin_popcount(hits);
            if (pairs.count >= pair_chunk) pairs.evaluate_full(view, kernel, target);
        }
    }
    return occupied;
}

// Full mask: every contact is met from both sides, each time for the first partner only (item 31).
template <class Arch, bool many_radii>
SweepResult lattice_full(const LatticeView& lattice, const PairView& view, PairKernel kernel,
                         std::int32_t row_begin, std::int32_t row_end) {
    const int side = 2 * lattice.reach + 1;
    PairBuffer pairs;
    SweepResult result;
    for (std::int32_t row = row_begin; row < row_end; ++row)
        result.occupied +=
            sweep_row<Arch, many_radii>(lattice, view, kernel, Target::first, row, 0, side * side - 1, pairs);
    pairs.evaluate_rest(view, kernel, Target::first);
    result.largest_overlap = pairs.largest_overlap;
    return result;
}

// Half mask inside a tile of rows, both partners at once; contacts with a row of another tile are evaluated
// once in each tile for the partner that lies in it. No tile writes into another, and the order of additions
// depends on the tile height only.
template <class Arch, bool many_radii>
SweepResult lattice_half(const LatticeView& lattice, const PairView& view, PairKernel kernel,
                         std::int32_t row_begin, std::int32_t row_end) {
    const int side = 2 * lattice.reach + 1;
    const int half_begin = (side * side - 1) / 2;
    // Offsets of row distance a end at half_end(a): `reach` of the own row, then whole rows of the mask.
    const auto half_end = [&](int a) { return half_begin + lattice.reach + a * side; };
    PairBuffer pairs;
    SweepResult result;
    for (std::int32_t row = row_begin - lattice.reach; row < row_begin; ++row)
        sweep_row<Arch, many_radii>(lattice, view, kernel, Target::second, row, half_end(row_begin - row - 1),
                                    half_end(lattice.reach), pairs);
    pairs.evaluate_rest(view, kernel, Target::second);
    for (std::int32_t row = row_begin; row < row_end; ++row) {
        const int within = row_end - 1 - row < lattice.reach ? row_end - 1 - row : lattice.reach;
        result.occupied += sweep_row<Arch, many_radii>(lattice, view, kernel, Target::both, row, half_begin,
                                                       half_end(within), pairs);
    }
    pairs.evaluate_rest(view, kernel, Target::both);
    const std::int32_t last = row_end - lattice.reach > row_begin ? row_end - lattice.reach : row_begin;
    for (std::int32_t row = last; row < row_end; ++row)
        sweep_row<Arch, many_radii>(lattice, view, kernel, Target::first, row, half_end(row_end - 1 - row),
                                    half_end(lattice.reach), pairs);
    pairs.evaluate_rest(view, kernel, Target::first);
    result.largest_overlap = pairs.largest_overlap;
    return result;
}

} // namespace sandlane::simd
