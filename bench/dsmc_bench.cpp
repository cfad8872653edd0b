// Steps of direct simulation Monte Carlo in particle-steps per second, with the ratio to the bound of
// bandwidth. A gas of hard spheres in a periodic box of cells, about 0.07 collisions per particle and step.
#include "core/progress.hpp"
#include "dsmc/simulation.hpp"
#include "machine.hpp"

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <memory>
#include <string>

namespace {

using namespace sandlane;

struct Case {
    std::string name;
    std::uint32_t particles;
    simd::Isa isa;
    int threads;
    dsmc::Setup setup;
};

// Cells of 0.55 mean free paths; ten particles in each as in the collisional benchmark of SPARTA, in space.
dsmc::Setup hard_spheres(std::uint32_t particles, int dimension = 3, double per_cell = 10) {
    dsmc::Setup s;
    s.dimension = dimension;
    const double cells = dimension == 3 ? std::cbrt(particles / per_cell) : std::sqrt(particles / per_cell);
    const auto count = static_cast<std::int32_t>(std::lround(cells));
    for (int d = 0; d < dimension; ++d) {
        s.cells[d] = count;
        s.upper[d] = count;
    }
    const double free_path = 1 / 0.55;
    const double density = 1 / (std::sqrt(2.0) * s.cross_section() * free_path);
    s.weight = density * s.volume() / particles;
    const double rate = dsmc::scales(s, particles, 1).collision_rate;
    s.dt = 0.145 / rate;
    return s;
}

std::string name_of(const Case& c) {
    return fmt::format("dsmc/{}/N={}/{}/threads={}", c.name, c.particles, simd::isa_name(c.isa), c.threads);
}

void step(benchmark::State& state, const Case& c) {
    static std::string name;
    static std::unique_ptr<dsmc::Simulation> simulation;
    if (name != name_of(c)) {
        simulation.reset();
        const auto start = dsmc::maxwellian(c.setup, c.particles, 1, c.setup.rough ? 1 : 0);
        simulation = std::make_unique<dsmc::Simulation>(c.setup, start, c.isa, c.threads);
        simulation->run(c.particles > 300000 ? 5 : 20);
        name = name_of(c);
    }
    const std::int64_t block = std::max<std::int64_t>(4, 4000000 / c.particles);
    simulation->run(2);
    const dsmc::Counts before = simulation->counts();
    std::int64_t steps = 0;
    const Stopwatch clock;
    for (auto _ : state) {
        simulation->run(block);
        steps += block;
    }
    const double work = static_cast<double>(steps) * c.particles;
    const double rate = work / clock.seconds();
    const dsmc::Counts& after = simulation->counts();
    state.counters["particle_steps_per_second"] = rate;
    state.counters["collisions"] = static_cast<double>(after.collisions - before.collisions) / work;
    state.counters["candidates"] = static_cast<double>(after.candidates - before.candidates) / work;
    state.counters["violations"] =
        static_cast<double>(after.violations - before.violations) /
        static_cast<double>(std::max<std::int64_t>(1, after.candidates - before.candidates));
    // The rows of a particle are read and written once per step; sorting and colliding go on in the cache.
    const double bytes = 2.0 * (c.setup.rough ? 96 : 64);
    const double bound = bench::bandwidth(c.isa, c.threads, simulation->bytes()) / bytes;
    state.counters["bytes_per_step"] = bytes;
    state.counters["bound_bytes"] = bound;
    state.counters["of_bound"] = rate / bound;
    state.counters["bytes_per_particle"] = static_cast<double>(simulation->bytes()) / c.particles;
}

void add(const std::string& name, std::uint32_t particles, const dsmc::Setup& setup) {
    for (const simd::Isa isa : simd::available_isas())
        for (int threads = 1; threads <= 2; ++threads) {
            const Case c{name, particles, isa, threads, setup};
            benchmark::RegisterBenchmark(name_of(c).c_str(), [=](benchmark::State& state) { step(state, c); })
                ->Unit(benchmark::kMillisecond)
                ->UseRealTime();
        }
}

void add_all() {
    for (const std::uint32_t n : {10000U, 100000U, 1000000U}) {
        dsmc::Setup s = hard_spheres(n);
        add("spheres", n, s);
        add("discs", n, hard_spheres(n, 2));
        s.gravity[2] = -1e-9;
        add("spheres+gravity", n, s);
        s = hard_spheres(n);
        s.walls.periodic[0] = s.walls.periodic[1] = s.walls.periodic[2] = false;
        add("spheres+walls", n, s);
        s = hard_spheres(n);
        s.restitution.model = laws::Restitution::Model::viscoelastic;
        s.restitution.dissipation = 1e-9;
        add("spheres+viscoelastic", n, s);
        s = hard_spheres(n);
        s.rough = true;
        s.tangential = -1;
        add("spheres+rough", n, s);
        s = hard_spheres(n);
        s.enskog = true;
        add("spheres+enskog", n, s);
        s = hard_spheres(n);
        s.partners = 5;
        add("spheres+near", n, s);
        s = hard_spheres(n);
        s.kicks = 1e-9;
        add("spheres+kicks", n, s);
        s = hard_spheres(n);
        s.others = {{1, 1, 0.5}}; // two kinds that are equal
        add("spheres+kinds", n, s);
        for (const int per_cell : {30, 100, 1000, 10000})
            if (n >= 10U * static_cast<unsigned>(per_cell))
                add(fmt::format("spheres+per_cell={}", per_cell), n, hard_spheres(n, 3, per_cell));
    }
}

} // namespace

int main(int argc, char** argv) {
    add_all();
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
