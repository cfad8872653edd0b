// Small gases for tests.
#pragma once

#include "dsmc/simulation.hpp"

namespace sandlane::test {

// A homogeneous gas in a periodic box: n s^{d-1} = 0.1, m = T = s = 1, one cell in each direction unless
// told.
inline dsmc::Setup gas(int dimension, double eps, std::size_t particles, std::int32_t cells = 1) {
    dsmc::Setup s;
    s.dimension = dimension;
    const double per_cell =
        static_cast<double>(particles) / (dimension == 3 ? cells * cells * cells : cells * cells);
    const double edge = dimension == 3 ? std::cbrt(per_cell) : std::sqrt(per_cell);
    for (int d = 0; d < dimension; ++d) {
        s.upper[d] = edge * cells;
        s.cells[d] = cells;
    }
    s.weight = 0.1; // n F = 0.1
    s.restitution.eps = eps;
    s.dt = 0.1;
    return s;
}

} // namespace sandlane::test
