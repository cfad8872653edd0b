#include "edmd/grow.hpp"

#include "core/error.hpp"
#include "edmd/epochs.hpp"
#include "edmd/reference/simple.hpp"
#include "edmd/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

namespace sandlane::edmd {

namespace {

// Room that growth leaves between all surfaces, relative to a radius: more than rounding.
constexpr double margin = 1e-10;
// p/(n T) of a round beyond which particles have jammed: a fluid has up to 30, and near a closest packing
// surfaces are 1/3 of its inverse of a radius apart.
constexpr double jammed = 1e4;

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
                                         const Start& start) {
    if (!s.has_room_for_cells()) return std::make_unique<SimpleAlgorithm>(s, particles);
    return std::make_unique<Simulation>(s, particles, start.isa, start.threads);
}

// p/(n T) of a run, at the temperature at its end: growth heats.
double compressibility(const Algorithm& run) {
    const auto n = static_cast<double>(run.size());
    const double temperature = observe(run.setup(), run.particles()).temperature;
    return run.time() > 0 ? 1 + run.tally().virial / (run.setup().dimension * n * temperature * run.time())
                          : std::numeric_limits<double>::infinity();
}

} // namespace

void grow(const Setup& setup, std::vector<Particle>& particles, const Start& start) {
    Setup s = growing(setup);
    const double end = packing(s, particles), dimension = s.dimension;
    const double loose = s.dimension == 3 ? 0.2 : 0.3;
    s.scale = std::min(1.0, std::pow(loose / end, 1 / dimension));
    while (!place_at_random(scaled(s, s.scale), particles)) s.scale *= 0.8; // narrow boxes
    const double speed = 1 / std::sqrt(s.classes[0].mass);
    s.growth = start.growth_rate * speed / s.classes[0].radius;
    for (int round = 1; s.scale < 1; ++round) { // of forty collisions of each
        heat(s, particles, 1, 0);
        const std::unique_ptr<Algorithm> run = algorithm_for(s, particles, start);
        (void)run->run(events_of_epoch(particles.size()) - 1, (1 - s.scale) / s.growth);
        particles = run->particles();
        for (Particle& p : particles) p.image = {0, 0, 0};
        // The last one stops at the time at which they have their size.
        const double grown = s.scale + s.growth * run->time();
        s.scale = grown >= 1 - 1e-14 ? 1 : grown;
        if (s.scale < 1 && compressibility(*run) > jammed)
            fail(Exit::invalid_input,
                 "edmd.start = \"growth\": after {} collisions of each the particles have jammed at packing "
                 "fraction {:.4g} of {:.4g}. Take fewer or smaller ones, a slower edmd.growth_rate than {}, "
                 "or start = \"lattice\"",
                 40 * round, end * std::pow(s.scale, dimension), end, start.growth_rate);
    }
}

} // namespace sandlane::edmd
