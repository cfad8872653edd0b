// Free flight of eight particles at a time, and the cell that they come to. Those that may meet a wall or a
// periodic side on the way go one by one.
#pragma once

#include "laws/elementary.hpp"
#include "motion/ballistic.hpp"
#include "simd/dsmc/kinds.hpp"
#include "simd/dsmc/sort.ipp"
#include "simd/rows.hpp"
#include "simd/words.hpp"

namespace sandlane::simd {

// Both flights: moves places and velocities; returns the lanes that may meet a wall or a side on the way.
// Without gravity the middle of the way lies between its ends.
template <class Arch, int dimension>
SANDLANE_INLINE unsigned fly_freely(const GasFlightView& view, Block<Arch> (&x)[gas_row],
                                    Block<Arch> (&v)[gas_row]) {
    using R = Block<Arch>;
    R least[dimension], most[dimension];
    for (int d = 0; d < dimension; ++d) least[d] = most[d] = x[d];
    for (const double duration : view.durations) {
        if (!(duration > 0)) continue;
        const R time(duration), half_square(0.5 * duration * duration);
        for (int d = 0; d < dimension; ++d) {
            x[d] = motion::straight(x[d], v[d], time);
            if (!view.falls) continue;
            least[d] = min(least[d], x[d]);
            most[d] = max(most[d], x[d]);
            x[d] = motion::bent(x[d], R(view.gravity[d]), half_square);
            v[d] = v[d] + R(view.gravity[d]) * time;
            least[d] = min(least[d], x[d]);
            most[d] = max(most[d], x[d]);
        }
    }
    for (int d = 0; d < dimension; ++d) {
        least[d] = min(least[d], x[d]);
        most[d] = max(most[d], x[d]);
    }
    auto safe = (least[0] >= R(view.safe_lower[0])) & (most[0] < R(view.safe_upper[0]));
    for (int d = 1; d < dimension; ++d)
        safe = safe & (least[d] >= R(view.safe_lower[d])) & (most[d] < R(view.safe_upper[d]));
    return ~bits(safe) & 0xffu;
}

// Random kicks of the thermostat: two components from each block of random numbers.
class Kicks {
public:
    SANDLANE_INLINE explicit Kicks(const GasFlightView& view)
        : first_(block(view, 0)), second_(block(view, 1)), deviation_(view.kick) {}

    template <class Arch, int dimension>
    SANDLANE_INLINE void add(const Block<Arch>& word, Block<Arch> (&v)[gas_row]) const {
        const Words<Arch> id = words_of(word) & Words<Arch>(0xffffffffu);
        add_pair(first_(id), v[0], v[1]);
        Block<Arch> unused(0.0);
        if constexpr (dimension == 3) add_pair(second_(id), v[2], unused);
    }

private:
    static SANDLANE_INLINE Philox block(const GasFlightView& view, std::uint32_t n) {
        return Philox(n, view.random.step, view.random.last_word(GasStream::kick), view.random.key);
    }
    template <class Arch>
    SANDLANE_INLINE void add_pair(const PhiloxLanes<Arch>& draw, Block<Arch>& a, Block<Arch>& b) const {
        using R = Block<Arch>;
        const R u = unit_number(draw.w[0], draw.w[1]);
        const R radius = R(deviation_) * sqrt(R(-2.0) * laws::logarithm(R(1.0) - u));
        R sine, cosine;
        laws::sine_cosine_of_turn(unit_number(draw.w[2], draw.w[3]), sine, cosine);
        a = a + radius * cosine;
        b = b + radius * sine;
    }

