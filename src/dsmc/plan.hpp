// From a scene to a setup: what is chosen, and the text that says so.
#pragma once

#include "core/parallel.hpp"
#include "dsmc/setup.hpp"
#include "scene/scene.hpp"
#include "simd/tables.hpp"

#include <string>
#include <vector>

namespace sandlane::dsmc {

struct Plan {
    Setup setup;
    simd::Isa isa = simd::Isa::scalar;
    int threads = 1;
    std::int64_t steps = 0; // about so many where the time step adapts
    std::vector<std::string> chosen, skipped, warnings;
};

// Of [gas] and [[species]].
[[nodiscard]] std::size_t all_particles(const scene::Scene& scene);

// Throws Error(invalid_input) for what the method cannot do.
[[nodiscard]] Plan make_plan(const scene::Scene& scene, simd::Isa isa, const ThreadChoice& threads);
[[nodiscard]] double memory_bytes(const scene::Scene& scene, const Plan& plan);
[[nodiscard]] std::string describe(const scene::Scene& scene, const Plan& plan);

} // namespace sandlane::dsmc
