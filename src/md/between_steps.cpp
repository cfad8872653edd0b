// What happens between time steps: storage order, insertion, grains that leave, the way from the lattice to
// link cells, and the guard on overlaps.
#include "md/simulation.hpp"

#include "core/error.hpp"
#include "md/near_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace sandlane::md {

using scene::NeighbourMethod;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

} // namespace

// Storage order: strips of eight rows, column by column, so that neighbours lie close in memory.
void Simulation::sort_by_place() {
    sorted_ = true;
    constexpr std::int64_t strip = 8;
    const double edge = std::max(2 * needs_.radius_min, 1e-4 * norm(plan_.upper - plan_.lower));
    const auto columns = static_cast<std::int64_t>((plan_.upper.x - plan_.lower.x) / edge) + 2;
    const std::size_t n = state_.size();
    std::vector<std::int64_t> key(n);
    for (std::size_t i = 0; i < n; ++i) {
        const auto column = static_cast<std::int64_t>((state_.value(i, 0, 0) - plan_.lower.x) / edge);
        const auto row = static_cast<std::int64_t>((state_.value(i, 1, 0) - plan_.lower.y) / edge);
        key[i] = (row / strip * columns + column) * strip + row % strip;
    }
    std::vector<std::uint32_t> order(n);
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return key[a] < key[b]; });
    walls_.invalidate(state_);
    lists_.invalidate(state_);
    state_.reorder(order);
    if (is_lattice(plan_.neighbours)) lattice_.clear(state_);
    state_.refresh_records(plan_.dt);
}

// Puts every grain on the lattice at the positions of the records.
void Simulation::bin() {
    if (!is_lattice(plan_.neighbours)) return;
    lattice_.clear(state_);
    lattice_.leave(state_, kernels_->bin, 0, state_.size());
    lattice_.enter(state_, 0, state_.size());
}

bool Simulation::has_room(const scene::GrainState& grain) const {
    const Vec size = plan_.upper - plan_.lower;
    for (std::size_t i = 0; i < state_.size(); ++i) {
        double dx = state_.value(i, 0, 0) - grain.position.x, dy = state_.value(i, 1, 0) - grain.position.y;
        if (scene_.domain.periodic[0]) dx -= size.x * std::nearbyint(dx / size.x);
        if (scene_.domain.periodic[1]) dy -= size.y * std::nearbyint(dy / size.y);
        const double reach = state_.radius[i] + grain.radius;
        if (dx * dx + dy * dy < reach * reach) return false;
    }
    bool room = true;
    walls_.for_touching(grain.position, grain.radius, [&](std::size_t, const WallContact&) { room = false; });
    return room;
}

void Simulation::insert_due() {
    const std::int64_t retry = 100; // steps until a grain that found no room tries again
    bool inserted = false;
    while (next_waiting_ < waiting_.size() && insertion_step(waiting_[next_waiting_]) <= step_) {
        scene::GrainState grain = waiting_[next_waiting_];
        if (!has_room(grain)) {
            ++delayed_;
            waiting_[next_waiting_].insert_at = static_cast<double>(step_ + retry) * plan_.dt;
            const auto from = waiting_.begin() + static_cast<std::ptrdiff_t>(next_waiting_);
            std::stable_sort(from, waiting_.end(),
                             [](const auto& a, const auto& b) { return a.insert_at < b.insert_at; });
            continue;
        }
        state_.append(grain, plan_, plan_.dt);
        const std::size_t i = state_.size() - 1;
        state_.value(i, 0, 2) = 0.5 * plan_.dt * plan_.dt * scene_.domain.gravity.x;
        state_.value(i, 1, 2) = 0.5 * plan_.dt * plan_.dt * scene_.domain.gravity.y;
        added_energy_ += grain_energy(scene_, plan_, state_, i);
        ++next_waiting_;
        inserted = true;
    }
    if (inserted) sort_by_place();
}

// Grains whose predicted centre left an open side are removed and counted, or end the run.
void Simulation::handle_outside() {
    std::vector<std::uint32_t> kept;
    for (std::size_t i = 0; i < state_.size(); ++i) {
        const double* r = state_.record.data() + i * simd::record_fields;
        const bool inside =
            r[0] >= plan_.lower.x && r[0] < plan_.upper.x && r[1] >= plan_.lower.y && r[1] < plan_.upper.y;
        if (inside) {
            kept.push_back(static_cast<std::uint32_t>(i));
            continue;
        }
        if (!std::isfinite(r[0]) || !std::isfinite(r[1]) || !std::isfinite(r[2]) || !std::isfinite(r[3]))
            fail(Exit::unstable,
                 "step {}, t = {:.6g} s: grain {} has position ({}, {}): the run is unstable; lower md.dt",
                 step_, time(), state_.id[i], r[0], r[1]);
        if (scene_.domain.outside == scene::Outside::error)
            fail(Exit::unstable,
                 "step {}, t = {:.6g} s: grain {} left the domain at ({:.6g}, {:.6g}). Enlarge the domain, "
                 "add walls, or set "
                 "domain.outside = \"remove\".",
                 step_, time(), state_.id[i], r[0], r[1]);
        added_energy_ -= grain_energy(scene_, plan_, state_, i);
        ++removed_;
    }
    walls_.invalidate(state_);
    lists_.invalidate(state_);
    state_.reorder(kept);
    bin();
}

void Simulation::use_link_cells() {
    plan_.neighbours = NeighbourMethod::link_cells;
    prepare_method();
}

void Simulation::check_overlap(double overlap) const {
    if (overlap > needs_.radius_min) fail_overlap();
}

// Names the two grains that overlap most at the predicted positions.
void Simulation::fail_overlap() const {
    const auto centre = [&](std::size_t i) {
        const double* r = state_.record.data() + i * simd::record_fields;
        return Vec{r[0], r[1], 0};
    };
    double worst = -infinity, distance = 0;
    std::size_t first = 0, second = 0;
    for_near_pairs(scene_, state_, centre, [&](std::size_t i, std::size_t j, Vec d) {
        const double overlap = state_.radius[i] + state_.radius[j] - norm(d);
        if (overlap <= worst) return;
        worst = overlap;
        distance = norm(d);
        first = std::min(state_.id[i], state_.id[j]) == state_.id[i] ? i : j;
        second = first == i ? j : i;
    });
    fail(Exit::unstable,
         "step {}, t = {:.6g} s: grains {} and {} overlap by {:.4g} m, their centres are {:.4g} m apart "
         "(allowed: R_min = {:.4g} m). The material is too soft for this load, or the time step too large: "
         "raise its stiffness or lower md.dt.",
         step_, time(), state_.id[first], state_.id[second], worst, distance, needs_.radius_min);
}

} // namespace sandlane::md
