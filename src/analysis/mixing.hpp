// How well two populations are mixed: Lacey's index (P. M. C. Lacey, J. Appl. Chem. 4, 257 (1954)) over
// cells,
//
//     M = (S_0^2 - S^2)/(S_0^2 - S_R^2),    S^2 = (1/N) sum over cells of n (c - p)^2,
//
// with n grains in a cell, a share c of them of the first population, and p the share among all N. Apart, the
// populations have S_0^2 = p (1 - p), and M = 0. Placed at random they have in the mean
// S_R^2 = p (1 - p) (K - 1)/(N - 1) with K occupied cells, and M = 1. The weights n make both exact for cells
// that hold different numbers of grains.
#pragma once

#include <cstdint>
#include <vector>

namespace sandlane::analysis {

struct MixingCell {
    std::int64_t grains = 0, first = 0; // all, and those of the first population
};

struct Mixing {
    double index = 0;    // M; not a number where one population is missing or no cell holds two grains
    double share = 0;    // p
    double variance = 0; // S^2
    std::int64_t grains = 0, cells = 0; // N, K
};

[[nodiscard]] Mixing lacey_mixing(const std::vector<MixingCell>& cells);

} // namespace sandlane::analysis
