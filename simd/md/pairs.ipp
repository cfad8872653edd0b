// Pair forces of a list of pairs, eight at a time: combine the records of both grains, evaluate the law on
// packed lanes, then add the forces in list order (the order, and with it every bit, does not depend on the
// lanes).
#pragma once

#include "laws/contact.hpp"
#include "simd/compress.hpp"
#include "simd/lanes.hpp"
#include "simd/rows.hpp"
#include "simd/tables.hpp"

namespace sandlane::simd {

inline constexpr int pair_chunk =
    256; // pairs evaluated before their forces are added: 8 KiB of forces stay in L1

template <class Arch>
SANDLANE_INLINE Block<Arch> minimum_image(const Block<Arch>& d, double half, double period) {
    const Block<Arch> low = select(d < Block<Arch>(-half), d + Block<Arch>(period), d);
    return select(low > Block<Arch>(half), low - Block<Arch>(period), low);
}

// The image across a Lees-Edwards seam stands and moves along x.
template <class Arch>
SANDLANE_INLINE void cross_seam(const PairView& view, const Block<Arch>& dy, Block<Arch>& dx,
                                Block<Arch>& shift) {
    using R = Block<Arch>;
    const R zero(0.0), seam(view.seam), moves(view.seam_shift);
    const auto above = dy > R(view.half[1]), below = dy < R(-view.half[1]);
    dx = dx - select(above, seam, zero) + select(below, seam, zero);
    shift = shift - select(above, moves, zero) + select(below, moves, zero);
}

// The first fields of combined records become the vector to the nearest image; returns its square.
template <class Arch, int dimension, Images images>
SANDLANE_INLINE Block<Arch> separate(const PairView& view, Block<Arch> (&field)[record_fields]) {
    if constexpr (images == Images::sheared)
        cross_seam(view, field[1], field[0], field[Record<dimension>::velocity]);
    if constexpr (images != Images::none)
        for (int d = 0; d < dimension; ++d) field[d] = minimum_image(field[d], view.half[d], view.period[d]);
    const Block<Arch> square = field[0] * field[0] + field[1] * field[1];
    if constexpr (dimension == 3) return square + field[2] * field[2];
    return square;
}

template <class Arch>
SANDLANE_INLINE laws::PairCoefficients<Block<Arch>>
gather_coefficients(const PairView& view, const std::int32_t* i, const std::int32_t* j) {
    using R = Block<Arch>;
    constexpr int own = laws::pair_coefficients - laws::scene_coefficients;
    double lanes[own][width];
    for (int l = 0; l < width; ++l) {
        const std::ptrdiff_t pair =
            std::ptrdiff_t{view.material[i[l]]} * view.materials + view.material[j[l]];
        const double* entry = view.coefficients + pair * laws::pair_coefficients;
        for (int c = 0; c < own; ++c) lanes[c][l] = entry[c];
    }
    return {load<Arch>(lanes[0]),
            load<Arch>(lanes[1]),
            load<Arch>(lanes[2]),
            load<Arch>(lanes[3]),
            load<Arch>(lanes[4]),
            load<Arch>(lanes[5]),
            load<Arch>(lanes[6]),
            load<Arch>(lanes[7]),
            load<Arch>(lanes[8]),
            R(view.coefficients[laws::pair_coefficients - 2]),
            R(view.coefficients[laws::pair_coefficients - 1])};
}

template <class R> SANDLANE_INLINE Vector<R> vector(const R* component, const R& factor) {
    return {factor * component[0], factor * component[1], factor * component[2]};
}

// The relative state of eight pairs from their combined records.
template <class Arch, int dimension, class Tangential, laws::Couples couples>
SANDLANE_INLINE laws::ContactState<dimension, Block<Arch>>
contact_state(const PairView& view, const std::int32_t* i, const std::int32_t* j,
              const Block<Arch> (&field)[record_fields]) {
    using R = Block<Arch>;
    using Fields = Record<dimension>;
    const R rate(view.inverse_dt), zero(0.0);
    laws::ContactState<dimension, R> state;
    state.radius_sum = field[Fields::radius];
    state.inverse_radii = field[Fields::inverse_radius];
    if constexpr (dimension == 2) {
        state.dx = field[0];
        state.dy = field[1];
        state.dvx = rate * field[2];
        state.dvy = rate * field[3];
        state.spin = Tangential::needs_spin ? rate * field[Fields::spin] : zero;
    } else {
        R spin[spin_fields] = {zero, zero, zero, zero}, turn[spin_fields] = {zero, zero, zero, zero};
        if constexpr (Tangential::needs_spin) CombineSpins<Arch>::apply(view.spins, i, j, spin, turn);
        state.d = {field[0], field[1], field[2]};
        state.dv = vector(field + Fields::velocity, rate);
        state.spin = vector(spin, rate);
        state.turn = vector(turn, rate);
    }
    if constexpr (couples != laws::Couples::none) {
        const Turns<Arch, dimension> turns(view.records, view.spins, i, j);
        if constexpr (dimension == 2) {
            state.turn = rate * turns.turn[0];
            state.differ = rate * turns.differ[0];
        } else {
            state.differ = vector(turns.differ, rate);
        }
        state.radius = turns.first;
        state.other = turns.second;
        state.square_difference = turns.first * turns.first - turns.second * turns.second;
    }
    return state;
}

// Eight force rows of pair_force's results.
template <class Arch, int fields>
SANDLANE_INLINE void store_force(const laws::PairForce<Block<Arch>>& f, double* rows) {
    const Block<Arch> row[4] = {f.x, f.y, f.tangential, f.couple};
    Rows<Arch, 4>::store(row, rows);
}
template <class Arch, int fields>
SANDLANE_INLINE void store_force(const laws::SpatialForce<Block<Arch>>& f, double* rows) {
    const Block<Arch> zero(0.0);
    const Vector<Block<Arch>> parts[3] = {f.force, f.turning, f.couple};
    Block<Arch> row[fields];
    for (int p = 0; p < fields / 4; ++p) {
        row[4 * p] = parts[p].x;
        row[4 * p + 1] = parts[p].y;
        row[4 * p + 2] = parts[p].z;
        row[4 * p + 3] = zero;
    }
    Rows<Arch, fields>::store(row, rows);
}

template <class Arch, int dimension, int fields>
SANDLANE_INLINE void add_forces(double* force, const std::int32_t* i, const std::int32_t* j, int count,
                                const double* rows, Target target) {
    using Row = ForceRow<Arch, dimension, fields>;
    const auto of = [&](std::int32_t grain) { return force + std::ptrdiff_t{grain} * fields; };
    switch (target) {
    case Target::both:
        for (int n = 0; n < count; ++n) {
            Row::add(of(i[n]), rows + n * fields);
            Row::add_mirrored(of(j[n]), rows + n * fields);
        }
        break;
    case Target::first:
        for (int n = 0; n < count; ++n) Row::add(of(i[n]), rows + n * fields);
        break;
    case Target::second:
        for (int n = 0; n < count; ++n) Row::add_mirrored(of(j[n]), rows + n * fields);
        break;
    }
}

template <class Tangential, laws::Couples couples>
inline constexpr Rotation rotation_of = couples != laws::Couples::none ? Rotation::couples
                                        : Tangential::needs_spin       ? Rotation::friction
                                                                       : Rotation::none;

template <class Arch, int dimension, class Normal, class Tangential, laws::Couples couples,
          bool many_materials>
double pair_forces(const PairView& view, const std::int32_t* i, const std::int32_t* j, std::int32_t count,
                   Target target, double largest_overlap) {
    using R = Block<Arch>;
    constexpr int fields = force_stride(dimension, rotation_of<Tangential, couples>);
    alignas(64) double rows[pair_chunk * fields];
    laws::PairCoefficients<R> coefficients;
    if constexpr (!many_materials) coefficients = laws::coefficients_from<R>(view.coefficients);
    R most(largest_overlap);
    for (std::int32_t first = 0; first < count; first += pair_chunk) {
        const int size = count - first < pair_chunk ? count - first : pair_chunk;
        for (int n = 0; n < size; n += width) {
            const std::int32_t *const a = i + first + n, *const b = j + first + n;
            R field[record_fields];
            CombinePairs<Arch, dimension>::apply(view.records, a, b, field);
            (void)separate<Arch, dimension, Images::periodic>(view, field);
            if constexpr (many_materials) coefficients = gather_coefficients<Arch>(view, a, b);
            const auto f = laws::pair_force<Normal, Tangential, couples>(
                contact_state<Arch, dimension, Tangential, couples>(view, a, b, field), coefficients);
            most = max(f.overlap, most);
            store_force<Arch, fields>(f, rows + n * fields);
        }
        add_forces<Arch, dimension, fields>(view.force, i + first, j + first, size, rows, target);
    }
    return largest(most);
}

// Pairs found by a traversal, handed to the pair kernel in whole blocks; the remainder is kept for the next
// round.
struct PairBuffer {
    // A traversal looks at the level once per group of sites: at most 80 offsets (9x9 mask) of sixteen pairs
    // later.
    static constexpr int capacity = pair_chunk + 82 * site_group;
    std::int32_t i[capacity], j[capacity];
    std::int32_t count = 0;
    double largest_overlap = 0;

    SANDLANE_INLINE void evaluate_full(const PairView& view, PairKernel kernel, Target target) {
        const std::int32_t whole = count / width * width;
        largest_overlap = kernel(view, i, j, whole, target, largest_overlap);
        for (std::int32_t n = whole; n < count; ++n) {
            i[n - whole] = i[n];
            j[n - whole] = j[n];
        }
        count -= whole;
    }
    // Pads the last block with its own last pair; the kernel adds the forces of real pairs only.
    SANDLANE_INLINE void evaluate_rest(const PairView& view, PairKernel kernel, Target target) {
        if (count == 0) return;
        for (std::int32_t n = count; n < (count + width - 1) / width * width; ++n) {
            i[n] = i[count - 1];
            j[n] = j[count - 1];
        }
        largest_overlap = kernel(view, i, j, count, target, largest_overlap);
        count = 0;
    }
};

} // namespace sandlane::simd
