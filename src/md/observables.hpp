// What a run measures of its state: energies, momentum, contacts, overlap, pressure. Reads a state, changes
// nothing; scalar, with the same formula text as the kernels.
#pragma once

#include "md/plan.hpp"
#include "md/state.hpp"
#include "md/walls.hpp"
#include "scene/scene.hpp"

#include <cstdint>
#include <vector>

namespace sandlane::md {

struct Observables {
    double kinetic = 0, rotational = 0, elastic = 0, potential = 0; // J
    double momentum_x = 0, momentum_y = 0;                          // kg m/s
    double largest_overlap = 0;                                     // of the smaller radius
    double largest_speed = 0;                                       // m/s
    std::int64_t contacts = 0, wall_contacts = 0, grains = 0;
    std::vector<double> pressure; // per storage index: trace of the contact stress over two (8.1)
};

// What contacts remember of each other, of laws that do.
struct ContactMemories {
    const ContactMemory &pairs, &walls;
};

[[nodiscard]] Observables observe(const scene::Scene& scene, const Plan& plan, const State& state,
                                  const Walls& walls, const std::vector<double>& coefficients,
                                  const ContactMemories& memories);

} // namespace sandlane::md
