// Collisions in the cells of a tile by the method without a time counter. Candidate k of all cells is looked
// at together: they are in different cells, so lanes never meet the same particle, and candidate k + 1 sees
// what k did. Random numbers belong to (k, cell, step), so the result is that of one cell after the other.
#pragma once

#include "laws/collision.hpp"
#include "simd/compress.hpp"
#include "simd/dsmc/kinds.hpp"
#include "simd/dsmc/rows_of_four.hpp"
#include "simd/dsmc/tables.hpp"
#include "simd/words.hpp"

#include <cstring>

namespace sandlane::simd {

// Extent of the velocities of n >= 2 rows, by column: no two differ by more than its diagonal.
template <class Arch>
SANDLANE_INLINE void velocity_extent(const double* velocity, std::int32_t n, double* row) {
    using R = Block<Arch>; // two rows
    R low = load<Arch>(velocity), high = low;
    const auto take = [&](std::int32_t k) {
        const R rows = load<Arch>(velocity + std::ptrdiff_t{k} * gas_row);
        low = min(low, rows);
        high = max(high, rows);
    };
    constexpr std::int32_t usual = 16;
    if (n > 4 && n <= usual) { // always the same number of rows, the last ones again: no branch to mispredict
        for (std::int32_t k = 2; k < usual; k += 2) take(k < n - 2 ? k : n - 2);
    } else {
        for (std::int32_t k = 2; k + 1 < n; k += 2) take(k);
        take(n - 2);
    }
    store_extent(high, low, row);
}

// Sums x_{d-1} and x_d of the diameters in a cell of a mixture.
template <class Arch>
SANDLANE_INLINE void add_moments(const GasMixture& mixture, const double* velocity, std::int32_t n,
                                 double& lower, double& upper) {
    lower = upper = 0;
    for (std::int32_t i = 0; i < n; ++i) {
        std::uint64_t word;
        std::memcpy(&word, velocity + std::ptrdiff_t{i} * gas_row + 3, sizeof word);
        lower += mixture.lower_moment[word >> 60];
        upper += mixture.upper_moment[word >> 60];
    }
}

// The cells that still have candidates, and the pairs that were accepted, as lists of numbers; whole numbers
// and offsets as words.
struct CandidateLists {
    double *rows, *number, *majorant, *candidates; // rows: first row, and number of rows in the upper half
    double *first, *second, *cell;                 // byte offsets of the velocities; number of the cell
    double* crowding;                              // of a mixture: h of laws::contact_of_pair

