// Kernels of cellular automata: plain views of lattices, and one table of functions per instruction set.
// There is no table `scalar`: the reference of src/automata/reference takes whole steps by loops of its own.
#pragma once

#include "simd/tables.hpp"

#include <cstddef>
#include <cstdint>

namespace sandlane::simd {

// ---- lattice gas (docs/automata.md 4)

enum class GasModel { hpp, fhp1, fhp2, fhp3, pipe };
inline constexpr int gas_models = 5;

// How the collisions of a model are meant: random chirality; chirality (x + y + t) mod 2; random with solid
// sites and a drive; any number of rest particles on a site (of the pipe).
enum class GasVariant { plain, alternating, general, counted };
inline constexpr int gas_variants = 4;

inline constexpr int gas_planes = 7; // directions 0 to 5, then rest particles
// Words of a row are padded to whole segments of 512 sites.
inline constexpr std::int32_t segment_words = 8;
// Rows of a tile, fixed, so that results do not depend on threads.
inline constexpr std::int32_t gas_tile_rows = 64;

// Words [first, last) of a row, whole segments.
struct WordRange {
    std::int32_t first, last;
};

// Streams of random words (spec 3.3).
namespace gas_stream {
inline constexpr std::uint32_t dissipation = 1, chirality = 2, gravity = 3, wall = 4;
}
inline constexpr int probability_bits = 16; // K: probabilities are P/2^K

// Rest particles beyond the first of their site, laid out as planes: where there are some before the step,
// and what collision and gravity do to them, one + 2 two more, or one less.
struct CountedView {
    const std::uint64_t* several;
    std::uint64_t *one, *two, *less;
};

// One bit per site: bit x mod 64 of word x/64 of row y, plane[direction][y * stride + word]. Bits beyond the
// last column are zero. A step happens in place: a row is read whole before anything is written to it. What
// leaves a tile is kept, and put into the neighbours' rows when all tiles are done.
struct GasView {
    std::uint64_t* plane[gas_planes]; // null where the model has none
    const std::uint64_t* solid;       // [rows][stride], or null
    std::int32_t rows, columns, words, stride;
    std::uint32_t seed[2], step;
    std::uint32_t dissipation, gravity, roughness; // P of P/2^K
    // Segments that may hold particles, [rows][stride/segment_words], and where the kernel notes which do;
    // null: all are taken to.
    const std::uint8_t* live;
    std::uint8_t* occupied;
    const CountedView* counted; // of the variant `counted` only
};

// Words of memory that a kernel needs beside the lattice.
[[nodiscard]] constexpr std::size_t gas_scratch_words(std::int32_t stride) {
    return (gas_planes + 2) * (static_cast<std::size_t>(stride) + 2 * segment_words) +
           static_cast<std::size_t>(stride) + 6 * (static_cast<std::size_t>(stride) / segment_words + 2);
}

struct GasTile {
    std::int32_t first, last; // rows; those from `rows` on are the first of a periodic lattice
    // Where what leaves the tile goes, a row each: directions 4 and 5, 1 and 2 (HPP: 3, 1); null at a wall.
    std::uint64_t *below[2], *above[2];
};
using GasKernel = void (*)(const GasView&, const GasTile&, std::uint64_t* scratch);
// Two steps in one pass, of the rows of `first` and then of `second`, which are the same, but for a row less
// beside other tiles. scratch: for two.
using GasPairKernel = void (*)(const GasView&, const GasTile& first, const GasTile& second,
                               std::uint64_t* scratch);

// Directions in which rest particles hop, words of 0 to 5, from words x | y << 32 of their sites; a multiple
// of eight.
struct HopView {
    const std::uint64_t* sites;
    std::uint64_t* directions;
    std::int64_t count;
    std::uint32_t seed[2], step, stream;
};
using HopKernel = void (*)(const HopView&);

// ---- sandpile (docs/automata.md 1)

// Columns are cut into strips of 64 bytes and rows into bands; a tile is a strip of a band.
inline constexpr std::int32_t strip_bytes = 64, band_rows = 8;

// Heights as bytes or 16-bit numbers, between a row of zeros below and above and a strip of zeros on both
// sides. Sums of a sweep never overflow: (h mod 4) + 4 (h_max div 4) <= h_max.
struct PileView {
    const std::uint8_t* from; // of row 0, strip 0
    std::uint8_t* to;
    std::ptrdiff_t stride;      // bytes, of a row
    const std::uint64_t* inner; // of the last strip: the bits that belong to the lattice, 8 words
    std::uint8_t*
        odometer; // of site (0, 0): topplings are added to it; null for kernels that do not count them
    std::int32_t strips;
};
// One sweep of rows [first_row, last_row) of strips [first, last): all sites at once, from the old heights.
// Adds the topplings of each strip to topplings[strip], and sets changed[strip] where a height has changed.
struct PileTiles {
    std::int32_t first_row, last_row, first, last;
    std::uint64_t* topplings;
    std::uint8_t* changed;
};
using PileKernel = void (*)(const PileView&, const PileTiles&);

// ---- ripples (docs/automata.md 3)

inline constexpr std::ptrdiff_t ripple_pad = 8;

// Heights in units of 2^-32 before (and after) a step, and after its saltation: rows of `stride` numbers,
// with ripple_pad numbers before the first column and as many behind the last block of eight.
struct RippleView {
    std::int64_t *heights, *landed; // of row 0, column 0
    std::int32_t rows, columns;
    std::ptrdiff_t stride;
    double length, wind;    // L_0, b
    std::int64_t transport; // q
    double near, far, line; // D/6, D/12 and, of one row, D/2
    double highest;         // |h| that is still counted exactly
    std::uint32_t seed[2], step;
};
struct RippleResult {
    std::int64_t clamped = 0; // lengths below 0
    bool too_high = false;
};
// Rows [first, last). scratch: 7 strides.
using SaltationKernel = RippleResult (*)(const RippleView&, std::int32_t first, std::int32_t last,
                                         std::int64_t* scratch);
// landed -> heights; all rows have landed.
using CreepKernel = void (*)(const RippleView&, std::int32_t first, std::int32_t last, std::int64_t* scratch);

// ---- heaps (docs/automata.md 2)

inline constexpr int heap_lanes = 8;

// Eight heaps, heights [places][heap_lanes]: columns 0, 1, ... and, of heaps of two sides, columns 1, 2, ...
// of the left one, `left` places further. Doubles: whole numbers, for which no conversion is needed.
struct HeapView {
    double* heights;
    std::int64_t columns, left;                         // left: 0 where there is one side
    double retained, sticking, start_energy, roughness; // r, U, E_0, delta
    std::int64_t steepest;                              // s_max; 0: no avalanches
    std::uint32_t seed[heap_lanes][2];
    std::int64_t *lost, *released; // [heap_lanes]: over the end, by avalanches
    std::uint64_t* visits;         // of the present grain, [places][heap_lanes], zero; of general kernels
};
// Drops grains with numbers first_grain, first_grain + 1, ... on each.
using HeapKernel = void (*)(const HeapView&, std::uint32_t first_grain, std::int64_t grains);

struct AutomataKernels {
    GasKernel gas[gas_models][gas_variants]; // null where a model has no such variant
    GasPairKernel gas_pair[gas_models][gas_variants];
    // FHP-III again, by a table of bytes; null where the processor lacks the instructions.
    GasKernel fhp3_bytes[gas_variants];
    GasPairKernel fhp3_bytes_pair[gas_variants];
    HopKernel hops;
    PileKernel pile[2][2];        // heights of 1 or 2 bytes; full or unit topplings
    PileKernel pile_odometer;     // 2 bytes, full
    SaltationKernel saltation[3]; // interpolated, whole, stochastic
    CreepKernel creep;
    HeapKernel heap[2][2]; // smooth or rough; of one side without avalanches, or general
};

// Not of Isa::scalar.
[[nodiscard]] const AutomataKernels& automata_kernels(Isa isa);

} // namespace sandlane::simd
