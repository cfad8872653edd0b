// Serial pair search for what happens between steps: observables and error messages.
#pragma once

#include "md/state.hpp"
#include "scene/sized_grids.hpp"

#include <utility>
#include <vector>

namespace sandlane::md {

// Calls body(i, j, d) once for every pair of grains that may touch, j stored before i, d = r_j - r_i (minimum
// image). position(i): the centre of grain i.
template <class Position, class Body>
void for_near_pairs(const scene::Box& box, const State& state, const Position& position, const Body& body) {
    if (state.size() < 2) return;
    scene::SizedGrids grids(box, state.size(), [&](std::size_t i) { return state.radius(i); });
    std::vector<std::size_t> there; // in the order of insertion: the classes of larger grains first
    there.reserve(state.size());
    for (std::size_t own = grids.classes().size(); own-- > 0;)
        for (std::size_t i = 0; i < state.size(); ++i) {
            if (scene::class_of(grids.classes(), state.radius(i)) != own) continue;
            const Vec p = position(i);
            grids.for_near(p, state.radius(i), [&](std::size_t n) {
                const std::size_t first = std::max(i, there[n]), second = std::min(i, there[n]);
                body(first, second, box.separation(position(first), position(second)));
            });
            grids.insert(p, state.radius(i));
            there.push_back(i);
        }
}

} // namespace sandlane::md
