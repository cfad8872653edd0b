// What others see of a simulation: observables, forces, snapshots, contacts, the hash of its state.
#include "md/simulation.hpp"
#include "scene/cell_grid.hpp"

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
    return md::observe(scene_, plan_, state_, now, coefficients_, {pairs, walls}, box(time()));
}

std::vector<double> Simulation::forces(simd::Isa isa, NeighbourMethod method) const {
    Simulation other(*this);
    other.plan_.isa = isa;
    other.plan_.neighbours = method;
    other.kernels_ = &simd::md_kernels(isa);
    other.prepare_method();
    other.lists_.adopt(lists_.memory(state_));
    other.walls_.adopt(walls_.memory(state_));
    other.bin();
    other.force_step_ = step_;
    return other.take_forces();
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

} // namespace

analysis::Snapshot Simulation::snapshot() const {
    analysis::Snapshot s;
    s.step = step_;
    s.time = time();
    s.lower = plan_.lower;
    s.upper = plan_.upper;
    s.dimension = plan_.dimension;
    s.periodic_x = scene_.domain.periodic[0];
    s.periodic_y = scene_.domain.periodic[1];
    s.periodic_z = scene_.domain.periodic[2];
    const Observables now = observe();
    const scene::Box box = this->box(time());
    const double rate = 1 / plan_.dt;
    for (const std::size_t i : by_id(state_)) {
        const Vec p = box.wrapped(state_.position(i)), v = rate * state_.shift(i), w = rate * state_.turn(i);
        s.id.push_back(state_.id[i]);
        s.x.push_back(p.x);
        s.y.push_back(p.y);
        s.angle.push_back(state_.angle(i));
        s.vx.push_back(v.x);
        s.vy.push_back(v.y);
        s.omega.push_back(w.z);
        s.radius.push_back(state_.radius(i));
        s.mass.push_back(state_.mass[i]);
        s.pressure.push_back(now.pressure[i]);
        s.material.push_back(state_.material[i]);
        s.image_x.push_back(state_.images(i, 0));
        s.image_y.push_back(state_.images(i, 1));
        if (plan_.dimension == 2) continue;
        s.z.push_back(p.z);
        s.vz.push_back(v.z);
        s.omega_x.push_back(w.x);
        s.omega_y.push_back(w.y);
        s.image_z.push_back(state_.images(i, 2));
        if (plan_.orientation) s.orientation.push_back(state_.orientation_of(i));
    }
    s.walls = walls_.shapes(time());
    return s;
}

analysis::Contacts Simulation::contacts() const {
    Walls now = walls_;
    now.move_to(time());
    const ContactMemory pairs = lists_.memory(state_), walls = walls_.memory(state_);
    analysis::Contacts all =
        md::contacts(scene_, plan_, state_, now, coefficients_, {pairs, walls}, box(time()));
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
    Hasher hasher;
    std::vector<double> values;
    const auto add = [&] {
        hasher.add({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double)});
        values.clear();
    };
    for (const std::size_t i : by_id(state_)) {
        values.push_back(static_cast<double>(state_.id[i]));
        const double* record = state_.record_of(i);
        values.insert(values.end(), record, record + simd::record_fields);
        for (const double turn : {state_.turn(i).x, state_.turn(i).y, state_.turn(i).z})
            values.push_back(turn);
        for (int dof = 0; dof < state_.dofs(); ++dof)
            for (int k = 2; k < state_.order; ++k) values.push_back(state_.value(i, dof, k));
        values.push_back(state_.mass[i]);
        if (plan_.orientation) {
            const Quaternion q = state_.orientation_of(i);
            values.insert(values.end(), {q.w, q.x, q.y, q.z});
        }
        for (std::size_t d = 0; d < 3; ++d) values.push_back(state_.images(i, d));
        add();
    }
    values.push_back(static_cast<double>(step_));
    add();
    return hasher.result();
}

} // namespace sandlane::md
