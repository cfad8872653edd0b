// What others see of a simulation: observables, forces, snapshots, contacts, the hash of its state.
#include "md/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace sandlane::md {

using scene::NeighbourMethod;

Observables Simulation::observe() const {
    Walls now = walls_;
    now.move_to(time());
    const ContactMemory pairs = lists_.memory(state_), walls = walls_.memory(state_);
    return md::observe(scene_, plan_, state_, now, coefficients_, {pairs, walls});
}

std::vector<double> Simulation::forces(simd::Isa isa, NeighbourMethod method) const {
    Simulation other(*this);
    other.plan_.isa = isa;
    other.plan_.neighbours = method;
    other.kernels_ = &simd::md_kernels(isa);
    other.prepare_method();
    other.lists_.adopt(lists_.memory(state_));
    other.walls_.adopt(walls_.memory(state_));
    other.state_.resize_records();
    other.state_.refresh_records(plan_.dt);
    other.bin();
    other.force_step_ = step_;
    other.compute_forces();
    return {other.state_.force.begin(),
            other.state_.force.begin() + static_cast<std::ptrdiff_t>(state_.size()) * simd::force_fields};
}

namespace {

std::vector<std::size_t> by_id(const State& state) {
    std::vector<std::size_t> order(state.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return state.id[a] < state.id[b]; });
    return order;
}

// The tangential force stays: both forces and the tangent change sign.
void swap_partners(analysis::Contact& c) {
    std::swap(c.i, c.j);
    c.normal = -1.0 * c.normal;
    c.force = -1.0 * c.force;
}

double into(double x, double lower, double period) {
    return period > 0 ? x - period * std::floor((x - lower) / period) : x;
}

} // namespace

analysis::Snapshot Simulation::snapshot() const {
    analysis::Snapshot s;
    s.step = step_;
    s.time = time();
    s.lower = plan_.lower;
    s.upper = plan_.upper;
    s.periodic_x = scene_.domain.periodic[0];
    s.periodic_y = scene_.domain.periodic[1];
    const Observables now = observe();
    const Vec size = s.upper - s.lower;
    const double rate = 1 / plan_.dt;
    for (const std::size_t i : by_id(state_)) {
        s.id.push_back(state_.id[i]);
        s.x.push_back(into(state_.value(i, 0, 0), s.lower.x, s.periodic_x ? size.x : 0));
        s.y.push_back(into(state_.value(i, 1, 0), s.lower.y, s.periodic_y ? size.y : 0));
        s.angle.push_back(plan_.spin ? state_.value(i, 2, 0) : 0.0);
        s.vx.push_back(state_.value(i, 0, 1) * rate);
        s.vy.push_back(state_.value(i, 1, 1) * rate);
        s.omega.push_back(plan_.spin ? state_.value(i, 2, 1) * rate : 0.0);
        s.radius.push_back(state_.radius[i]);
        s.mass.push_back(state_.mass[i]);
        s.pressure.push_back(now.pressure[i]);
        s.material.push_back(state_.material[i]);
        s.image_x.push_back(state_.image_x[i]);
        s.image_y.push_back(state_.image_y[i]);
    }
    s.walls = walls_.shapes(time());
    return s;
}

analysis::Contacts Simulation::contacts() const {
    Walls now = walls_;
    now.move_to(time());
    const ContactMemory pairs = lists_.memory(state_), walls = walls_.memory(state_);
    analysis::Contacts all = md::contacts(scene_, plan_, state_, now, coefficients_, {pairs, walls});
    std::vector<std::int32_t> place(state_.size()); // storage index -> index in the snapshot
    std::int32_t next = 0;
    for (const std::size_t i : by_id(state_)) place[i] = next++;
    for (analysis::Contact& c : all) {
        c.i = place[static_cast<std::size_t>(c.i)];
        if (c.with_wall()) continue;
        c.j = place[static_cast<std::size_t>(c.j)];
        if (c.i > c.j) swap_partners(c);
    }
    std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) {
        return std::tie(a.i, a.j, a.wall) < std::tie(b.i, b.j, b.wall);
    });
    return all;
}

Hash128 Simulation::state_hash() const {
    std::vector<double> values;
    for (const std::size_t i : by_id(state_)) {
        values.push_back(static_cast<double>(state_.id[i]));
        for (int dof = 0; dof < state_.dofs; ++dof)
            for (int k = 0; k < state_.order; ++k) values.push_back(state_.value(i, dof, k));
        values.push_back(state_.radius[i]);
        values.push_back(state_.mass[i]);
        values.push_back(state_.image_x[i]);
        values.push_back(state_.image_y[i]);
    }
    values.push_back(static_cast<double>(step_));
    return hash_bytes(values.data(), values.size() * sizeof(double));
}

} // namespace sandlane::md
