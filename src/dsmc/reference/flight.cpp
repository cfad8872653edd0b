// Sorting and free flight, one particle after the other.
#include "core/rng.hpp"
#include "dsmc/reference/pair.hpp"
#include "dsmc/reference/reference.hpp"
#include "laws/wall_times.hpp"

#include <algorithm>
#include <cstring>

namespace sandlane::simd::reference {

namespace {

std::int32_t cell_of(const double* place) {
    std::uint64_t word = 0;
    std::memcpy(&word, place + 3, sizeof word);
    return static_cast<std::int32_t>(word >> 32);
}

void copy(const GasRows& from, std::int32_t i, const GasRows& to, std::int32_t j) {
    const std::ptrdiff_t a = std::ptrdiff_t{i} * gas_row, b = std::ptrdiff_t{j} * gas_row;
    std::copy_n(from.place + a, gas_row, to.place + b);
    std::copy_n(from.velocity + a, gas_row, to.velocity + b);
    if (from.spin != nullptr) std::copy_n(from.spin + a, gas_row, to.spin + b);
}

} // namespace

std::int32_t sort_gas(const SortView& view) {
    std::int32_t* next = view.next[0];
    std::fill_n(view.start, view.cells + 1, 0);
    const auto for_each = [&](const auto& body) {
        for (std::int32_t s = 0; s < view.segment_count; ++s)
            for (std::int32_t i = 0; i < view.segments[s].count; ++i) {
                const std::int32_t c =
                    cell_of(view.segments[s].place + std::ptrdiff_t{i} * gas_row) - view.first_cell;
                if (c >= 0 && c < view.cells) body(view.segments[s], i, c);
            }
    };
    for_each([&](const GasSegment&, std::int32_t, std::int32_t c) { ++view.start[c + 1]; });
    for (std::int32_t c = 0; c < view.cells; ++c) {
        next[c] = view.start[c];
        view.start[c + 1] += view.start[c];
    }
    for_each([&](const GasSegment& from, std::int32_t i, std::int32_t c) {
        const GasRows rows{const_cast<double*>(from.place), const_cast<double*>(from.velocity),
                           const_cast<double*>(from.spin)};
        copy(rows, i, view.to, next[c]++);
    });
    return view.start[view.cells];
}

template <int dimension> GasFlight fly_gas(const GasFlightView& view) {
    GasFlight result;
    double squares[8] = {};
    for (std::int32_t i = 0; i < view.count; ++i) {
        double place[gas_row], velocity[gas_row], spin[gas_row] = {};
        const GasRows own{place, velocity, view.from.spin != nullptr ? spin : nullptr};
        copy(view.from, i, own, 0);
        if (view.kick > 0) {
            std::uint32_t id = 0;
            std::memcpy(&id, place + 3, sizeof id);
            for (int d = 0; d < dimension; d += 2) {
                const PhiloxCounter w =
                    draw(view.random, static_cast<std::uint32_t>(d / 2), id, GasStream::kick);
                const double radius =
                    view.kick * std::sqrt(-2.0 * laws::logarithm(1.0 - unit_number(w[0], w[1])));
                double sine = 0, cosine = 0;
                laws::sine_cosine_of_turn(unit_number(w[2], w[3]), sine, cosine);
                velocity[d] += radius * cosine;
                if (d + 1 < dimension) velocity[d + 1] += radius * sine;
            }
        }
        double square = velocity[0] * velocity[0];
        for (int d = 1; d < dimension; ++d) square += velocity[d] * velocity[d];
        if (view.mass != nullptr) square *= view.mass[kind_of(velocity)];
        squares[i % 8] += square;
        for (const bool second : {false, true})
            if (view.durations[second ? 1 : 0] > 0) fly_to_walls(view, place, velocity, spin, second, result);
        std::int32_t cell = view.first_cell;
        if (view.sort) {
            double number = laws::nearest_cell_number(view.axis[0], place[0]);
            for (int d = 1; d < dimension; ++d) number += laws::nearest_cell_number(view.axis[d], place[d]);
            cell = static_cast<std::int32_t>(number);
            std::memcpy(reinterpret_cast<char*>(place + 3) + 4, &cell, sizeof cell);
        }
        const bool stays = cell >= view.first_cell && cell < view.first_cell + view.cells;
        if (stays)
            copy(own, 0, view.stay, result.stay++);
        else
            copy(own, 0, view.leave, result.leave++);
    }
    result.square_sum = ((squares[0] + squares[1]) + (squares[2] + squares[3])) +
                        ((squares[4] + squares[5]) + (squares[6] + squares[7]));
    return result;
}

template GasFlight fly_gas<2>(const GasFlightView&);
template GasFlight fly_gas<3>(const GasFlightView&);

} // namespace sandlane::simd::reference

namespace sandlane::simd {

const DsmcKernels& dsmc_kernels_scalar();
const DsmcKernels& dsmc_kernels_scalar() {
    static const DsmcKernels table{reference::sort_gas,
                                   {{{reference::collide_gas<2, false>, reference::collide_gas<2, false>},
                                     {reference::collide_gas<2, true>, reference::collide_gas<2, true>}},
                                    {{reference::collide_gas<3, false>, reference::collide_gas<3, false>},
                                     {reference::collide_gas<3, true>, reference::collide_gas<3, true>}}},
                                   {reference::fly_gas<2>, reference::fly_gas<3>}};
    return table;
}

} // namespace sandlane::simd
