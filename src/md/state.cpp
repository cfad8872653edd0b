#include "md/state.hpp"

#include "core/error.hpp"

namespace sandlane::md {

std::size_t State::bytes() const {
    return gear.bytes() + record.bytes() + next_record.bytes() + force.bytes() + radius.bytes() +
           inverse_radius.bytes() + mass.bytes() + inverse_mass.bytes() + spin_factor.bytes() +
           material.bytes() + image_x.bytes() + image_y.bytes() + id.bytes();
}

void State::resize(std::size_t n) {
    const std::size_t whole = padded(n);
    const auto fields = static_cast<std::size_t>(dofs * order);
    gear.resize(whole * fields, 0.0);
    force.resize((whole + block_width) * simd::force_fields, 0.0);
    radius.resize(n, 0.0);
    resize_records();
    inverse_radius.resize(n, 0.0);
    mass.resize(n, 0.0);
    inverse_mass.resize(n, 0.0);
    if (spin()) spin_factor.resize(n, 0.0);
    material.resize(n, 0);
    image_x.resize(n, 0);
    image_y.resize(n, 0);
    id.resize(n, -1);
}

void State::resize_records() {
    const std::size_t values = (padded(size()) + block_width) * simd::record_fields;
    record.resize(values, 0.0);
    next_record.resize(double_records ? values : 0, 0.0);
}

// Padding lanes go through the integrator like particles; gravity must not carry them to infinity for ever.
void State::park_padding() {
    for (std::size_t i = size(); i < padded(size()); ++i) {
        for (int dof = 0; dof < dofs; ++dof)
            for (int k = 0; k < order; ++k) value(i, dof, k) = 0.0;
        value(i, 0, 0) = parking_.x;
        value(i, 1, 0) = parking_.y;
        inverse_mass.data()[i] = 0.0;
        radius.data()[i] = inverse_radius.data()[i] = 0.0;
        material.data()[i] = 0;
        if (spin()) spin_factor.data()[i] = 0.0;
    }
}

void State::append(const scene::GrainState& grain, const Plan& plan, double dt) {
    const std::size_t i = size();
    order = plan.order;
    dofs = plan.spin ? 3 : 2;
    parking_ = plan.lower;
    resize(i + 1);
    radius[i] = grain.radius;
    inverse_radius[i] = 1.0 / grain.radius;
    mass[i] = grain.mass;
    inverse_mass[i] = 1.0 / grain.mass;
    material[i] = grain.material;
    id[i] = grain.id;
    image_x[i] = image_y[i] = 0;
    // The lane may have been padding, which the integrator moves along.
    for (int dof = 0; dof < dofs; ++dof)
        for (int k = 0; k < order; ++k) value(i, dof, k) = 0.0;
    value(i, 0, 0) = grain.position.x;
    value(i, 1, 0) = grain.position.y;
    value(i, 0, 1) = grain.velocity.x * dt;
    value(i, 1, 1) = grain.velocity.y * dt;
    if (spin()) {
        spin_factor[i] = 1.0 / (plan.inertia_factor * grain.mass * grain.radius); // R/J, J = c m R^2
        value(i, 2, 0) = grain.angle;
        value(i, 2, 1) = grain.omega * dt;
    }
    park_padding();
}

void State::reorder(std::span<const std::uint32_t> order_of) {
    const State old = *this;
    resize(order_of.size());
    for (std::size_t n = 0; n < order_of.size(); ++n) {
        const std::size_t from = order_of[n];
        for (int dof = 0; dof < dofs; ++dof)
            for (int k = 0; k < order; ++k) value(n, dof, k) = old.value(from, dof, k);
        for (std::size_t f = 0; f < simd::record_fields; ++f)
            record[n * simd::record_fields + f] = old.record[from * simd::record_fields + f];
        radius[n] = old.radius[from];
        inverse_radius[n] = old.inverse_radius[from];
        mass[n] = old.mass[from];
        inverse_mass[n] = old.inverse_mass[from];
        if (spin()) spin_factor[n] = old.spin_factor[from];
        material[n] = old.material[from];
        image_x[n] = old.image_x[from];
        image_y[n] = old.image_y[from];
        id[n] = old.id[from];
    }
    force.fill(0.0);
    park_padding();
}

void State::adopt(const Plan& plan) {
    const std::size_t n = size(), fields = static_cast<std::size_t>(dofs * order);
    const bool whole = gear.size() == padded(n) * fields && inverse_radius.size() == n && mass.size() == n &&
                       inverse_mass.size() == n && material.size() == n && image_x.size() == n &&
                       image_y.size() == n && id.size() == n && spin_factor.size() == (spin() ? n : 0);
    if (!whole) fail(Exit::io, "its columns have unequal length");
    parking_ = plan.lower;
    resize(n);
    force.fill(0.0);
    park_padding();
}

void State::refresh_records(double dt) {
    for (std::size_t i = 0; i < size(); ++i) {
        double* r = record.data() + i * simd::record_fields;
        r[0] = value(i, 0, 0);
        r[1] = value(i, 1, 0);
        r[2] = value(i, 0, 1) * (1.0 / dt);
        r[3] = value(i, 1, 1) * (1.0 / dt);
        r[4] = spin() ? radius[i] * (value(i, 2, 1) * (1.0 / dt)) : 0.0;
        r[5] = radius[i];
        r[6] = inverse_radius[i];
        r[7] = 0.0;
    }
    if (!double_records) return;
    // A prediction writes positions and velocities, and radii only beside a spin.
    for (std::size_t n = 0; n < size() * simd::record_fields; ++n) next_record[n] = record[n];
}

} // namespace sandlane::md
