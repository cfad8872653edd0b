// What happens between time steps: storage order, the way from the lattice to link cells, and the guard on
// overlaps.
#include "md/simulation.hpp"

#include "core/error.hpp"
#include "md/near_pairs.hpp"
#include "scene/cell_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace sandlane::md {

using scene::NeighbourMethod;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

} // namespace

// Storage order: in the plane strips of eight rows, column by column; in space pencils of eight by eight
// cells, layer by layer. Neighbours lie close in memory, and a tile of consecutive grains is about as wide as
// it is long.
void Simulation::sort_by_place() {
    sorted_ = true;
    constexpr std::int64_t strip = 8;
    const Vec size = plan_.upper - plan_.lower;
    const double edge = std::max(2 * needs_.radius_min, 1e-4 * norm(size));
    const auto cells = [&](double length) { return static_cast<std::int64_t>(length / edge) + 2; };
    const std::int64_t columns = cells(size.x), row_strips = cells(size.y) / strip + 1;
    const std::size_t n = state_.size();
    std::vector<std::int64_t> key(n);
    for (std::size_t i = 0; i < n; ++i) {
        const Vec p = state_.position(i) - plan_.lower;
        const auto column = static_cast<std::int64_t>(p.x / edge),
                   row = static_cast<std::int64_t>(p.y / edge);
        const auto layer = plan_.dimension == 3 ? static_cast<std::int64_t>(p.z / edge) : 0;
        key[i] =
            plan_.dimension == 2
                ? (row / strip * columns + column) * strip + row % strip
                : (((layer / strip * row_strips + row / strip) * columns + column) * strip + layer % strip) *
                          strip +
                      row % strip;
    }
    std::vector<std::uint32_t> order(n);
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return key[a] < key[b]; });
    walls_.invalidate(state_);
    lists_.invalidate(state_);
    state_.reorder(order);
    if (is_lattice(plan_.neighbours)) lattice_.clear(state_);
}

// Puts every grain on the lattice at the positions of the records.
void Simulation::bin() {
    if (!is_lattice(plan_.neighbours)) return;
    lattice_.clear(state_);
    lattice_.leave(state_, kernels_->plane.bin, 0, state_.size());
    lattice_.enter(state_, 0, state_.size());
}

void Simulation::use_link_cells() {
    plan_.neighbours = NeighbourMethod::link_cells;
    prepare_method();
}

void Simulation::check_overlap(double overlap) {
    if (overlap > needs_.radius_min) fail_overlap();
    if (overlap > balance_.examined) see_overlap(overlap);
}

Simulation::Touching Simulation::deepest_pair(bool relative) const {
    const auto centre = [&](std::size_t i) { return state_.position(i); };
    double worst = -infinity;
    Touching pair{0, 0, 0, 0};
    for_near_pairs(box(force_time()), state_, centre, [&](std::size_t i, std::size_t j, Vec d) {
        const double overlap = state_.radius(i) + state_.radius(j) - norm(d);
        const double measure = relative ? overlap / std::min(state_.radius(i), state_.radius(j)) : overlap;
        if (measure <= worst) return;
        worst = measure;
        const std::size_t first = std::min(state_.id[i], state_.id[j]) == state_.id[i] ? i : j;
        pair = {first, first == i ? j : i, overlap, norm(d)};
    });
    return pair;
}

// Names the two grains that overlap most at the predicted positions.
void Simulation::fail_overlap() const {
    const Touching worst = deepest_pair(false);
    fail(Exit::unstable,
         "step {}, t = {:.6g} s: grains {} and {} overlap by {:.4g} m, their centres are {:.4g} m apart "
         "(allowed: R_min = {:.4g} m). The material is too soft for this load, or the time step too large: "
         "raise its stiffness or lower md.dt.",
         step_, time(), state_.id[worst.first], state_.id[worst.second], worst.overlap, worst.distance,
         needs_.radius_min);
}

} // namespace sandlane::md
