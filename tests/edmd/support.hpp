// Gases of hard particles for the tests of event-driven dynamics.
#pragma once

#include "edmd/reference/simple.hpp"
#include "edmd/simulation.hpp"
#include "edmd/start.hpp"

#include <cmath>
#include <numbers>
#include <vector>

namespace sandlane::test {

// n particles of diameter 1 and mass 1 at packing fraction phi in a periodic box.
inline edmd::Setup hard_gas(int dimension, double phi, double eps, std::uint32_t n) {
    edmd::Setup s;
    s.dimension = dimension;
    s.restitution.eps = eps;
    const double content = dimension == 3 ? std::numbers::pi / 6 : std::numbers::pi / 4;
    const double length = std::pow(n * content / phi, 1.0 / dimension);
    for (int d = 0; d < dimension; ++d) s.lower[d] = 0, s.upper[d] = length;
    return s;
}

// The events of both algorithms until the n-th.
template <class Algorithm> std::vector<edmd::Event> events_of(Algorithm& algorithm, std::int64_t n) {
    std::vector<edmd::Event> events;
    algorithm.log().record(&events);
    algorithm.run(n);
    algorithm.log().record(nullptr);
    return events;
}

} // namespace sandlane::test
