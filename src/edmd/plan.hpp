// From a scene to a setup: what is chosen, and the text that says so.
#pragma once

#include "analysis/gas_samples.hpp"
#include "analysis/gas_theory.hpp"
#include "core/parallel.hpp"
#include "edmd/algorithm.hpp"
#include "edmd/ensemble.hpp"
#include "edmd/start.hpp"
#include "scene/scene.hpp"
#include "simd/tables.hpp"

#include <memory>
#include <string>
#include <vector>

namespace sandlane::edmd {

struct Plan {
    Setup setup;
    Amounts amounts; // of each class
    simd::Isa isa = simd::Isa::scalar;
    int threads = 1;
    bool simple = false;      // the simple algorithm
    int replicas = 1;         // independent runs of other seeds
    double events = 0;        // about so many
    double duration = 0;      // about so long, s
    double first_output = 0;  // the mean time between two collisions of a particle at the start, s
    bool homogeneous = false; // nothing acts but collisions of equal smooth particles: theory has a curve
    std::vector<std::string> chosen, skipped, warnings;

    [[nodiscard]] std::size_t particles() const;
};

// Throws Error(invalid_input) for what the method cannot do.
[[nodiscard]] Plan make_plan(const scene::Scene& scene, simd::Isa isa, const ThreadChoice& threads);
[[nodiscard]] double memory_bytes(const Plan& plan);
[[nodiscard]] std::string describe(const scene::Scene& scene, const Plan& plan);
// One replica: the run of the scene with a seed so much larger.
[[nodiscard]] std::unique_ptr<Algorithm> start(const scene::Scene& scene, const Plan& plan, simd::Isa isa,
                                               int replica = 0);
[[nodiscard]] Ensemble start_all(const scene::Scene& scene, const Plan& plan, simd::Isa isa);

// The gas as theory sees it: the particles of the first class, at the density of all.
[[nodiscard]] analysis::HardGas gas_of(const Plan& plan);
// What frames of it are taken of; masses in units of that of the first class.
[[nodiscard]] analysis::GasFrame frame_of(const Plan& plan);
// Where the particles are at a time of the clock.
[[nodiscard]] analysis::GasVessel vessel_of(const Setup& setup, double time);

} // namespace sandlane::edmd
