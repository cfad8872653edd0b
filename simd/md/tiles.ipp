// Forces of the near pairs of one tile of grains, in three short loops over chunks that stay in the
// first-level cache: combine the records of eight pairs and pack those that touch; evaluate the law on packed
// lanes; add the forces in list order. Only contacts reach the law, their memory and the accumulators.
#pragma once

#include "simd/md/pairs.ipp"

namespace sandlane::simd {

inline constexpr int tile_chunk = 128; // pairs
inline constexpr int look_ahead = 64;  // pairs: distance of the prefetch of partners' records and of memory

// The contacts of one chunk, packed; room for the full store of the last eight.
struct Contacts {
    static constexpr int room = tile_chunk + width;
    alignas(64) double field[record_fields][room]; // combined records
    std::int32_t i[room], j[room], place[room];    // place in the chunk
    int count;
};

// Which fields of combined records the laws read, and what a contact remembers: laws that agree share the
// loop that packs contacts.
struct Reads {
    bool spin, inverse_radius;
    int memory_row;

    [[nodiscard]] constexpr bool operator()(int dimension, int field) const {
        if (dimension == 2 && field == Record<2>::spin) return spin;
        if (field == radius_field(dimension) + 1) return inverse_radius;
        return field < 2 * dimension || field == radius_field(dimension);
    }
    bool operator==(const Reads&) const = default;
};
template <int dimension, class Normal, class Tangential, laws::Couples couples>
inline constexpr Reads reads_of{Tangential::needs_spin,
                                Normal::needs_radius || couples != laws::Couples::none,
                                memory_row(laws::memory_of<Normal, Tangential, couples, dimension>)};

// A contact that begins has nothing to remember: laws know it by `no_contact`.
template <int doubles>
SANDLANE_INLINE void begin_contacts(const TileList& list, std::int32_t pair, unsigned touching) {
    std::uint8_t& touched = list.touched[pair / width];
    for (unsigned fresh = touching & ~unsigned{touched}; fresh != 0; fresh &= fresh - 1)
        list.memory[std::ptrdiff_t{pair + __builtin_ctz(fresh)} * doubles] = laws::no_contact;
    touched = static_cast<std::uint8_t>(touching);
}

// Rows of eight pairs; a prefetch beyond the end does no harm.
template <int row> SANDLANE_INLINE void prefetch_memory(const TileList& list, std::int32_t pair) {
    for (int d = 0; d < width * row; d += 8)
        __builtin_prefetch(list.memory + std::ptrdiff_t{pair} * row + d, 1);
}

template <int dimension, bool spin>
SANDLANE_INLINE void prefetch_grain(const PairView& view, std::int32_t j) {
    __builtin_prefetch(view.records + std::ptrdiff_t{j} * record_fields);
    if (dimension == 3 && spin) __builtin_prefetch(view.spins + std::ptrdiff_t{j} * spin_fields);
}

// Lanes behind the last contact repeat it, so that they hold numbers.
template <int dimension, Reads reads> SANDLANE_INLINE void pad_contacts(Contacts& c) {
    const int last = c.count - 1;
    for (int n = c.count; n % width != 0; ++n) {
        for (int f = 0; f < record_fields; ++f)
            if (reads(dimension, f)) c.field[f][n] = c.field[f][last];
        if (reads.memory_row > 0) c.place[n] = c.place[last];
        c.i[n] = c.i[last];
        c.j[n] = c.j[last];
    }
}

// Not inlined: one copy for all laws, and a call per chunk costs nothing.
template <class Arch, int dimension, Images images, Reads reads>
__attribute__((noinline)) void pack_contacts(const PairView& view, const TileList& list, std::int32_t first,
                                             int size, Contacts& c) {
    using R = Block<Arch>;
    const std::int32_t *const i = list.i + first, *const j = list.j + first;
    const std::int32_t* const end = list.j + list.count;
    int at = 0;
    for (int n = 0; n < size; n += width) {
        if (j + n + look_ahead + width <= end)
            for (int l = 0; l < width; ++l)
                prefetch_grain<dimension, reads.spin>(view, j[n + look_ahead + l]);
        if constexpr (reads.memory_row > 0) prefetch_memory<reads.memory_row>(list, first + n + look_ahead);
        R field[record_fields];
        CombinePairs<Arch, dimension>::apply(view.records, i + n, j + n, field);
        const R square = separate<Arch, dimension, images>(view, field),
                sum = field[Record<dimension>::radius];
        unsigned touching = bits(square < sum * sum);
        if (size - n < width) touching &= (1u << (size - n)) - 1u;
        for (int f = 0; f < record_fields; ++f)
            if (reads(dimension, f)) compress(field[f], touching, c.field[f] + at);
        if constexpr (reads.memory_row > 0) {
            const std::int32_t here[width] = {n, n + 1, n + 2, n + 3, n + 4, n + 5, n + 6, n + 7};
            Integers<Arch, width>(here).compress(touching, c.place + at);
            begin_contacts<reads.memory_row>(list, first + n, touching);
        }
        Integers<Arch, width>(i + n).compress(touching, c.i + at);
        Integers<Arch, width>(j + n).compress(touching, c.j + at);
        at += __builtin_popcount(touching);
    }
    c.count = at;
    pad_contacts<dimension, reads>(c);
}

template <class Arch, int dimension, Reads reads>
SANDLANE_INLINE void pack_chunk(const PairView& view, const TileList& list, std::int32_t first, int size,
                                Contacts& c) {
    switch (list.images) {
    case Images::none:
        return pack_contacts<Arch, dimension, Images::none, reads>(view, list, first, size, c);
    case Images::periodic:
        return pack_contacts<Arch, dimension, Images::periodic, reads>(view, list, first, size, c);
    case Images::sheared:
        return pack_contacts<Arch, dimension, Images::sheared, reads>(view, list, first, size, c);
    }
}

// Memory of eight contacts, in rows at `place`, as blocks and back. Rows of one or two numbers go by scalars.
template <class Arch, int memory>
SANDLANE_INLINE void load_memory(const double* rows, const std::int32_t* place,
                                 Block<Arch> (&held)[memory + 1]) {
    constexpr int doubles = memory_row(memory);
    if constexpr (doubles >= 4) {
        Block<Arch> row[doubles];
        Rows<Arch, doubles>::gather(rows, place, row);
        for (int m = 0; m < memory; ++m) held[m] = row[m];
    } else {
        double lanes[doubles + 1][width];
        for (int l = 0; l < width; ++l)
            for (int m = 0; m < memory; ++m) lanes[m][l] = rows[std::ptrdiff_t{place[l]} * doubles + m];
        for (int m = 0; m < memory; ++m) held[m] = load<Arch>(lanes[m]);
    }
}
template <class Arch, int memory>
SANDLANE_INLINE void store_memory(const Block<Arch> (&held)[memory + 1], double* rows,
                                  const std::int32_t* place) {
    constexpr int doubles = memory_row(memory);
    if constexpr (doubles >= 4) {
        Block<Arch> row[doubles];
        for (int m = 0; m < doubles; ++m) row[m] = m < memory ? held[m] : Block<Arch>(0.0);
        Rows<Arch, doubles>::scatter(row, rows, place);
    } else {
        double lanes[doubles + 1][width];
        for (int m = 0; m < memory; ++m) store(lanes[m], held[m]);
        for (int l = 0; l < width; ++l)
            for (int m = 0; m < memory; ++m) rows[std::ptrdiff_t{place[l]} * doubles + m] = lanes[m][l];
    }
}

template <class Arch, int dimension, class Normal, class Tangential, laws::Couples couples,
          bool many_materials>
double tile_forces(const PairView& view, const TileList& list, double* force, double largest_overlap) {
    using R = Block<Arch>;
    constexpr int memory = laws::memory_of<Normal, Tangential, couples, dimension>,
                  doubles = memory_row(memory);
    constexpr int fields = force_stride(dimension, rotation_of<Tangential, couples>);
    using Row = ForceRow<Arch, dimension, fields>;
    constexpr Reads reads = reads_of<dimension, Normal, Tangential, couples>;
    Contacts c;
    alignas(64) double rows[Contacts::room * fields];
    laws::PairCoefficients<R> coefficients;
    if constexpr (!many_materials) coefficients = laws::coefficients_from<R>(view.coefficients);
    const R elapsed(view.dt), step(view.step);
    R most(largest_overlap);
    const auto size_of_tile = static_cast<std::uint32_t>(list.end - list.begin);
    for (std::int32_t first = 0; first < list.count; first += tile_chunk) {
        const int size = list.count - first < tile_chunk ? list.count - first : tile_chunk;
        double* const remembered = list.memory + std::ptrdiff_t{first} * doubles;
        pack_chunk<Arch, dimension, reads>(view, list, first, size, c);
        for (int n = 0; n < c.count; n += width) {
            if constexpr (many_materials) coefficients = gather_coefficients<Arch>(view, c.i + n, c.j + n);
            R field[record_fields], held[memory + 1];
            for (int f = 0; f < record_fields; ++f)
                field[f] = reads(dimension, f) ? load<Arch>(c.field[f] + n) : R(1.0);
            load_memory<Arch, memory>(remembered, c.place + n, held);
            const auto f = laws::pair_force<Normal, Tangential, couples>(
                contact_state<Arch, dimension, Tangential, couples>(view, c.i + n, c.j + n, field),
                coefficients, held, elapsed, step);
            store_memory<Arch, memory>(held, remembered, c.place + n);
            most = max(f.overlap, most);
            store_force<Arch, fields>(f, rows + n * fields);
        }
        RunningRow<Arch, dimension, fields> running(force);
        for (int n = 0; n < c.count; ++n) {
            const double* row = rows + n * fields;
            running.add(c.i[n] - list.begin, row);
            const auto partner = static_cast<std::uint32_t>(c.j[n] - list.begin);
            const std::ptrdiff_t target = partner < size_of_tile ? std::ptrdiff_t{partner} : tile_grains;
            Row::add_mirrored(force + target * fields, row);
        }
    }
    return largest(most);
}

} // namespace sandlane::simd
