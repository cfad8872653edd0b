// Biases of direct simulation Monte Carlo, for tools/bench accuracy: one measurement on the standard output.
//   dsmc_accuracy viscosity SCHEME EDGE STEP PER_CELL PARTICLES SEED   of a sheared elastic gas, over that of
//   Enskog dsmc_accuracy sonine SCHEME EDGE STEP PER_CELL PARTICLES SEED      a2 of a cooling gas of
//   restitution 0.5 dsmc_accuracy rate SCHEME EDGE STEP PER_CELL PARTICLES SEED        collisions over those
//   of theory
// EDGE: of a cell, in mean free paths; STEP: times the collision rate. Spheres, n s^2 = 0.1, m = T = s = 1.
#include "core/progress.hpp"
#include "dsmc/simulation.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <string>

namespace {

using namespace sandlane;

constexpr double density = 0.1;
const double rate = 4 * density * std::sqrt(std::numbers::pi);              // per particle at T = 1, 1/s
const double free_path = 1 / (std::sqrt(2.0) * std::numbers::pi * density); // m
// Chapman and Enskog, at T = 1; the factor is that of their higher orders.
const double viscosity = 1.016034 * 5 / (16 * std::sqrt(std::numbers::pi));

struct Result {
    double value, steps, seconds; // of all particles together: particle-steps, s
};

laws::CollisionScheme scheme_of(const std::string& name) {
    using laws::CollisionScheme;
    if (name == "direction-first") return CollisionScheme::direction_first;
    if (name == "nanbu-babovsky") return CollisionScheme::nanbu_babovsky;
    if (name == "majorant-frequency") return CollisionScheme::majorant_frequency;
    if (name == "bernoulli") return CollisionScheme::bernoulli;
    return CollisionScheme::no_time_counter;
}

dsmc::Setup gas(double edge, double step, double per_cell, std::uint32_t particles) {
    dsmc::Setup s;
    const auto cells = static_cast<std::int32_t>(std::lround(std::cbrt(particles / per_cell)));
    for (int d = 0; d < 3; ++d) {
        s.cells[d] = cells;
        s.upper[d] = cells * edge * free_path;
    }
    s.weight = density * s.volume() / particles;
    s.dt = step / rate;
    return s;
}

// Shear heats the gas by viscosity times shear^2, whoever carries the momentum, flights or collisions across
// a cell. The viscosity goes with the root of T, which therefore grows evenly: d sqrt(T)/dt = viscosity
// shear^2/(3 n).
Result sheared(dsmc::Setup s, std::uint32_t particles) {
    s.shear = 0.12 * rate;
    const double growth = viscosity * s.shear * s.shear / (3 * density);
    const double begin = 6 / rate, end = 18 / rate;        // the stress is there after some collision times
    const double first = 1 - growth * 0.5 * (begin + end); // T = 1 in the middle of what is measured
    dsmc::Simulation run(s, dsmc::maxwellian(s, particles, first * first), simd::choose_isa("auto"), 1);
    run.run(std::numeric_limits<std::int64_t>::max(), begin);
    const double before = std::sqrt(run.observe().temperature), from = run.time();
    const std::int64_t step = run.step();
    const Stopwatch clock;
    run.run(std::numeric_limits<std::int64_t>::max(), end);
    const double seconds = clock.seconds();
    const double grown = std::sqrt(run.observe().temperature) - before;
    return {grown / (growth * (run.time() - from)), static_cast<double>(run.step() - step) * particles,
            seconds};
}

Result cooling(dsmc::Setup s, std::uint32_t particles) {
    s.restitution.eps = 0.5;
    s.adaptive = true;
    dsmc::Simulation run(s, dsmc::maxwellian(s, particles, 1), simd::choose_isa("auto"), 1);
    const auto collisions = [&] { return 2.0 * static_cast<double>(run.counts().collisions) / particles; };
    while (collisions() < 12) run.run(1);
    const std::int64_t step = run.step();
    double sum = 0, seconds = 0;
    constexpr int frames = 8;
    for (int f = 1; f <= frames; ++f) {
        const Stopwatch clock;
        while (collisions() < 12 + 2 * f) run.run(1);
        seconds += clock.seconds();
        sum += run.observe().fourth / frames;
    }
    return {sum, static_cast<double>(run.step() - step) * particles, seconds};
}

Result collisions(const dsmc::Setup& s, std::uint32_t particles) {
    dsmc::Simulation run(s, dsmc::maxwellian(s, particles, 1), simd::choose_isa("auto"), 1);
    run.run(5);
    const std::int64_t before = run.counts().collisions, step = run.step();
    const Stopwatch clock;
    run.run(std::max<std::int64_t>(4, std::llround(20 / (rate * s.dt))));
    const double seconds = clock.seconds();
    const double steps = static_cast<double>(run.step() - step) * particles;
    // A box of N particles has pairs of N - 1; energy without the motion of the whole likewise.
    const double expected = 0.5 * rate * s.dt * steps * (1 - 1.0 / particles);
    return {static_cast<double>(run.counts().collisions - before) / expected, steps, seconds};
}

} // namespace

int main(int argc, char** argv) {
    if (argc != 8) {
        fmt::print(stderr, "see the head of dsmc_accuracy.cpp\n");
        return 2;
    }
    const std::string what = argv[1];
    const auto particles = static_cast<std::uint32_t>(std::atof(argv[6]));
    dsmc::Setup s = gas(std::atof(argv[3]), std::atof(argv[4]), std::atof(argv[5]), particles);
    s.scheme = scheme_of(argv[2]);
    s.seed = static_cast<std::uint64_t>(std::atoll(argv[7]));
    const Result r = what == "viscosity" ? sheared(s, particles)
                     : what == "sonine"  ? cooling(s, particles)
                                         : collisions(s, particles);
    fmt::print("{} {}\n", r.value, 1e9 * r.seconds / r.steps);
    return 0;
}
