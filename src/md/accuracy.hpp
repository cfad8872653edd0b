// Integrator and time step from the error that a scene allows a collision (docs/accuracy.md, "An error asked
// for").
#pragma once

#include "md/plan.hpp"

#include <string>
#include <vector>

namespace sandlane::md {

// One way of integrating, and what it needs for the error asked for.
struct Candidate {
    scene::Integrator integrator = scene::Integrator::automatic;
    scene::ContactOnset onset = scene::ContactOnset::step;
    double dt = 0;                     // s; 0: none meets it, or it would cost more than another one
    double error = 0;                  // of a collision at dt, the largest over all kinds of contacts
    double cost = 0;                   // ns for a particle to live through the shortest contact
    double step_cost = 0, longest = 0; // ns per particle-step; the longest step that is allowed, s
};

struct AccuracyChoice {
    Candidate best;
    std::vector<Candidate> all;       // in the order of search
    double contact_time = 0;          // s, the shortest
    std::vector<std::string> reasons; // lines of the plan
};

// For md.accuracy > 0. Collisions of every pair of materials, of the lightest and the heaviest grains with
// each other and with a wall, at md.max_speed and a tenth of it. A function of scene and grains alone. Throws
// Error(invalid_input) where there are no contacts, or no step is short enough.
[[nodiscard]] AccuracyChoice choose_by_accuracy(const scene::Scene& scene, const Needs& needs);

// The scene with the integrator and the time step that it runs with.
[[nodiscard]] scene::Scene with_choice(const scene::Scene& scene, const AccuracyChoice& choice);

// Error of a collision of the scene at a step of this length and a little less: whole numbers of steps per
// contact, where errors of begin and end cancel, do not count. It stops early where `enough` is exceeded.
[[nodiscard]] double scene_error(const scene::Scene& scene, const Needs& needs, scene::Integrator integrator,
                                 scene::ContactOnset onset, double dt, double enough);
// "velocity-verlet, resolved"
[[nodiscard]] std::string name_of(const Candidate& candidate);
} // namespace sandlane::md
