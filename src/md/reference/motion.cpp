// The integrator and the binning, one particle at a time.
#include "md/reference/reference.hpp"
#include "motion/gear.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sandlane::simd::reference {

namespace {

double wrap(double x, double lower, double upper, double period, std::int32_t& image) {
    if (x < lower) {
        --image;
        x += period;
        return x >= upper ? lower : x;
    }
    if (x >= upper) {
        ++image;
        x -= period;
    }
    return x;
}

// One degree of freedom: k = 0 and 1 by reference, the rest eight apart in `gear`.
template <int scheme, bool do_correct, bool do_predict>
void step_value(double* gear, double& value, double& shift, double acceleration, double half_dt2) {
    constexpr int order = motion::values_of(scheme);
    double x[order];
    x[0] = value;
    x[1] = shift;
    for (int k = 2; k < order; ++k) x[k] = gear[(k - 2) * 8];
    if (do_correct) motion::correct<scheme>(x, acceleration, half_dt2);
    if (do_predict) motion::predict<scheme>(x);
    value = x[0];
    shift = x[1];
    for (int k = 2; k < order; ++k) gear[(k - 2) * 8] = x[k];
}

template <int dimension>
void settle(const MotionView& view, std::int64_t i, double bend, double* record, double& gain,
            MotionResult& result) {
    bool inside = true;
    double shift2 = 0;
    for (int d = dimension - 1; d >= 0; --d) { // y before x, which a seam may change
        if (!(view.period[d] > 0)) continue;
        const std::int32_t before = view.image[d][i];
        record[d] = wrap(record[d], view.lower[d], view.upper[d], view.period[d], view.image[d][i]);
        if (d != 1 || !view.sheared) continue;
        const double crossed = view.image[d][i] - before;
        if (crossed == 0) continue;
        const double old = record[dimension];
        record[0] -= crossed * view.seam;
        record[dimension] -= crossed * view.seam_shift;
        const double jump = record[dimension] - old; // at the velocity in the middle of the step
        gain += (old - bend + 0.5 * jump) * jump / view.inverse_mass[i];
    }
    for (int d = 0; d < dimension; ++d) {
        inside = inside && record[d] >= view.lower[d] && record[d] < view.upper[d];
        shift2 += record[dimension + d] * record[dimension + d];
    }
    if (!inside) ++result.outside;
    if (shift2 > result.largest_shift2) result.largest_shift2 = shift2;
}

template <int dimension, int scheme, Rotation rotation, bool do_correct, bool do_predict>
MotionResult gear_step(const MotionView& view, std::int64_t begin, std::int64_t end) {
    using Fields = Record<dimension>;
    constexpr bool turns = rotation != Rotation::none, couples = rotation == Rotation::couples;
    constexpr int order = motion::values_of(scheme);
    constexpr int dofs = degrees_of_freedom(dimension, turns), fields = force_stride(dimension, rotation);
    MotionResult result;
    double gain = 0; // by eights, as kernels add
    for (std::int64_t i = begin; i < end; ++i) {
        double* gear = view.gear + (i - i % 8) * dofs * (order - 2) + i % 8;
        const auto step = [&](int dof, double& value, double& shift, double acceleration) {
            step_value<scheme, do_correct, do_predict>(gear + dof * (order - 2) * 8, value, shift,
                                                       acceleration, view.half_dt2);
        };
        double force[fields] = {};
        if (do_correct)
            for (int f = 0; f < fields; ++f) std::swap(force[f], view.force[(i - begin) * fields + f]);
        const double inverse_mass = view.inverse_mass[i];
        double record[record_fields];
        std::copy_n(view.records + i * record_fields, record_fields, record);
        for (int d = 0; d < dimension; ++d)
            step(d, record[d], record[dimension + d], force[d] * inverse_mass + view.gravity[d]);
        const double of_torque = view.inverse_inertia * inverse_mass;
        const auto torque = [&](int at, int couple) { // over R
            return couples ? force[at] + force[couple] * record[Fields::inverse_radius] : force[at];
        };
        if constexpr (turns && dimension == 2)
            step(2, record[Fields::angle], record[Fields::spin],
                 torque(2, 3) * of_torque + record[Fields::radius] * view.gravity_spin);
        if constexpr (turns && dimension == 3) {
            double* spin = view.new_spins + i * spin_fields;
            std::copy_n(view.spins + i * spin_fields, spin_fields, spin);
            for (int d = 0; d < 3; ++d) {
                double no_angle = 0;
                step(3 + d, no_angle, spin[d],
                     torque(4 + d, 8 + d) * (of_torque * record[Fields::inverse_radius]));
            }
        }
        if (i % 8 == 0) result.seam_gain += std::exchange(gain, 0.0);
        if (do_predict) settle<dimension>(view, i, *gear, record, gain, result);
        std::copy_n(record, record_fields, view.new_records + i * record_fields);
    }
    result.seam_gain += gain;
    return result;
}

template <int dimension> void bin_sites(const BinView& view, std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i) {
        const double* r = view.records + i * record_fields;
        std::int32_t place[dimension];
        double offset[dimension];
        std::ptrdiff_t site = view.origin;
        for (int d = 0; d < dimension; ++d) {
            const double x = r[d] - view.lower[d];
            place[d] = static_cast<std::int32_t>(
                std::clamp(std::floor(x * (1.0 / view.edge[d])), 0.0, view.count[d] - 1.0));
            offset[d] = x - (place[d] + 0.5) * view.edge[d];
            site += place[d] * view.stride[d];
        }
        view.site[i] = static_cast<std::int32_t>(site);
        if (view.relative_x == nullptr) continue;
        view.relative_x[i] = static_cast<float>(offset[0]);
        view.relative_y[i] = static_cast<float>(offset[1]);
        const bool interior = place[0] >= view.reach && place[0] < view.count[0] - view.reach &&
                              place[1] >= view.reach && place[1] < view.count[1] - view.reach;
        view.edge_site[i] = interior ? 0 : 1;
    }
}

template <int dimension, int scheme, Rotation rotation> void fill(DimensionKernels& t) {
    constexpr int r = static_cast<int>(rotation);
    t.predict[scheme - 3][r] = gear_step<dimension, scheme, rotation, false, true>;
    t.correct[scheme - 3][r] = gear_step<dimension, scheme, rotation, true, false>;
    t.advance[scheme - 3][r] = gear_step<dimension, scheme, rotation, true, true>;
}
template <int dimension, int scheme> void fill_rotations(DimensionKernels& t) {
    fill<dimension, scheme, Rotation::none>(t);
    fill<dimension, scheme, Rotation::friction>(t);
    fill<dimension, scheme, Rotation::couples>(t);
}
template <int dimension> void fill_dimension(DimensionKernels& t) {
    fill_rotations<dimension, 3>(t);
    fill_rotations<dimension, 4>(t);
    fill_rotations<dimension, 5>(t);
    fill_rotations<dimension, 6>(t);
    fill<dimension, motion::verlet_with_slope, Rotation::none>(t);
    fill<dimension, motion::verlet_with_slope, Rotation::friction>(t);
    t.bin = bin_sites<dimension>;
}

} // namespace

void fill_motion(MdKernels& kernels) {
    fill_dimension<2>(kernels.plane);
    fill_dimension<3>(kernels.space);
}

} // namespace sandlane::simd::reference
