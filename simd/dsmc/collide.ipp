// Collisions in the cells of a tile by the method without a time counter. Candidate k of all cells is looked
// at together: they are in different cells, so lanes never meet the same particle, and candidate k + 1 sees
// what k did. Random numbers belong to (k, cell, step), so the result is that of one cell after the other.
#pragma once

#include "laws/collision.hpp"
#include "simd/compress.hpp"
#include "simd/dsmc/rows_of_four.hpp"
#include "simd/dsmc_tables.hpp"
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

// Number of candidates of every cell, and the list of the cells that have any; returns its length.
template <class Arch, int dimension>
SANDLANE_INLINE std::int32_t count_candidates(const GasCollisionView& view, GasCollisions& result) {
    using R = Block<Arch>;
    using W = Words<Arch>;
    const double* velocity = view.rows.velocity;
    std::int32_t active = 0;
    for (std::int32_t first = 0; first < view.cells; first += width) {
        alignas(64) double number[width], extents[width * gas_row];
        std::uint64_t cell[width];
        const std::int32_t end = view.cells - first < width ? view.cells - first : width;
        bool pairs = false;
        for (std::int32_t l = 0; l < width; ++l) {
            number[l] = 0;
            cell[l] = static_cast<std::uint64_t>(view.first_cell + first + l);
            if (l >= end) continue;
            const std::int32_t begin = view.start[first + l], n = view.start[first + l + 1] - begin;
            if (n < 2) continue;
            pairs = true;
            number[l] = n;
            velocity_extent<Arch>(velocity + std::ptrdiff_t{begin} * gas_row, n, extents + l * gas_row);
        }
        if (!pairs) continue;
        R extent[gas_row];
        Rows<Arch, gas_row>::load(extents, extent);
        const R square = extent[0] * extent[0] + extent[1] * extent[1] + extent[2] * extent[2];
        const R n = load<Arch>(number), majorant = select(n > R(1.0), R(view.margin) * sqrt(square), R(0.0));
        R mean = R(view.rate) * (n * (n - R(1.0))) * majorant;
        if (view.packing > 0) mean = mean * laws::contact_correlation(dimension, R(view.packing) * n);
        const PhiloxLanes<Arch> draw =
            philox<Arch>(W(0), W::load(cell), view.random.step, view.random.last_word(GasStream::rounding),
                         view.random.key);
        const R wanted = floor(mean + unit_number(draw.w[0], draw.w[1]));
        const auto possible = wanted < R(most_candidates);
        result.overflows += width - __builtin_popcount(bits(possible));
        double candidates[width];
        store(candidates, select(possible, wanted, R(0.0)));
        store(view.majorant + first, majorant);
        for (std::int32_t l = 0; l < end; ++l) {
            const auto m = static_cast<std::int32_t>(candidates[l]);
            view.candidates[first + l] = m;
            view.list[0][active] = first + l;
            active += m > 0 ? 1 : 0;
        }
    }
    return active;
}

