// Comparison of two simulations of grains.
#pragma once

#include "app/difference.hpp"
#include "md/simulation.hpp"

#include <vector>

namespace sandlane::app {

[[nodiscard]] std::vector<Difference> compare_snapshots(const analysis::Snapshot& a,
                                                        const analysis::Snapshot& b);

// Forces and torques of the present state by the plan's kernels against the scalar reference of the same
// method.
[[nodiscard]] std::vector<Difference> compare_forces(const md::Simulation& simulation, simd::Isa first,
                                                     simd::Isa second);

} // namespace sandlane::app
