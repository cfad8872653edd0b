// Force chains by the three conditions of chapter 1 (md-spheres 8.2): grains i, j, k belong to a chain if i-j
// and j-k touch, the pressure of each exceeds a threshold, and the lines j-i and j-k make more than 150
// degrees. Chains are the components that the bonds of such triples connect.
#pragma once

#include "analysis/analysis.hpp"

namespace sandlane::analysis {

struct ForceChains {
    std::int64_t triples = 0;
    std::vector<std::int32_t> chain;  // per grain: number of its chain, from 0; -1: in none
    std::vector<std::int64_t> length; // per chain: number of its grains

    [[nodiscard]] std::int64_t members() const;
};

// threshold: pressure that each of the three must exceed, N/m or Pa.
[[nodiscard]] ForceChains find_force_chains(const Frame& frame, double threshold);

// Mean of the pressure over all free grains, N/m or Pa; 0 without grains.
[[nodiscard]] double mean_pressure(const Snapshot& snapshot);

} // namespace sandlane::analysis
