// Pair forces of a list of pairs, eight at a time: combine the records of both grains, evaluate the law on
// packed lanes, then add the forces in list order (the order, and with it every bit, does not depend on the
// lanes).
#pragma once

#include "laws/contact.hpp"
#include "simd/lanes.hpp"
#include "simd/tables.hpp"

namespace sandlane::simd {

inline constexpr int pair_chunk =
    256; // pairs evaluated before their forces are added: 8 KiB of forces stay in L1

template <class Arch>
SANDLANE_INLINE Block<Arch> minimum_image(const Block<Arch>& d, double half, double period) {
    const Block<Arch> low = select(d < Block<Arch>(-half), d + Block<Arch>(period), d);
    return select(low > Block<Arch>(half), low - Block<Arch>(period), low);
}

template <class Arch>
SANDLANE_INLINE laws::PairCoefficients<Block<Arch>>
gather_coefficients(const PairView& view, const std::int32_t* i, const std::int32_t* j) {
    double lanes[laws::pair_coefficients][width];
    for (int l = 0; l < width; ++l) {
        const std::ptrdiff_t pair =
            std::ptrdiff_t{view.material[i[l]]} * view.materials + view.material[j[l]];
        const double* entry = view.coefficients + pair * laws::pair_coefficients;
        for (int c = 0; c < laws::pair_coefficients; ++c) lanes[c][l] = entry[c];
    }
    return {load<Arch>(lanes[0]), load<Arch>(lanes[1]), load<Arch>(lanes[2]), load<Arch>(lanes[3]),
            load<Arch>(lanes[4])};
}

SANDLANE_INLINE void add_row(double* force, std::int32_t particle, double x, double y, double t) {
    double* f = force + std::ptrdiff_t{particle} * force_fields;
    f[0] += x;
    f[1] += y;
    f[2] += t;
}

SANDLANE_INLINE void add_forces(double* force, const std::int32_t* i, const std::int32_t* j, int count,
                                const double* rows, Target target) {
    switch (target) {
    case Target::both:
        for (int n = 0; n < count; ++n) {
            const double* r = rows + n * force_fields;
            add_row(force, i[n], r[0], r[1], r[2]);
            add_row(force, j[n], -r[0], -r[1], r[2]);
        }
        break;
    case Target::first:
        for (int n = 0; n < count; ++n) add_row(force, i[n], rows[4 * n], rows[4 * n + 1], rows[4 * n + 2]);
        break;
    case Target::second:
        for (int n = 0; n < count; ++n) add_row(force, j[n], -rows[4 * n], -rows[4 * n + 1], rows[4 * n + 2]);
        break;
    }
}

template <class Arch, class Normal, class Tangential, bool many_materials>
double pair_forces(const PairView& view, const std::int32_t* i, const std::int32_t* j, std::int32_t count,
                   Target target, double largest_overlap) {
    using R = Block<Arch>;
    alignas(64) double rows[pair_chunk * force_fields];
    laws::PairCoefficients<R> coefficients;
    if constexpr (!many_materials) coefficients = laws::coefficients_from<R>(view.coefficients);
    R most(largest_overlap);
    for (std::int32_t first = 0; first < count; first += pair_chunk) {
        const int size = count - first < pair_chunk ? count - first : pair_chunk;
        for (int n = 0; n < size; n += width) {
            R field[record_fields];
            CombinePairs<Arch>::apply(view.records, i + first + n, j + first + n, field);
            if constexpr (many_materials)
                coefficients = gather_coefficients<Arch>(view, i + first + n, j + first + n);
            const laws::PairState<R> state{minimum_image(field[0], view.half_x, view.period_x),
                                           minimum_image(field[1], view.half_y, view.period_y),
                                           field[2],
                                           field[3],
                                           field[4],
                                           field[5],
                                           field[6]};
            const auto f = laws::pair_force<Normal, Tangential>(state, coefficients);
            most = max(f.overlap, most);
            StoreRows<Arch>::apply(f.x, f.y, f.tangential, R(0.0), rows + n * force_fields, force_fields);
        }
        add_forces(view.force, i + first, j + first, size, rows, target);
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