// Candidate k of eight cells: appends the accepted pairs to the lists of rows and cells.
template <class Arch, int dimension>
SANDLANE_INLINE std::int32_t choose_pairs(const GasCollisionView& view, const std::int32_t* active,
                                          std::int32_t lanes, std::uint32_t k, std::int32_t accepted,
                                          GasCollisions& result) {
    using R = Block<Arch>;
    using W = Words<Arch>;
    std::uint64_t begin[width], size[width], number[width];
    double majorant[width];
    alignas(64) std::int32_t cells[width], first[width], second[width];
    for (std::int32_t l = 0; l < width; ++l) {
        const std::int32_t c = active[l < lanes ? l : 0];
        cells[l] = c;
        begin[l] = static_cast<std::uint64_t>(view.start[c]);
        size[l] = static_cast<std::uint64_t>(view.start[c + 1] - view.start[c]);
        number[l] = static_cast<std::uint64_t>(view.first_cell + c);
        majorant[l] = view.majorant[c];
    }
    const PhiloxLanes<Arch> draw = philox<Arch>(W(k), W::load(number), view.random.step,
                                                view.random.last_word(GasStream::candidate), view.random.key);
    const W n = W::load(size), from = W::load(begin);
    const W i = right<32>(product(draw.w[0], n));
    W j = right<32>(product(draw.w[1], n - W(1)));
    j = j + W(1) - right<63>(j - i); // the sign bit says j < i
    std::uint64_t rows[2][width];
    (i + from).store(rows[0]);
    (j + from).store(rows[1]);
    for (int l = 0; l < width; ++l) {
        first[l] = static_cast<std::int32_t>(rows[0][l]);
        second[l] = static_cast<std::int32_t>(rows[1][l]);
    }
    R a[gas_row], b[gas_row];
    Rows<Arch, gas_row>::gather(view.rows.velocity, first, a);
    Rows<Arch, gas_row>::gather(view.rows.velocity, second, b);
    const Vector<R> g{a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    const R speed = sqrt(dot(g, g)), most = load<Arch>(majorant);
    const unsigned real = lanes == width ? 0xffu : (1u << lanes) - 1u;
    const unsigned yes = bits(unit_number(draw.w[2], draw.w[3]) * most < speed) & real;
    result.violations += __builtin_popcount(bits(speed > most) & real);
    Integers<Arch, 8>(first).compress(yes, view.list[1] + accepted);
    Integers<Arch, 8>(second).compress(yes, view.list[2] + accepted);
    Integers<Arch, 8>(cells).compress(yes, view.list[3] + accepted);
    return accepted + __builtin_popcount(yes);
}

// Writes the first `lanes` of eight rows.
template <class Arch>
SANDLANE_INLINE void put_rows(const Block<Arch> (&field)[gas_row], double* base, const std::int32_t* at,
                              std::int32_t lanes) {
    if (lanes == width) {
        Rows<Arch, gas_row>::scatter(field, base, at);
        return;
    }
    alignas(64) double rows[width * gas_row];
    Rows<Arch, gas_row>::store(field, rows);
    for (std::int32_t l = 0; l < lanes; ++l)
        std::memcpy(base + std::ptrdiff_t{at[l]} * gas_row, rows + l * gas_row, gas_row * sizeof(double));
}

// Collisions of `lanes` <= 8 pairs that share no particle.
template <class Arch, int dimension, bool rough>
SANDLANE_INLINE void collide_pairs(const GasCollisionView& view, const std::int32_t* given_first,
                                   const std::int32_t* given_second, const std::int32_t* given_cell,
                                   std::int32_t lanes, std::uint32_t k) {
    using R = Block<Arch>;
    using W = Words<Arch>;
    alignas(64) std::int32_t first[width], second[width];
    std::uint64_t number[width];
    for (std::int32_t l = 0; l < width; ++l) {
        const std::int32_t from = l < lanes ? l : 0;
        first[l] = given_first[from];
        second[l] = given_second[from];
        number[l] = static_cast<std::uint64_t>(view.first_cell + given_cell[from]);
    }
    const PhiloxLanes<Arch> draw = philox<Arch>(W(k), W::load(number), view.random.step,
                                                view.random.last_word(GasStream::geometry), view.random.key);
    const R u1 = unit_number(draw.w[0], draw.w[1]);
    R a[gas_row], b[gas_row];
    Rows<Arch, gas_row>::gather(view.rows.velocity, first, a);
    Rows<Arch, gas_row>::gather(view.rows.velocity, second, b);
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
    const R normal = dot(g, e), eps = laws::restitution(view.restitution, -normal);
    Vector<R> push;
    if constexpr (rough) {
        R s[gas_row], t[gas_row];
        Rows<Arch, gas_row>::gather(view.rows.spin, first, s);
        Rows<Arch, gas_row>::gather(view.rows.spin, second, t);
        const R radius(view.radius);
        const Vector<R> spin{radius * (s[0] + t[0]), radius * (s[1] + t[1]), radius * (s[2] + t[2])};
        const Vector<R> contact = g - cross(spin, e);
        R tangential(view.tangential);
        if (view.friction > 0) {
            const R along = dot(contact, e);
            const Vector<R> across = contact - along * e;
            tangential = laws::sliding_restitution(tangential, R(view.friction), eps, R(view.mass_ratio),
                                                   -along, sqrt(dot(across, across)));
        }
        push = laws::impulse(contact, e, eps, tangential, R(view.mass_ratio));
        const Vector<R> turn = R(0.5 / (view.inertia * view.radius)) * cross(e, push);
        s[0] = s[0] - turn.x, s[1] = s[1] - turn.y, s[2] = s[2] - turn.z;
        t[0] = t[0] - turn.x, t[1] = t[1] - turn.y, t[2] = t[2] - turn.z;
        put_rows<Arch>(s, view.rows.spin, first, lanes);
        put_rows<Arch>(t, view.rows.spin, second, lanes);
    } else {
        push = laws::smooth_impulse(normal, e, eps);
    }
    const Vector<R> change = R(0.5) * push;
    a[0] = a[0] + change.x, a[1] = a[1] + change.y, a[2] = a[2] + change.z;
    b[0] = b[0] - change.x, b[1] = b[1] - change.y, b[2] = b[2] - change.z;
    put_rows<Arch>(a, view.rows.velocity, first, lanes);
    put_rows<Arch>(b, view.rows.velocity, second, lanes);
}

template <class Arch, int dimension, bool rough> GasCollisions collide_gas(const GasCollisionView& view) {
    GasCollisions result;
    std::int32_t active = count_candidates<Arch, dimension>(view, result);
    std::int32_t* cells = view.list[0];
    for (std::uint32_t k = 0; active > 0; ++k) {
        result.candidates += active;
        std::int32_t accepted = 0;
        for (std::int32_t at = 0; at < active; at += width)
            accepted = choose_pairs<Arch, dimension>(
                view, cells + at, active - at < width ? active - at : width, k, accepted, result);
        for (std::int32_t at = 0; at < accepted; at += width)
            collide_pairs<Arch, dimension, rough>(view, view.list[1] + at, view.list[2] + at,
                                                  view.list[3] + at,
                                                  accepted - at < width ? accepted - at : width, k);
        result.collisions += accepted;
        std::int32_t left = 0;
        for (std::int32_t at = 0; at < active; ++at) {
            const std::int32_t c = cells[at];
            cells[left] = c;
            left += view.candidates[c] > static_cast<std::int32_t>(k) + 1 ? 1 : 0;
        }
        active = left;
    }
    return result;
}

} // namespace sandlane::simd