    Philox first_, second_;
    double deviation_;
};

template <class Arch> SANDLANE_INLINE double sum_of_lanes(const Block<Arch>& b) {
    double l[width];
    store(l, b);
    return ((l[0] + l[1]) + (l[2] + l[3])) + ((l[4] + l[5]) + (l[6] + l[7]));
}

// Lanes that are left of eight.
template <class Arch> SANDLANE_INLINE Block<Arch> first_lanes(std::int32_t n, const Block<Arch>& value) {
    if (n >= width) return value;
    double lanes[width];
    store(lanes, value);
    for (int l = 0; l < width; ++l) lanes[l] = l < n ? lanes[l] : 0.0;
    return load<Arch>(lanes);
}

template <class Arch, int dimension>
SANDLANE_INLINE Block<Arch> number_of_cell(const GasFlightView& view, const Block<Arch> (&x)[gas_row]) {
    Block<Arch> number = laws::cell_number(view.axis[0], x[0]);
    for (int d = 1; d < dimension; ++d) number = number + laws::cell_number(view.axis[d], x[d]);
    return number;
}

// One particle to where it goes: those that stay, or those that leave the tile.
template <class Arch, bool rough>
SANDLANE_INLINE void put_particle(const GasFlightView& view, const double* place, const double* velocity,
                                  const double* spin, GasFlight& result) {
    const bool stays = !view.sort || static_cast<std::uint32_t>(cell_of<Arch>(place) - view.first_cell) <
                                         static_cast<std::uint32_t>(view.cells);
    const std::ptrdiff_t at = std::ptrdiff_t{stays ? result.stay : result.leave} * gas_row;
    const GasRows& to = stays ? view.stay : view.leave;
    copy_row<Arch>(to.place + at, place);
    copy_row<Arch>(to.velocity + at, velocity);
    if constexpr (rough) copy_row<Arch>(to.spin + at, spin);
    result.stay += stays ? 1 : 0;
    result.leave += stays ? 0 : 1;
}

// One particle along walls and sides, from where it started.
template <class Arch, int dimension>
SANDLANE_INLINE void fly_alone(const GasFlightView& view, double* place, double* velocity, double* spin,
                               GasFlight& result) {
    for (int second = 0; second < 2; ++second)
        if (view.durations[second] > 0) fly_to_walls(view, place, velocity, spin, second == 1, result);
    if (!view.sort) return;
    double number = laws::nearest_cell_number(view.axis[0], place[0]);
    for (int d = 1; d < dimension; ++d) number = number + laws::nearest_cell_number(view.axis[d], place[d]);
    const auto cell = static_cast<std::int32_t>(number);
    std::memcpy(reinterpret_cast<char*>(place + 3) + 4, &cell, sizeof cell);
}

template <class Arch>
SANDLANE_INLINE void store_lane(const Block<Arch> (&field)[gas_row], int lane, double* row) {
    double lanes[width];
    for (int f = 0; f < gas_row; ++f) {
        store(lanes, field[f]);
        row[f] = lanes[lane];
    }
}

// Eight particles of which lane `leaver` is the first that leaves.
template <class Arch, bool rough>
SANDLANE_INLINE void settle_from(const GasFlightView& view, const Block<Arch> (&x)[gas_row],
                                 const Block<Arch> (&v)[gas_row], std::int32_t first, int leaver,
                                 GasFlight& result) {
    alignas(64) double places[width * gas_row], velocities[width * gas_row], spins[width * gas_row];
    if constexpr (rough) copy_rows<Arch>(spins, view.from.spin + std::ptrdiff_t{first} * gas_row);
    store_rows(x, places);
    store_rows(v, velocities);
    const std::ptrdiff_t at = std::ptrdiff_t{result.stay} * gas_row;
    copy_rows<Arch>(view.stay.place + at, places);
    copy_rows<Arch>(view.stay.velocity + at, velocities);
    if constexpr (rough) copy_rows<Arch>(view.stay.spin + at, spins);
    result.stay += leaver;
    for (int l = leaver; l < width; ++l)
        put_particle<Arch, rough>(view, places + l * gas_row, velocities + l * gas_row, spins + l * gas_row,
                                  result);
}

template <class Arch, int dimension, bool rough>
SANDLANE_INLINE GasFlight fly_rows(const GasFlightView& given) {
    const GasFlightView view = given; // which no store can change
    using R = Block<Arch>;
    using W = Words<Arch>;
    GasFlight result;
    R squares(0.0);
    const R first_cell(view.first_cell), last_cell(view.first_cell + view.cells);
    const bool changes = view.falls || view.kick > 0;
    const Kicks kicks(view);
    for (std::int32_t first = 0; first < view.count; first += width) {
        const std::int32_t lanes = view.count - first < width ? view.count - first : width;
        const double* place = view.from.place + std::ptrdiff_t{first} * gas_row;
        const double* velocity = view.from.velocity + std::ptrdiff_t{first} * gas_row;
        R x[gas_row], v[gas_row], started[gas_row];
        Rows<Arch, gas_row>::load(place, x);
        Rows<Arch, gas_row>::load(velocity, v);
        if (view.kick > 0) kicks.template add<Arch, dimension>(x[3], v);
        R square = v[0] * v[0];
        for (int d = 1; d < dimension; ++d) square = square + v[d] * v[d];
        if (view.mass != nullptr) square = square * look_up(view.mass, kind_of(v[3]));
        squares = squares + first_lanes(lanes, square);
        if (changes)
            for (int d = 0; d < gas_row; ++d) started[d] = v[d];
        const unsigned at_walls = fly_freely<Arch, dimension>(view, x, v);
        unsigned leaves = 0;
        if (view.sort) {
            const R number = number_of_cell<Arch, dimension>(view, x);
            leaves = ~bits((number >= first_cell) & (number < last_cell)) & 0xffu;
            x[3] = block_of((words_of(x[3]) & W(0xffffffffu)) ^ left<32>(word_of(number)));
        }
        if (lanes == width && (at_walls | leaves) == 0) {
            const std::ptrdiff_t at = std::ptrdiff_t{result.stay} * gas_row;
            store_rows(x, view.stay.place + at);
            if (changes)
                store_rows(v, view.stay.velocity + at);
            else
                copy_rows<Arch>(view.stay.velocity + at, velocity);
            if constexpr (rough)
                copy_rows<Arch>(view.stay.spin + at, view.from.spin + std::ptrdiff_t{first} * gas_row);
            result.stay += width;
            continue;
        }
        if (lanes == width && at_walls == 0) { // some leave
            settle_from<Arch, rough>(view, x, v, first, __builtin_ctz(leaves), result);
            continue;
        }
        alignas(64) double places[width * gas_row], velocities[width * gas_row], none[gas_row];
        store_rows(x, places);
        store_rows(v, velocities);
        for (std::int32_t l = 0; l < lanes; ++l) {
            const int at = l * gas_row;
            double spin[gas_row];
            if constexpr (rough) copy_row<Arch>(spin, view.from.spin + std::ptrdiff_t{first} * gas_row + at);
            if ((at_walls >> l & 1u) != 0) {
                copy_row<Arch>(places + at, place + at);
                if (changes) store_lane(started, l, velocities + at);
                fly_alone<Arch, dimension>(given, places + at, velocities + at, rough ? spin : none, result);
            }
            put_particle<Arch, rough>(view, places + at, velocities + at, spin, result);
        }
    }
    result.square_sum = sum_of_lanes(squares);
    return result;
}

template <class Arch, int dimension> GasFlight fly_gas(const GasFlightView& view) {
    return view.from.spin != nullptr ? fly_rows<Arch, dimension, true>(view)
                                     : fly_rows<Arch, dimension, false>(view);
}

} // namespace sandlane::simd
