// Serial pair search for what happens between steps: observables and error messages.
#pragma once

#include "md/state.hpp"
#include "scene/cell_grid.hpp"

namespace sandlane::md {

// Calls body(i, j, d) once for every pair of grains that may touch, j stored before i, d = r_j - r_i (minimum
// image). position(i): the centre of grain i.
template <class Position, class Body>
void for_near_pairs(const scene::Box& box, const State& state, const Position& position, const Body& body) {
    if (state.size() < 2) return;
    const double largest = state.largest_radius();
    scene::CellGrid grid(box, 2 * largest, state.size());
    for (std::size_t i = 0; i < state.size(); ++i) {
        const Vec p = position(i);
        grid.for_near(p, [&](std::size_t j) { body(i, j, box.separation(p, position(j))); });
        grid.insert(p);
    }
}

} // namespace sandlane::md
