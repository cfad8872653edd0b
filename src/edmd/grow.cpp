#include "edmd/grow.hpp"

#include "core/error.hpp"
#include "edmd/epochs.hpp"
#include "edmd/reference/simple.hpp"
#include "edmd/simulation.hpp"
#include "edmd/start.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

namespace sandlane::edmd {

namespace {

// Room that growth leaves between all surfaces, relative to a radius: more than rounding.
constexpr double margin = 1e-10;
// Epochs of some twenty events per particle.
constexpr int most_rounds = 150;

// Elastic smooth particles between walls at rest.
Setup growing(const Setup& setup) {
    Setup s;
    s.dimension = setup.dimension;
    s.seed = setup.seed;
    s.classes = setup.classes;
    for (Class& c : s.classes) c.radius *= 1 + margin;
    for (int d = 0; d < 3; ++d) {
        s.periodic[d] = setup.periodic[d];
        s.lower[d] = setup.lower[d];
        s.upper[d] = setup.upper[d];
        if (setup.periodic[d] || d >= setup.dimension) continue;
        s.lower[d] += setup.side[d][0].motion.amplitude;
        s.upper[d] -= setup.side[d][1].motion.amplitude;
    }
    return s;
}

double packing(const Setup& s, const std::vector<Particle>& particles) {
    Amounts amounts(s.classes.size());
    for (const Particle& p : particles) ++amounts[p.kind];
    return packing_fraction(s, amounts);
}

Setup scaled(Setup s, double scale) {
    for (Class& c : s.classes) c.radius *= scale;
    return s;
}

std::unique_ptr<Algorithm> algorithm_for(const Setup& s, const std::vector<Particle>& particles,
                                         int threads) {
    if (!s.has_room_for_cells()) return std::make_unique<SimpleAlgorithm>(s, particles);
    return std::make_unique<Simulation>(s, particles, simd::choose_isa("auto"), threads);
}

} // namespace

void grow(const Setup& setup, std::vector<Particle>& particles, double rate, int threads) {
    Setup s = growing(setup);
    const double end = packing(s, particles), dimension = s.dimension;
    const double loose = s.dimension == 3 ? 0.2 : 0.3;
    s.scale = std::min(1.0, std::pow(loose / end, 1 / dimension));
    while (!place_at_random(scaled(s, s.scale), particles)) s.scale *= 0.8; // narrow boxes
    const double speed = 1 / std::sqrt(s.classes[0].mass);
    s.growth = rate * speed / s.classes[0].radius;
    for (int round = 0; s.scale < 1; ++round) {
        if (round == most_rounds)
            fail(Exit::invalid_input,
                 "edmd.start = \"growth\": after {} collisions of each the particles have jammed at packing "
                 "fraction {:.4g} of {:.4g}. Take fewer or smaller ones, a slower edmd.growth_rate than {}, "
                 "or start = \"lattice\"",
                 40 * round, end * std::pow(s.scale, dimension), end, rate);
        heat(s, particles, 1, 0); // growth heats
        const std::unique_ptr<Algorithm> run = algorithm_for(s, particles, threads);
        (void)run->run(events_of_epoch(particles.size()) - 1, (1 - s.scale) / s.growth);
        particles = run->particles();
        for (Particle& p : particles) p.image = {0, 0, 0};
        // The last one stops at the time at which they have their size.
        const double grown = s.scale + s.growth * run->time();
        s.scale = grown >= 1 - 1e-14 ? 1 : grown;
    }
}

} // namespace sandlane::edmd
