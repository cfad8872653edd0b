#include "md/state.hpp"

#include "core/error.hpp"

#include <algorithm>

namespace sandlane::md {

void State::prepare(const Plan& plan, const scene::Domain& domain) {
    dimension = plan.dimension;
    order = plan.order;
    rotation = plan.rotation;
    follows_orientation_ = plan.orientation;
    parking_ = plan.lower;
    for (std::size_t d = 0; d < 3; ++d) periodic_[d] = domain.periodic[d] && static_cast<int>(d) < dimension;
}

std::size_t State::bytes() const {
    std::size_t total = gear.bytes() + next_record.bytes() + next_spin.bytes() + force.bytes();
    for_columns([&](const auto& column, std::size_t) { total += column.bytes(); });
    return total;
}

double State::largest_radius() const {
    double largest = 0;
    for (std::size_t i = 0; i < size(); ++i) largest = std::max(largest, radius(i));
    return largest;
}

Vec State::turn(std::size_t i) const {
    if (!turns()) return {};
    if (dimension == 2)
        return {0, 0, record_of(i)[simd::Record<2>::spin] * record_of(i)[simd::Record<2>::inverse_radius]};
    const double* s = spin.data() + i * simd::spin_fields;
    return {s[0], s[1], s[2]};
}

double State::angle(std::size_t i) const {
    if (!turns() || dimension == 3) return 0;
    return record_of(i)[simd::Record<2>::angle] * record_of(i)[simd::Record<2>::inverse_radius];
}

void State::resize(std::size_t n) {
    gear.resize(padded(n) * gear_fields(), 0.0);
    for_columns([&](auto& column, std::size_t fields) {
        column.resize((fields > 1 ? padded(n) + block_width : n) * fields, {});
    });
    resize_buffers();
}

void State::resize_buffers() {
    const std::size_t rows = padded(size()) + block_width;
    next_record.resize(double_records ? record.size() : 0, 0.0);
    next_spin.resize(double_records ? spin.size() : 0, 0.0);
    force.resize(double_records ? 0 : rows * force_stride(), 0.0);
}

// Padding lanes go through the integrator like particles; gravity must not carry them to infinity for ever.
void State::park_padding() {
    for (std::size_t i = size(); i < padded(size()) + block_width; ++i) {
        std::fill_n(record_of(i), simd::record_fields, 0.0);
        const double at[] = {parking_.x, parking_.y, parking_.z};
        std::copy_n(at, dimension, record_of(i));
        if (spin_fields() > 0) std::fill_n(spin.data() + i * simd::spin_fields, simd::spin_fields, 0.0);
    }
    for (std::size_t i = size(); i < padded(size()); ++i) {
        for (int dof = 0; dof < dofs(); ++dof)
            for (int k = 2; k < order; ++k) value(i, dof, k) = 0.0;
        inverse_mass.data()[i] = 0.0;
        material.data()[i] = 0;
    }
}

void State::append(const scene::GrainState& grain, double dt) {
    const std::size_t i = size();
    resize(i + 1);
    mass[i] = grain.mass;
    inverse_mass[i] = 1.0 / grain.mass;
    material[i] = grain.material;
    id[i] = grain.id;
    // The lane may have been padding, which the integrator moves along.
    for (int dof = 0; dof < dofs(); ++dof)
        for (int k = 2; k < order; ++k) value(i, dof, k) = 0.0;
    const Vec p = grain.position, v = dt * grain.velocity, w = dt * grain.angular_velocity;
    const double r = grain.radius, inverse = 1.0 / grain.radius;
    if (dimension == 2) {
        const double arc = turns() ? r * (grain.omega * dt) : 0.0, angle = turns() ? r * grain.angle : 0.0;
        const double fields[] = {p.x, p.y, v.x, v.y, arc, r, inverse, angle};
        std::copy_n(fields, simd::record_fields, record_of(i));
    } else {
        const double fields[] = {p.x, p.y, p.z, v.x, v.y, v.z, r, inverse};
        std::copy_n(fields, simd::record_fields, record_of(i));
    }
    if (spin_fields() > 0) {
        const double fields[] = {w.x, w.y, w.z, r};
        std::copy_n(fields, simd::spin_fields, spin.data() + i * simd::spin_fields);
    }
    if (follows_orientation_) set_orientation(i, {});
    park_padding();
}

void State::set_orientation(std::size_t i, Quaternion q) {
    double* to = orientation.data() + 4 * i;
    to[0] = q.w;
    to[1] = q.x;
    to[2] = q.y;
    to[3] = q.z;
}

void State::set_accelerations(std::size_t i, const double* forces, const simd::MotionView& view) {
    const double m = inverse_mass[i], of_torque = view.inverse_inertia * m;
    for (int d = 0; d < dimension; ++d) value(i, d, 2) = view.half_dt2 * (forces[d] * m + view.gravity[d]);
    if (!turns()) return;
    const auto torque = [&](int at, int couple) { // over R
        const bool couples = rotation == simd::Rotation::couples;
        return couples ? forces[at] + forces[couple] * inverse_radius(i) : forces[at];
    };
    if (dimension == 2)
        value(i, 2, 2) = view.half_dt2 * (torque(2, 3) * of_torque + radius(i) * view.gravity_spin);
    for (int d = 0; dimension == 3 && d < 3; ++d)
        value(i, 3 + d, 2) = view.half_dt2 * (torque(4 + d, 8 + d) * (of_torque * inverse_radius(i)));
}

void State::rescale(double ratio) {
    for (std::size_t i = 0; i < size(); ++i) {
        double* const velocity = record_of(i) + dimension;
        for (int d = 0; d < dimension; ++d) velocity[d] *= ratio;
        if (dimension == 2) record_of(i)[simd::Record<2>::spin] *= ratio;
        if (spin_fields() > 0)
            for (std::size_t d = 0; d < 3; ++d) spin[i * simd::spin_fields + d] *= ratio;
        for (int dof = 0; dof < dofs(); ++dof) {
            double power = ratio;
            for (int k = 2; k < order; ++k) value(i, dof, k) *= power *= ratio;
        }
    }
}

void State::reorder(std::span<const std::uint32_t> order_of) {
    const auto move = [&](auto& column, std::size_t fields) {
        if (fields == 0) return;
        auto old = column;
        for (std::size_t n = 0; n < order_of.size(); ++n)
            std::copy_n(old.data() + order_of[n] * fields, fields, column.data() + n * fields);
    };
    for_columns(move);
    const Column<double> old = gear;
    for (std::size_t n = 0; n < order_of.size(); ++n)
        for (int dof = 0; dof < dofs(); ++dof)
            for (int k = 2; k < order; ++k) value(n, dof, k) = old[gear_index(order_of[n], dof, k)];
    resize(order_of.size());
    force.fill(0.0);
    park_padding();
}

void State::adopt() {
    const std::size_t n = size();
    bool whole = gear.size() == padded(n) * gear_fields();
    for_columns(
        [&](const auto& column, std::size_t fields) { whole = whole && column.size() == n * fields; });
    if (!whole) fail(Exit::io, "its columns have unequal length");
    resize(n);
    force.fill(0.0);
    park_padding();
}

} // namespace sandlane::md
