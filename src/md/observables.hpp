// What a run measures of its state: energies, momentum, contacts, overlap, pressure, loads on walls. Reads a
// state, changes nothing; scalar, with the same formula text as the kernels.
#pragma once

#include "analysis/contacts.hpp"
#include "md/collision_error.hpp"
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

// A contact by the ids of its grains, the smaller one first; second < 0: wall -1 - second of the scene.
struct Place {
    std::int64_t first = -1, second = -1;
    Vec position; // of the first grain, m
};

struct Observables {
    double kinetic = 0, rotational = 0, elastic = 0; // J
    double potential = 0;                            // J, of unwrapped positions: no jump at a periodic side
    Vec momentum;                                    // kg m/s
    double largest_overlap = 0;                      // of the smaller radius
    Place deepest;                                   // where it is
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

// A contact as the binary collision that has the energy which it holds now.
struct SampledContact {
    Impact impact;
    Place place;
    double phase = 0;      // random: within a step, when it begins
    std::uint64_t key = 0; // random
};
// A random sample of watch.sample contacts, or all if there are fewer: a function of seed, step and ids.
[[nodiscard]] std::vector<SampledContact> sample_contacts(const scene::Scene& scene, const Plan& plan,
                                                          const State& state, const Walls& walls,
                                                          const std::vector<double>& coefficients,
                                                          const ContactMemories& memories,
                                                          const scene::Box& box, std::int64_t step);

// Without the angular acceleration of a plane, m/s^2.
[[nodiscard]] inline Vec linear_gravity(const scene::Scene& scene) {
    const Vec g = scene.domain.gravity;
    return {g.x, g.y, scene.domain.dimension == 3 ? g.z : 0.0};
}

// Kinetic, rotational and potential energy of one grain, J.
[[nodiscard]] double grain_energy(const scene::Scene& scene, const Plan& plan, const State& state,
                                  std::size_t i);

} // namespace sandlane::md
