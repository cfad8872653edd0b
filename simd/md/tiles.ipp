// Forces of the near pairs of one tile of grains, in three short loops over chunks that stay in the
// first-level cache: combine the records of eight pairs and pack those that touch; evaluate the law on packed
// lanes; add the forces in list order. Only contacts reach the law and the memory of forces.
#pragma once

#include "simd/md/pairs.ipp"

namespace sandlane::simd {

inline constexpr int tile_chunk = 128; // pairs
inline constexpr int look_ahead = 64;  // pairs: distance of the prefetch of partners' records

// The contacts of one chunk, packed; room for the full store of the last eight.
struct Contacts {
    static constexpr int room = tile_chunk + width;
    alignas(64) double dx[room], dy[room], dvx[room], dvy[room], spin[room], sum[room], inverse[room];
    alignas(64) double rows[room * force_fields];
    alignas(64) double memory[laws::most_memory][room];
    std::int32_t i[room], j[room], place[room]; // place in the chunk
    int count;
};

// What pairs that touch remember moves along; pairs that do not touch forget.
template <class Arch, int memory>
SANDLANE_INLINE void pack_memory(const Mask<Arch>& touch, unsigned touching, int n, double* of_chunk,
                                 std::ptrdiff_t stride, Contacts& c) {
    using R = Block<Arch>;
    const std::int32_t here[width] = {n, n + 1, n + 2, n + 3, n + 4, n + 5, n + 6, n + 7};
    Integers<Arch, width>(here).compress(touching, c.place + c.count);
    for (int f = 0; f < memory; ++f) {
        double* at = of_chunk + f * stride + n;
        const R held = load<Arch>(at);
        compress(held, touching, c.memory[f] + c.count);
        store(at, select(touch, held, R(laws::no_contact)));
    }
}

template <class Arch, bool spin, bool radius, int memory>
SANDLANE_INLINE void pack_contacts(const PairView& view, const TileList& list, std::int32_t first, int size,
                                   Contacts& c) {
    using R = Block<Arch>;
    const std::int32_t *const i = list.i + first, *const j = list.j + first;
    const std::int32_t* const end = list.j + list.count;
    c.count = 0;
    for (int n = 0; n < size; n += width) {
        if (j + n + look_ahead + width <= end)
            for (int l = 0; l < width; ++l)
                __builtin_prefetch(view.records + std::ptrdiff_t{j[n + look_ahead + l]} * record_fields);
        R field[record_fields];
        CombinePairs<Arch>::apply(view.records, i + n, j + n, field);
        const R dx = minimum_image(field[0], view.half_x, view.period_x);
        const R dy = minimum_image(field[1], view.half_y, view.period_y);
        const auto touch = dx * dx + dy * dy < field[5] * field[5];
        unsigned touching = bits(touch);
        if (size - n < width) touching &= (1u << (size - n)) - 1u;
        const int at = c.count;
        compress(dx, touching, c.dx + at);
        compress(dy, touching, c.dy + at);
        compress(field[2], touching, c.dvx + at);
        compress(field[3], touching, c.dvy + at);
        if constexpr (spin) compress(field[4], touching, c.spin + at);
        compress(field[5], touching, c.sum + at);
        if constexpr (radius) compress(field[6], touching, c.inverse + at);
        if constexpr (memory > 0)
            pack_memory<Arch, memory>(touch, touching, n, list.memory + first, list.stride, c);
        Integers<Arch, width>(i + n).compress(touching, c.i + at);
        Integers<Arch, width>(j + n).compress(touching, c.j + at);
        c.count += __builtin_popcount(touching);
    }
}

// Lanes behind the last contact repeat it, so that they hold numbers.
template <bool spin, bool radius, int memory> SANDLANE_INLINE void pad_contacts(Contacts& c) {
    const int last = c.count - 1;
    for (int n = c.count; n % width != 0; ++n) {
        c.dx[n] = c.dx[last];
        c.dy[n] = c.dy[last];
        c.dvx[n] = c.dvx[last];
        c.dvy[n] = c.dvy[last];
        if (spin) c.spin[n] = c.spin[last];
        c.sum[n] = c.sum[last];
        if (radius) c.inverse[n] = c.inverse[last];
        for (int f = 0; f < memory; ++f) c.memory[f][n] = c.memory[f][last];
        c.i[n] = c.i[last];
        c.j[n] = c.j[last];
    }
}

template <class Arch, class Normal, class Tangential, bool many_materials>
double tile_forces(const PairView& view, const TileList& list, double* force, double largest_overlap) {
    using R = Block<Arch>;
    constexpr bool spin = Tangential::needs_spin, radius = Normal::needs_radius;
    constexpr int memory = laws::memory_of<Tangential>;
    Contacts c;
    laws::PairCoefficients<R> coefficients;
    if constexpr (!many_materials) coefficients = laws::coefficients_from<R>(view.coefficients);
    const R elapsed(view.dt);
    R most(largest_overlap);
    const auto size_of_tile = static_cast<std::uint32_t>(list.end - list.begin);
    for (std::int32_t first = 0; first < list.count; first += tile_chunk) {
        const int size = list.count - first < tile_chunk ? list.count - first : tile_chunk;
        pack_contacts<Arch, spin, radius, memory>(view, list, first, size, c);
        pad_contacts<spin, radius, memory>(c);
        for (int n = 0; n < c.count; n += width) {
            if constexpr (many_materials) coefficients = gather_coefficients<Arch>(view, c.i + n, c.j + n);
            const laws::PairState<R> state{load<Arch>(c.dx + n),
                                           load<Arch>(c.dy + n),
                                           load<Arch>(c.dvx + n),
                                           load<Arch>(c.dvy + n),
                                           spin ? load<Arch>(c.spin + n) : R(0.0),
                                           load<Arch>(c.sum + n),
                                           radius ? load<Arch>(c.inverse + n) : R(1.0)};
            R held[memory + 1];
            for (int m = 0; m < memory; ++m) held[m] = load<Arch>(c.memory[m] + n);
            const auto f = laws::pair_force<Normal, Tangential>(state, coefficients, held, elapsed);
            for (int m = 0; m < memory; ++m) store(c.memory[m] + n, held[m]);
            most = max(f.overlap, most);
            StoreRows<Arch>::apply(f.x, f.y, f.tangential, R(0.0), c.rows + n * force_fields, force_fields);
        }
        for (int n = 0; n < c.count; ++n) {
            const double* row = c.rows + n * force_fields;
            add_row<Arch>(force + std::ptrdiff_t{c.i[n] - list.begin} * force_fields, row);
            const auto partner = static_cast<std::uint32_t>(c.j[n] - list.begin);
            const std::ptrdiff_t target = partner < size_of_tile ? std::ptrdiff_t{partner} : tile_grains;
            add_mirrored_row<Arch>(force + target * force_fields, row);
            for (int m = 0; m < memory; ++m)
                list.memory[m * list.stride + first + c.place[n]] = c.memory[m][n];
        }
    }
    return largest(most);
}

} // namespace sandlane::simd