    SANDLANE_INLINE explicit CandidateLists(const GasCollisionView& view)
        : rows(view.list[0]), number(view.list[1]), majorant(view.list[2]), candidates(view.list[3]),
          first(view.list[4]), second(view.list[5]), cell(view.list[6]), crowding(view.list[7]) {}
};
template <class Arch> SANDLANE_INLINE Words<Arch> load_words(const double* from) {
    return words_of(load<Arch>(from));
}
template <class Arch> SANDLANE_INLINE void append(const Words<Arch>& words, unsigned chosen, double* to) {
    compress(block_of(words), chosen, to);
}

// Number of candidates of every cell; fills the list of the cells that have any and returns its length.
template <class Arch, int dimension, bool mixed>
SANDLANE_INLINE std::int32_t count_candidates(const GasCollisionView& view, const Philox& random,
                                              const CandidateLists& lists, GasCollisions& result) {
    using R = Block<Arch>;
    using W = Words<Arch>;
    const double* velocity = view.rows.velocity;
    std::int32_t active = 0;
    for (std::int32_t first = 0; first < view.cells; first += width) {
        alignas(64) double size[width], extents[width * gas_row], lower[width] = {}, upper[width] = {};
        alignas(64) std::uint64_t cell[width], rows[width];
        const std::int32_t end = view.cells - first < width ? view.cells - first : width;
        bool pairs = false;
        for (std::int32_t l = 0; l < width; ++l) {
            size[l] = 0;
            rows[l] = 0;
            cell[l] = static_cast<std::uint64_t>(view.first_cell + first + l);
            if (l >= end) continue;
            const std::int32_t begin = view.start[first + l], n = view.start[first + l + 1] - begin;
            if (n < 2) continue;
            pairs = true;
            size[l] = n;
            rows[l] = static_cast<std::uint64_t>(begin) | static_cast<std::uint64_t>(n) << 32;
            velocity_extent<Arch>(velocity + std::ptrdiff_t{begin} * gas_row, n, extents + l * gas_row);
            if constexpr (mixed)
                if (view.mixture->dense)
                    add_moments<Arch>(*view.mixture, velocity + std::ptrdiff_t{begin} * gas_row, n, lower[l],
                                      upper[l]);
        }
        if (!pairs) continue;
        R extent[gas_row];
        Rows<Arch, gas_row>::load(extents, extent);
        const R square = extent[0] * extent[0] + extent[1] * extent[1] + extent[2] * extent[2];
        const R n = load<Arch>(size);
        R majorant = select(n > R(1.0), R(view.margin) * sqrt(square), R(0.0)), crowding(0.0);
        R factor(1.0);
        if constexpr (mixed) {
            const R others = (n - R(2.0)) / max(n, R(2.0));
            const R free =
                R(1.0) - min(load<Arch>(upper) * others, R(laws::freezing_fraction[dimension - 2]));
            crowding = load<Arch>(lower) * others / free;
            majorant =
                majorant * laws::contact_of_pair(dimension, R(view.mixture->largest_contact) * crowding);
            factor = R(1.0) / free;
        } else if (view.packing > 0) {
            factor = laws::contact_correlation(dimension, R(view.packing) * (n - R(2.0)));
        }
        R mean = R(view.rate) * (n * (n - R(1.0))) * majorant * factor;
        if (view.maxwell > 0) { // no speed is below zero times the random number, so that all collide
            mean = select(n > R(1.0), R(view.maxwell) * n, R(0.0));
            majorant = R(0.0);
        }
        const W numbers = W::load(cell);
        const PhiloxLanes<Arch> draw = random(numbers);
        const R wanted = floor(mean + unit_number(draw.w[0], draw.w[1]));
        const auto possible = wanted < R(most_candidates);
        result.overflows += width - __builtin_popcount(bits(possible));
        const unsigned chosen = bits(possible & (wanted > R(0.0)));
        append(W::load(rows), chosen, lists.rows + active);
        append(numbers, chosen, lists.number + active);
        compress(majorant, chosen, lists.majorant + active);
        compress(wanted, chosen, lists.candidates + active);
        if constexpr (mixed) compress(crowding, chosen, lists.crowding + active);
        active += __builtin_popcount(chosen);
    }
    return active;
}

// Says what became of candidate k of the cells of a block.
template <class Arch>
SANDLANE_INLINE void tell(const GasCollisionView& view, const std::uint64_t (&offsets)[2][width],
                          const Words<Arch>& number, std::uint32_t k, unsigned real, unsigned accepted) {
    alignas(64) std::uint64_t cell[width];
    number.store(cell);
    const auto identity = [&](std::uint64_t offset) {
        std::uint32_t id;
        std::memcpy(&id, reinterpret_cast<const char*>(view.rows.place + 3) + offset, sizeof id);
        return id;
    };
    for (int l = 0; l < width; ++l)
        if ((real >> l & 1u) != 0)
            view.listener.hear(view.listener.to,
                               {static_cast<std::uint32_t>(cell[l]), k, identity(offsets[0][l]),
                                identity(offsets[1][l]), (accepted >> l & 1u) != 0});
}

// Number of the partner that is nearest to i: of j and of more that are drawn, the first of equal ones.
template <class Arch>
SANDLANE_INLINE Words<Arch> nearest_partner(const GasCollisionView& view, const PhiloxLanes<Arch>& draw,
                                            const Words<Arch>& begin, const Words<Arch>& size,
                                            const Words<Arch>& i, const Words<Arch>& j) {
    using R = Block<Arch>;
    using W = Words<Arch>;
    const auto place_of = [&](const W& n, R(&x)[gas_row]) {
        alignas(64) std::uint64_t offset[width];
        left<5>(n + begin).store(offset);
        gather_rows(view.rows.place, offset, x);
    };
    R own[gas_row];
    place_of(i, own);
    const auto square_to = [&](const W& n) {
        R other[gas_row], sum(0.0);
        place_of(n, other);
        for (int d = 0; d < 3; ++d)
            sum = sum + R(view.near_axis[d]) * ((own[d] - other[d]) * (own[d] - other[d]));
        return sum;
    };
    R square = square_to(j), best = block_of(j);
    for (std::int32_t n = 1; n < view.partners; ++n) {
        W other = right<32>(product(draw.w[n - 1], size - W(1)));
        other = other + W(1) - right<63>(other - i);
        const R apart = square_to(other);
        const auto nearer = apart < square;
        square = select(nearer, apart, square);
        best = select(nearer, block_of(other), best);
    }
    return words_of(best);
}

// Candidate k of the listed cells: appends the accepted pairs to their lists and keeps the cells that have
// more candidates; returns the number of either.
struct Chosen {
    std::int32_t accepted, left;
};
template <class Arch, int dimension, bool mixed, bool heard, bool near>
SANDLANE_INLINE Chosen choose_pairs(const GasCollisionView& view, const Philox& random,
                                    const Philox& partners, const CandidateLists& lists, std::int32_t active,
                                    std::uint32_t k, GasCollisions& result) {
    using R = Block<Arch>;
    using W = Words<Arch>;
    Chosen chosen{0, 0};
    const R next(k + 1);
    for (int l = 0; l < width; ++l) { // behind the last one anything valid
        lists.rows[active + l] = lists.rows[0];
        lists.majorant[active + l] = lists.majorant[0];
    }
    for (std::int32_t at = 0; at < active; at += width) {
        const unsigned real = active - at >= width ? 0xffu : (1u << (active - at)) - 1u;
        const W rows = load_words<Arch>(lists.rows + at), number = load_words<Arch>(lists.number + at);
        const R most = load<Arch>(lists.majorant + at), candidates = load<Arch>(lists.candidates + at);
        const PhiloxLanes<Arch> draw = random(number);
        const W begin = rows & W(0xffffffffu), size = right<32>(rows);
        const W i = right<32>(product(draw.w[0], size));
        W j = right<32>(product(draw.w[1], size - W(1)));
        j = j + W(1) - right<63>(j - i); // the sign bit says j < i
        if constexpr (near) j = nearest_partner<Arch>(view, partners(number), begin, size, i, j);
        const W first = left<5>(i + begin), second = left<5>(j + begin);
        static_assert(gas_row * sizeof(double) == 1 << 5);
        alignas(64) std::uint64_t offsets[2][width];
        first.store(offsets[0]);
        second.store(offsets[1]);
        R a[gas_row], b[gas_row];
        gather_rows(view.rows.velocity, offsets[0], a);
        gather_rows(view.rows.velocity, offsets[1], b);
        const Vector<R> g{a[0] - b[0], a[1] - b[1], a[2] - b[2]};
        R speed = sqrt(dot(g, g));
        R crowding(0.0);
        if constexpr (mixed) { // times what their kinds collide more or less often
            crowding = load<Arch>(lists.crowding + at);
            const W pair = pair_of(kind_of(a[3]), kind_of(b[3]));
            const R contact = look_up(view.mixture->contact, pair) * crowding;
            speed = look_up(view.mixture->section, pair) * laws::contact_of_pair(dimension, contact) * speed;
        }
        const unsigned yes = bits(unit_number(draw.w[2], draw.w[3]) * most < speed) & real;
        result.violations += __builtin_popcount(bits(speed > most) & real);
        if constexpr (heard) tell(view, offsets, number, k, real, yes);
        append(first, yes, lists.first + chosen.accepted);
        append(second, yes, lists.second + chosen.accepted);
        append(number, yes, lists.cell + chosen.accepted);
        chosen.accepted += __builtin_popcount(yes);
        const unsigned more = bits(candidates > next) & real;
        append(rows, more, lists.rows + chosen.left);
        append(number, more, lists.number + chosen.left);
        compress(most, more, lists.majorant + chosen.left);
        compress(candidates, more, lists.candidates + chosen.left);
        if constexpr (mixed) compress(crowding, more, lists.crowding + chosen.left);
        chosen.left += __builtin_popcount(more);
    }
    return chosen;
}

// Collisions of the accepted pairs from `at` on, up to eight. They share no particle.
template <class Arch, int dimension, bool rough, bool mixed>
SANDLANE_INLINE void collide_pairs(const GasCollisionView& view, const Philox& random,
                                   const CandidateLists& lists, std::int32_t at, std::int32_t lanes) {
    using R = Block<Arch>;
    alignas(64) std::uint64_t first[width], second[width];
    load_words<Arch>(lists.first + at).store(first);
    load_words<Arch>(lists.second + at).store(second);
    const PhiloxLanes<Arch> draw = random(load_words<Arch>(lists.cell + at));
    const R u1 = unit_number(draw.w[0], draw.w[1]);
    R a[gas_row], b[gas_row];
    gather_rows(view.rows.velocity, first, a);
    gather_rows(view.rows.velocity, second, b);
    const Vector<R> g{a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    const R speed = sqrt(dot(g, g));
    Vector<R> e;
    if constexpr (dimension == 3) {
        R sine, cosine;
        laws::sine_cosine_of_turn(unit_number(draw.w[2], draw.w[3]), sine, cosine);
        e = laws::direction_in_space(g, speed, u1, sine, cosine);
    } else {
        e = laws::direction_in_plane(g, speed, u1);
    }
    const R normal = dot(g, e);
    R eps, share_a(0.5), share_b(0.5), radius_a(view.radius), radius_b(view.radius);
    if constexpr (mixed) {
        const Words<Arch> i = kind_of(a[3]), j = kind_of(b[3]), pair = pair_of(i, j);
        eps = laws::restitution_of_pair(view.restitution, look_up(view.mixture->coefficient, pair), -normal);
        share_a = look_up(view.mixture->share, pair);
        share_b = look_up(view.mixture->share, pair_of(j, i));
        radius_a = look_up(view.mixture->radius, i);
        radius_b = look_up(view.mixture->radius, j);
    } else {
        eps = laws::restitution(view.restitution, -normal);
    }
    Vector<R> push;
    if constexpr (rough) {
        R s[gas_row], t[gas_row];
        gather_rows(view.rows.spin, first, s);
        gather_rows(view.rows.spin, second, t);
        Vector<R> spin;
        if constexpr (mixed)
            spin = {radius_a * s[0] + radius_b * t[0], radius_a * s[1] + radius_b * t[1],
                    radius_a * s[2] + radius_b * t[2]};
        else
            spin = {radius_a * (s[0] + t[0]), radius_a * (s[1] + t[1]), radius_a * (s[2] + t[2])};
        const Vector<R> contact = g - cross(spin, e);
        R tangential(view.tangential);
        if (view.friction > 0) {
            const R along = dot(contact, e);
            const Vector<R> across = contact - along * e;
            tangential = laws::sliding_restitution(tangential, R(view.friction), eps, R(view.mass_ratio),
                                                   -along, sqrt(dot(across, across)));
        }
        push = laws::impulse(contact, e, eps, tangential, R(view.mass_ratio));
        const Vector<R> across = cross(e, push);
        Vector<R> turn_a, turn_b;
        if constexpr (mixed) {
            turn_a = (share_a / (R(view.inertia) * radius_a)) * across;
            turn_b = (share_b / (R(view.inertia) * radius_b)) * across;
        } else {
            turn_a = turn_b = R(0.5 / (view.inertia * view.radius)) * across;
        }
        s[0] = s[0] - turn_a.x, s[1] = s[1] - turn_a.y, s[2] = s[2] - turn_a.z;
        t[0] = t[0] - turn_b.x, t[1] = t[1] - turn_b.y, t[2] = t[2] - turn_b.z;
        scatter_rows(s, view.rows.spin, first, lanes);
        scatter_rows(t, view.rows.spin, second, lanes);
    } else {
        push = laws::smooth_impulse(normal, e, eps);
    }
    const Vector<R> change_a = share_a * push, change_b = share_b * push;
    a[0] = a[0] + change_a.x, a[1] = a[1] + change_a.y, a[2] = a[2] + change_a.z;
    b[0] = b[0] - change_b.x, b[1] = b[1] - change_b.y, b[2] = b[2] - change_b.z;
    scatter_rows(a, view.rows.velocity, first, lanes);
    scatter_rows(b, view.rows.velocity, second, lanes);
}

template <class Arch, int dimension, bool rough, bool mixed>
GasCollisions collide_gas(const GasCollisionView& given) {
    const GasCollisionView view = given; // which no store can change
    const CandidateLists lists(view);
    const auto random = [&](std::uint32_t k, GasStream stream) {
        return Philox(k, view.random.step, view.random.last_word(stream), view.random.key);
    };
    GasCollisions result;
    std::int32_t active =
        count_candidates<Arch, dimension, mixed>(view, random(0, GasStream::rounding), lists, result);
    for (std::uint32_t k = 0; active > 0; ++k) {
        result.candidates += active;
        const Philox draws = random(k, GasStream::candidate);
        const bool heard = view.listener.hear != nullptr;
        Chosen chosen;
        if (view.partners > 1) {
            const Philox more = random(k, GasStream::partner);
            chosen = heard ? choose_pairs<Arch, dimension, mixed, true, true>(view, draws, more, lists,
                                                                              active, k, result)
                           : choose_pairs<Arch, dimension, mixed, false, true>(view, draws, more, lists,
                                                                               active, k, result);
        } else {
            chosen = heard ? choose_pairs<Arch, dimension, mixed, true, false>(view, draws, draws, lists,
                                                                               active, k, result)
                           : choose_pairs<Arch, dimension, mixed, false, false>(view, draws, draws, lists,
                                                                                active, k, result);
        }
        const Philox geometry = random(k, GasStream::geometry);
        for (int l = 0; l < width; ++l) { // behind the last one anything valid
            lists.first[chosen.accepted + l] = lists.first[0];
            lists.second[chosen.accepted + l] = lists.second[0];
        }
        for (std::int32_t at = 0; at < chosen.accepted; at += width)
            collide_pairs<Arch, dimension, rough, mixed>(
                view, geometry, lists, at, chosen.accepted - at < width ? chosen.accepted - at : width);
        result.collisions += chosen.accepted;
        active = chosen.left;
    }
    if (view.maxwell > 0) result.violations = 0;
    return result;
}

} // namespace sandlane::simd
