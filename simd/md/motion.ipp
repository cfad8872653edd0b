// Gear predictor-corrector, eight particles at a time: correct with the forces of this step, predict the
// next, wrap, and write the records that the pair kernels read, in one pass over the state.
#pragma once

#include "motion/gear.hpp"
#include "simd/lanes.hpp"
#include "simd/rows.hpp"
#include "simd/tables.hpp"

namespace sandlane::simd {

// Lanes that left [lower, upper) below or above.
struct Left {
    unsigned below, above;
    [[nodiscard]] bool any() const { return (below | above) != 0; }
};

// Wraps one coordinate into [lower, upper) and counts the image. Rounding of the sum may give exactly upper:
// that is lower.
template <class Arch>
SANDLANE_INLINE Left wrap(Block<Arch>& x, double lower, double upper, double period, std::int32_t* image) {
    using R = Block<Arch>;
    const auto below = x < R(lower);
    const auto above = x >= R(upper);
    const Left left{bits(below), bits(above)};
    if (!left.any()) return left;
    for (int l = 0; l < width; ++l)
        image[l] += static_cast<int>(left.above >> l & 1u) - static_cast<int>(left.below >> l & 1u);
    const R moved = select(below, x + R(period), select(above, x - R(period), x));
    x = select(moved >= R(upper), select(below, R(lower), moved), moved);
    return left;
}

// Who crosses a Lees-Edwards seam goes on at the place and with the velocity of the image. Returns what that
// gave to the `real` particles from `first` on, kinetic energy times dt^2: that of their velocity in the
// middle of the step, because the sum over forces across the seam takes half of a step for either side.
// `bend`: k = 2 along x.
template <class Arch>
SANDLANE_INLINE double cross_seam(const MotionView& view, const Left& left, std::int64_t first, unsigned real,
                                  const double* bend, Block<Arch>& x, Block<Arch>& shift) {
    double places[width], shifts[width], gain = 0;
    store(places, x);
    store(shifts, shift);
    for (int l = 0; l < width; ++l) {
        if (((left.above | left.below) >> l & 1u) == 0) continue;
        const double before = shifts[l];
        if ((left.above >> l & 1u) != 0) places[l] -= view.seam, shifts[l] -= view.seam_shift;
        if ((left.below >> l & 1u) != 0) places[l] += view.seam, shifts[l] += view.seam_shift;
        const double jump = shifts[l] - before;
        if ((real >> l & 1u) != 0)
            gain += (before - bend[l] + 0.5 * jump) * jump / view.inverse_mass[first + l];
    }
    x = load<Arch>(places);
    shift = load<Arch>(shifts);
    return gain;
}

// What a pass does. Both at once is every step but the first and the last of a run: its kernels are compiled
// for that, and once more for either.
struct Phase {
    bool correct, predict;
};

// One degree of freedom of eight particles: `value` and `shift` are k = 0 and 1, the rest stands in `gear`.
template <class Arch, int scheme>
SANDLANE_INLINE void step_value(Phase phase, double* gear, Block<Arch>& value, Block<Arch>& shift,
                                const Block<Arch>& acceleration, const Block<Arch>& half_dt2) {
    constexpr int order = motion::values_of(scheme);
    Block<Arch> x[order];
    x[0] = value;
    x[1] = shift;
    for (int k = 2; k < order; ++k) x[k] = load<Arch>(gear + (k - 2) * width);
    if (phase.correct) motion::correct<scheme>(x, acceleration, half_dt2);
    if (phase.predict) motion::predict<scheme>(x);
    value = x[0];
    shift = x[1];
    for (int k = 2; k < order; ++k) store(gear + (k - 2) * width, x[k]);
}

// Forces of eight particles, which are taken: the accumulators become zero.
template <class Arch, int fields>
SANDLANE_INLINE void take_forces(double* force, Block<Arch> (&row)[fields]) {
    Rows<Arch, fields>::load(force, row);
    for (int f = 0; f < fields; ++f) store(force + f * width, Block<Arch>(0.0));
}

// Lanes below `end`; the others keep zero.
template <class Arch> SANDLANE_INLINE Block<Arch> only(unsigned real, const Block<Arch>& value) {
    if (real == 0xffu) return value;
    double lanes[width];
    store(lanes, value);
    for (int l = 0; l < width; ++l) lanes[l] = (real >> l & 1u) != 0 ? lanes[l] : 0.0;
    return load<Arch>(lanes);
}

// Wraps the predicted positions of eight particles and looks at them and at their speed.
template <class Arch, int dimension>
SANDLANE_INLINE void settle(const MotionView& view, std::int64_t first, unsigned real, const double* bend,
                            Block<Arch> (&record)[record_fields], Block<Arch>& most, MotionResult& result) {
    using R = Block<Arch>;
    unsigned inside = 0xffu;
    R shift2(0.0);
    for (int d = dimension - 1; d >= 0; --d) { // y before x, which a seam may change
        if (!(view.period[d] > 0)) continue;
        const Left left =
            wrap(record[d], view.lower[d], view.upper[d], view.period[d], view.image[d] + first);
        if (d == 1 && left.any() && view.sheared)
            result.seam_gain += cross_seam(view, left, first, real, bend, record[0], record[dimension]);
    }
    for (int d = 0; d < dimension; ++d) {
        inside &= bits((record[d] >= R(view.lower[d])) & (record[d] < R(view.upper[d])));
        const R shift = record[dimension + d];
        shift2 = d == 0 ? shift * shift : shift2 + shift * shift;
    }
    result.outside += __builtin_popcount(real & ~inside);
    most = max(only(real, shift2), most);
}

template <class Arch, int dimension, int scheme, Rotation rotation>
SANDLANE_INLINE MotionResult gear_step(Phase phase, const MotionView& view, std::int64_t begin,
                                       std::int64_t end) {
    using R = Block<Arch>;
    using Fields = Record<dimension>;
    constexpr bool turns = rotation != Rotation::none, couples = rotation == Rotation::couples;
    constexpr int order = motion::values_of(scheme);
    constexpr int dofs = degrees_of_freedom(dimension, turns), fields = force_stride(dimension, rotation);
    const auto step = [&](double* gear, int dof, R& value, R& shift, const R& acceleration) {
        step_value<Arch, scheme>(phase, gear + dof * (order - 2) * width, value, shift, acceleration,
                                 R(view.half_dt2));
    };
    R most(0.0);
    MotionResult result;
    for (std::int64_t first = begin; first < end; first += width) {
        double* gear = view.gear + first * dofs * (order - 2);
        R record[record_fields], force[fields], inverse_mass(0.0);
        Rows<Arch, record_fields>::load(view.records + first * record_fields, record);
        for (int f = 0; f < fields; ++f) force[f] = R(0.0);
        if (phase.correct) {
            take_forces<Arch, fields>(view.force + (first - begin) * fields, force);
            inverse_mass = load<Arch>(view.inverse_mass + first);
        }
        for (int d = 0; d < dimension; ++d)
            step(gear, d, record[d], record[dimension + d], force[d] * inverse_mass + R(view.gravity[d]));
        const R of_torque = R(view.inverse_inertia) * inverse_mass; // R^2/J
        if constexpr (turns && dimension == 2) {
            R torque = force[2];
            if constexpr (couples) torque = torque + force[3] * record[Fields::inverse_radius];
            step(gear, 2, record[Fields::angle], record[Fields::spin],
                 torque * of_torque + record[Fields::radius] * R(view.gravity_spin));
        }
        if constexpr (turns && dimension == 3) {
            R spin[spin_fields];
            Rows<Arch, spin_fields>::load(view.spins + first * spin_fields, spin);
            for (int d = 0; d < 3; ++d) {
                R no_angle(0.0), torque = force[4 + d];
                if constexpr (couples) torque = torque + force[8 + d] * record[Fields::inverse_radius];
                step(gear, 3 + d, no_angle, spin[d], torque * (of_torque * record[Fields::inverse_radius]));
            }
            Rows<Arch, spin_fields>::store(spin, view.new_spins + first * spin_fields);
        }
        const unsigned real = end - first >= width ? 0xffu : (1u << (end - first)) - 1u;
        if (phase.predict) settle<Arch, dimension>(view, first, real, gear, record, most, result);
        Rows<Arch, record_fields>::store(record, view.new_records + first * record_fields);
    }
    result.largest_shift2 = largest(most);
    return result;
}

template <class Arch, int dimension, int scheme, Rotation rotation>
MotionResult advance(const MotionView& view, std::int64_t begin, std::int64_t end) {
    return gear_step<Arch, dimension, scheme, rotation>({true, true}, view, begin, end);
}
template <class Arch, int dimension, int scheme, Rotation rotation>
__attribute__((noinline)) MotionResult either(bool correct, const MotionView& view, std::int64_t begin,
                                              std::int64_t end) {
    return gear_step<Arch, dimension, scheme, rotation>({correct, !correct}, view, begin, end);
}
template <class Arch, int dimension, int scheme, Rotation rotation>
MotionResult correct(const MotionView& view, std::int64_t begin, std::int64_t end) {
    return either<Arch, dimension, scheme, rotation>(true, view, begin, end);
}
template <class Arch, int dimension, int scheme, Rotation rotation>
MotionResult predict(const MotionView& view, std::int64_t begin, std::int64_t end) {
    return either<Arch, dimension, scheme, rotation>(false, view, begin, end);
}

// Lattice site or cell of each particle (floor, and the quotient rounded up is clamped; a corrected position
// may lie below the lower side too).
template <class Arch, int dimension>
void bin_sites(const BinView& view, std::int64_t begin, std::int64_t end) {
    using R = Block<Arch>;
    for (std::int64_t first = begin; first < end; first += width) {
        double place[dimension][width], offset[dimension][width];
        for (int d = 0; d < dimension; ++d) {
            for (int l = 0; l < width; ++l) place[d][l] = view.records[(first + l) * record_fields + d];
            const R x = load<Arch>(place[d]) - R(view.lower[d]);
            const R at = max(min(floor(x * R(1.0 / view.edge[d])), R(view.count[d] - 1)), R(0.0));
            store(place[d], at);
            store(offset[d], x - (at + R(0.5)) * R(view.edge[d]));
        }
        const int size = end - first < width ? static_cast<int>(end - first) : width;
        for (int l = 0; l < size; ++l) {
            std::ptrdiff_t site = view.origin;
            for (int d = 0; d < dimension; ++d)
                site += static_cast<std::int32_t>(place[d][l]) * view.stride[d];
            view.site[first + l] = static_cast<std::int32_t>(site);
        }
        if (view.relative_x == nullptr) continue;
        for (int l = 0; l < size; ++l) {
            view.relative_x[first + l] = static_cast<float>(offset[0][l]);
            view.relative_y[first + l] = static_cast<float>(offset[1][l]);
            const auto c = static_cast<std::uint32_t>(static_cast<std::int32_t>(place[0][l]) - view.reach);
            const auto r = static_cast<std::uint32_t>(static_cast<std::int32_t>(place[1][l]) - view.reach);
            const bool interior = c < static_cast<std::uint32_t>(view.count[0] - 2 * view.reach) &&
                                  r < static_cast<std::uint32_t>(view.count[1] - 2 * view.reach);
            view.edge_site[first + l] = interior ? 0 : 1;
        }
    }
}

} // namespace sandlane::simd
