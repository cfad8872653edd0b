// The completely vectorised lattice algorithm (docs/physics.md 10, 2.147-2.154): lanes are eight
// neighbouring sites, partners are contiguous shifted loads. The distance stage is branch-free; contacts are
// compressed to pairs and evaluated packed.
#pragma once

#include "simd/groups.hpp"
#include "simd/md/pairs.ipp"

namespace sandlane::simd {

// Finds the contacts of the sites of one row with the mask offsets [k_begin, k_end). The pointers and the
// number of pairs are local copies: through the views the compiler would have to reload them after every
// store.
template <class Arch, bool many_radii>
SANDLANE_INLINE std::int64_t sweep_row(const LatticeView& lattice, const PairView& view, PairKernel kernel,
                                       Target target, std::int32_t row, int k_begin, int k_end,
                                       PairBuffer& pairs) {
    using G = Group<Arch>;
    static_assert(site_group == group_width);
    const G occupied_below(0.5F * empty_site);
    const G uniform(lattice.uniform_square);
    const float *const xs = lattice.x, *const ys = lattice.y, *const radii = lattice.radius;
    const float *const offset_x = lattice.offset_x, *const offset_y = lattice.offset_y;
    const std::int32_t *const owner = lattice.owner, *const offsets = lattice.offsets;
    std::int64_t occupied = 0;
    std::int32_t count = pairs.count;
    const std::ptrdiff_t row_start = lattice.origin + row * lattice.row_stride;
    for (std::int32_t column = 0; column < lattice.columns; column += site_group) {
        const std::ptrdiff_t site = row_start + column;
        const G x = G::load(xs + site);
        const std::int32_t left = lattice.columns - column;
        const unsigned inside = left >= site_group ? 0xffffU : (1U << left) - 1U;
        const unsigned centres = less(x, occupied_below) & inside;
        if (centres == 0) continue;
        occupied += __builtin_popcount(centres);
        const G y = G::load(ys + site);
        const Integers<Arch, site_group> own(owner + site);
        G radius;
        if constexpr (many_radii) radius = G::load(radii + site);
        for (int k = k_begin; k < k_end; ++k) {
            const std::ptrdiff_t partner = site + offsets[k];
            const G dx = G::load(xs + partner) - x + G(offset_x[k]);
            const G dy = G::load(ys + partner) - y + G(offset_y[k]);
            const G square = dx * dx + dy * dy;
            unsigned hits;
            if constexpr (many_radii) {
                const G sum = G::load(radii + partner) + radius;
                hits = less(square, sum * sum) & centres;
            } else {
                hits = less(square, uniform) & centres;
            }
            own.compress(hits, pairs.i + count);
            Integers<Arch, site_group>(owner + partner).compress(hits, pairs.j + count);
            count += __builtin_popcount(hits);
        }
        if (count >= pair_chunk) {
            pairs.count = count;
            pairs.evaluate_full(view, kernel, target);
            count = pairs.count;
        }
    }
    pairs.count = count;
    return occupied;
}

// Full mask: every contact is met from both sides, each time for the first partner only.
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
