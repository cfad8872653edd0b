// What a run measures of its state: energies, momentum, contacts, overlap, pressure, loads on walls. Reads a
// state, changes nothing; scalar, with the same formula text as the kernels.
#pragma once

#include "analysis/contacts.hpp"
#include "md/plan.hpp"
#include "md/state.hpp"
#include "md/walls.hpp"
#include "scene/cell_grid.hpp"
#include "scene/scene.hpp"

#include <cstdint>
#include <vector>

namespace sandlane::md {

// What the grains do to one wall of the scene.
struct WallLoad {
    Vec force;        // N
    Vec torque;       // N m, about Walls::pivot; along z in 2D
    double power = 0; // W, given by the wall to the grains
};

struct Observables {
    double kinetic = 0, rotational = 0, elastic = 0; // J
    double potential = 0;                            // J, of unwrapped positions: no jump at a periodic side
    Vec momentum;                                    // kg m/s
    double largest_overlap = 0;                      // of the smaller radius
    double largest_speed = 0;                        // m/s
    std::int64_t contacts = 0, wall_contacts = 0, grains = 0;
    // Per storage index: trace of the contact stress over the dimension (docs/physics.md 11), N/m or Pa.
    std::vector<double> pressure;
    std::vector<WallLoad> walls; // per wall of the scene

    [[nodiscard]] double energy() const { return kinetic + rotational + elastic + potential; } // J
};

// What contacts remember of each other, of laws that do.
struct ContactMemories {
    const ContactMemory &pairs, &walls;
};

[[nodiscard]] Observables observe(const scene::Scene& scene, const Plan& plan, const State& state,
                                  const Walls& walls, const std::vector<double>& coefficients,
                                  const ContactMemories& memories, const scene::Box& box);

// All contacts, with storage indices in place of those of a snapshot and in no particular order.
[[nodiscard]] analysis::Contacts contacts(const scene::Scene& scene, const Plan& plan, const State& state,
                                          const Walls& walls, const std::vector<double>& coefficients,
                                          const ContactMemories& memories, const scene::Box& box);

// Kinetic, rotational and potential energy of one grain, J.
[[nodiscard]] double grain_energy(const scene::Scene& scene, const Plan& plan, const State& state,
                                  std::size_t i);

} // namespace sandlane::md
