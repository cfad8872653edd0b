// Gear predictor-corrector, eight particles at a time: correct with the forces of this step, predict the
// next, wrap, and write the records that the pair kernels read, in one pass over the state.
#pragma once

#include "motion/gear.hpp"
#include "simd/lanes.hpp"
#include "simd/tables.hpp"

namespace sandlane::simd {

template <class Arch, int order>
SANDLANE_INLINE void load_dof(const double* gear, int dof, Block<Arch> (&x)[order]) {
    for (int k = 0; k < order; ++k) x[k] = load<Arch>(gear + (dof * order + k) * width);
}
template <class Arch, int order>
SANDLANE_INLINE void store_dof(double* gear, int dof, const Block<Arch> (&x)[order]) {
    for (int k = 0; k < order; ++k) store(gear + (dof * order + k) * width, x[k]);
}

// Wraps one coordinate into [lower, upper) and counts the image. Rounding of the sum may give exactly upper:
// that is lower.
template <class Arch>
SANDLANE_INLINE Block<Arch> wrap(const Block<Arch>& x, double lower, double upper, double period,
                                 std::int32_t* image) {
    using R = Block<Arch>;
    const auto below = x < R(lower);
    const auto above = x >= R(upper);
    const unsigned low = bits(below), high = bits(above);
    if ((low | high) == 0) return x;
    for (int l = 0; l < width; ++l)
        image[l] += static_cast<int>(high >> l & 1u) - static_cast<int>(low >> l & 1u);
    const R moved = select(below, x + R(period), select(above, x - R(period), x));
    return select(moved >= R(upper), select(below, R(lower), moved), moved);
}

template <class Arch, int order, bool spin, bool do_correct, bool do_predict>
MotionResult gear_step(const MotionView& view, std::int64_t begin, std::int64_t end) {
    using R = Block<Arch>;
    constexpr int dofs = spin ? 3 : 2;
    const R half_dt2(view.half_dt2), inverse_dt(view.inverse_dt);
    R most(0.0);
    std::int64_t outside = 0;
    for (std::int64_t first = begin; first < end; first += width) {
        double* gear = view.gear + first * dofs * order;
        R x[order], y[order], phi[order];
        load_dof<Arch, order>(gear, 0, x);
        load_dof<Arch, order>(gear, 1, y);
        if constexpr (spin) load_dof<Arch, order>(gear, 2, phi);
        if constexpr (do_correct) {
            R fx, fy, ft;
            double* force = view.force + (first - begin) * force_fields;
            LoadRows<Arch>::apply(force, fx, fy, ft);
            for (int row = 0; row < force_fields; ++row) store(force + row * width, R(0.0));
            const R inverse_mass = load<Arch>(view.inverse_mass + first);
            motion::gear_correct(x, fx * inverse_mass + R(view.gravity_x), half_dt2);
            motion::gear_correct(y, fy * inverse_mass + R(view.gravity_y), half_dt2);
            if constexpr (spin)
                motion::gear_correct(phi, ft * load<Arch>(view.spin_factor + first) + R(view.gravity_phi),
                                     half_dt2);
        }
        if constexpr (do_predict) {
            motion::gear_predict(x);
            motion::gear_predict(y);
            if constexpr (spin) motion::gear_predict(phi);
            if (view.period_x > 0)
                x[0] = wrap(x[0], view.lower_x, view.upper_x, view.period_x, view.image_x + first);
            if (view.period_y > 0)
                y[0] = wrap(y[0], view.lower_y, view.upper_y, view.period_y, view.image_y + first);
            const unsigned real = end - first >= width ? 0xffu : (1u << (end - first)) - 1u;
            const unsigned inside = bits((x[0] >= R(view.lower_x)) & (x[0] < R(view.upper_x)) &
                                         (y[0] >= R(view.lower_y)) & (y[0] < R(view.upper_y)));
            outside += __builtin_popcount(real & ~inside);
            const R vx = x[1] * inverse_dt, vy = y[1] * inverse_dt;
            const R speed2 = vx * vx + vy * vy;
            if (real == 0xffu) {
                most = max(speed2, most);
            } else {
                double lanes[width];
                store(lanes, speed2);
                for (int l = 0; l < width; ++l) lanes[l] = (real >> l & 1u) != 0 ? lanes[l] : 0.0;
                most = max(load<Arch>(lanes), most);
            }
            double* record = view.records + first * record_fields;
            StoreRows<Arch>::apply(x[0], y[0], vx, vy, record, record_fields);
            if constexpr (spin) {
                const R radius = load<Arch>(view.radius + first);
                StoreRows<Arch>::apply(radius * (phi[1] * inverse_dt), radius,
                                       load<Arch>(view.inverse_radius + first), R(0.0), record + 4,
                                       record_fields);
            }
        }
        store_dof<Arch, order>(gear, 0, x);
        store_dof<Arch, order>(gear, 1, y);
        if constexpr (spin) store_dof<Arch, order>(gear, 2, phi);
    }
    return {largest(most), outside};
}

// Lattice site of each particle (floor, and the quotient rounded up is clamped; a corrected position may lie
// below the lower side too).
template <class Arch> void bin_sites(const BinView& view, std::int64_t begin, std::int64_t end) {
    using R = Block<Arch>;
    const R half(0.5), inverse_dx(1.0 / view.dx), inverse_dy(1.0 / view.dy);
    for (std::int64_t first = begin; first < end; first += width) {
        double xs[width], ys[width], us[width], vs[width];
        for (int l = 0; l < width; ++l) {
            xs[l] = view.records[(first + l) * record_fields];
            ys[l] = view.records[(first + l) * record_fields + 1];
        }
        const R x = load<Arch>(xs) - R(view.lower_x), y = load<Arch>(ys) - R(view.lower_y);
        const R column = max(min(floor(x * inverse_dx), R(view.columns - 1)), R(0.0));
        const R row = max(min(floor(y * inverse_dy), R(view.rows - 1)), R(0.0));
        store(xs, column);
        store(ys, row);
        const int size = end - first < width ? static_cast<int>(end - first) : width;
        for (int l = 0; l < size; ++l)
            view.site[first + l] =
                static_cast<std::int32_t>(view.origin) +
                static_cast<std::int32_t>(ys[l]) * static_cast<std::int32_t>(view.row_stride) +
                static_cast<std::int32_t>(xs[l]);
        if (view.relative_x == nullptr) continue;
        store(us, x - (column + half) * R(view.dx));
        store(vs, y - (row + half) * R(view.dy));
        for (int l = 0; l < size; ++l) {
            view.relative_x[first + l] = static_cast<float>(us[l]);
            view.relative_y[first + l] = static_cast<float>(vs[l]);
            const auto c = static_cast<std::uint32_t>(static_cast<std::int32_t>(xs[l]) - view.reach);
            const auto r = static_cast<std::uint32_t>(static_cast<std::int32_t>(ys[l]) - view.reach);
            const bool interior = c < static_cast<std::uint32_t>(view.columns - 2 * view.reach) &&
                                  r < static_cast<std::uint32_t>(view.rows - 2 * view.reach);
            view.edge[first + l] = interior ? 0 : 1;
        }
    }
}

} // namespace sandlane::simd
