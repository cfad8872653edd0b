// Gases of hard particles for the tests of event-driven dynamics.
#pragma once

#include "edmd/reference/simple.hpp"
#include "edmd/simulation.hpp"
#include "edmd/start.hpp"

#include <gtest/gtest.h>

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

inline simd::Isa widest() {
    return simd::available_isas().back();
}

// The same events by both algorithms and all instruction sets, also in pieces and from a checkpoint.
inline void expect_same_events(const edmd::Setup& s, const std::vector<edmd::Particle>& particles,
                               std::int64_t events) {
    edmd::SimpleAlgorithm simple(s, particles);
    const auto expected = events_of(simple, events);
    ASSERT_EQ(static_cast<std::int64_t>(expected.size()), events);
    for (const simd::Isa isa : simd::available_isas()) {
        SCOPED_TRACE(std::string(simd::isa_name(isa)));
        edmd::Simulation improved(s, particles, isa, 1);
        const auto found = events_of(improved, events);
        ASSERT_EQ(found.size(), expected.size());
        for (std::size_t n = 0; n < found.size(); ++n) ASSERT_EQ(found[n], expected[n]) << n;
        EXPECT_EQ(simple.state_hash(), improved.state_hash());
        EXPECT_EQ(simple.tally().wall_energy, improved.tally().wall_energy);
    }
    edmd::Simulation parts(s, particles, widest(), 2), resumed(s, particles, widest(), 3);
    parts.run(events / 3);
    resumed.restore(parts.serialise());
    resumed.run(events - events / 3);
    EXPECT_EQ(simple.state_hash(), resumed.state_hash());
}

} // namespace sandlane::test
