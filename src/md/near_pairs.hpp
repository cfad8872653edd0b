// Serial pair search for what happens between steps: observables and error messages.
#pragma once

#include "md/size_classes.hpp"
#include "md/state.hpp"
#include "scene/cell_grid.hpp"

#include <utility>
#include <vector>

namespace sandlane::md {

// Calls body(i, j, d) once for every pair of grains that may touch, j stored before i, d = r_j - r_i (minimum
// image). position(i): the centre of grain i.
template <class Position, class Body>
void for_near_pairs(const scene::Box& box, const State& state, const Position& position, const Body& body) {
    if (state.size() < 2) return;
    const auto classes = size_classes(state.size(), [&](std::size_t i) { return state.radius(i); });
    // Every grain looks for those of its class before it, and for all of the classes of larger grains.
    struct Level {
        scene::CellGrid grid;
        std::vector<std::size_t> grains;
    };
    std::vector<Level> levels;
    levels.reserve(classes.size());
    for (const SizeClass& c : classes) levels.push_back({scene::CellGrid(box, 2 * c.largest, c.grains), {}});
    for (std::size_t own = classes.size(); own-- > 0;)
        for (std::size_t i = 0; i < state.size(); ++i) {
            if (class_of(classes, state.radius(i)) != own) continue;
            const Vec p = position(i);
            for (std::size_t c = own; c < classes.size(); ++c)
                levels[c].grid.for_near(p, [&](std::size_t n) {
                    const std::size_t first = std::max(i, levels[c].grains[n]),
                                      second = std::min(i, levels[c].grains[n]);
                    body(first, second, box.separation(position(first), position(second)));
                });
            levels[own].grid.insert(p);
            levels[own].grains.push_back(i);
        }
}

} // namespace sandlane::md
