// Collisions per second of event-driven dynamics, elastic hard spheres and discs in a periodic box; and the
// stress run, --stress EVENTS: discs at packing fraction 0.5 that must neither overlap nor drift.
#include "edmd/simulation.hpp"
#include "edmd/start.hpp"

#include "core/progress.hpp"
#include "machine.hpp"

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <numbers>
#include <string>

namespace {

using namespace sandlane;

struct Case {
    int dimension;
    double phi;
    std::uint32_t particles;
    simd::Isa isa;
    double eps = 1;
    bool rough = false;
};

edmd::Setup hard_gas(const Case& c) {
    edmd::Setup s;
    s.dimension = c.dimension;
    const double content = c.dimension == 3 ? std::numbers::pi / 6 : std::numbers::pi / 4;
    const double length = std::pow(c.particles * content / c.phi, 1.0 / c.dimension);
    for (int d = 0; d < c.dimension; ++d) s.upper[d] = length;
    s.restitution.eps = c.eps;
    s.rough = c.rough;
    if (c.rough) s.tangential = -1;
    return s;
}

std::string name_of(const Case& c) {
    return fmt::format("edmd/{}{}{}/phi={}/N={}/{}", c.dimension == 3 ? "spheres" : "discs",
                       c.rough ? "+rough" : "", c.eps < 1 ? fmt::format("+eps={}", c.eps) : "", c.phi,
                       c.particles, simd::isa_name(c.isa));
}

void collide(benchmark::State& state, const Case& c) {
    static std::string name;
    static std::unique_ptr<edmd::Simulation> gas;
    if (name != name_of(c)) {
        gas.reset();
        const edmd::Setup setup = hard_gas(c);
        gas = std::make_unique<edmd::Simulation>(
            setup, edmd::make_particles(setup, {c.particles}, 1, c.rough ? 1 : 0), c.isa, 1);
        gas->run(std::max<std::int64_t>(100000, 2 * std::int64_t{c.particles}));
        name = name_of(c);
    }
    const edmd::Work before = gas->work();
    std::int64_t events = 0;
    constexpr std::int64_t block = 100000;
    const Stopwatch clock;
    for (auto _ : state) events += gas->run(block);
    const double rate = static_cast<double>(events) / clock.seconds();
    const edmd::Work& after = gas->work();
    state.counters["collisions_per_second"] = rate;
    state.counters["crossings"] =
        static_cast<double>(after.crossings - before.crossings) / static_cast<double>(events);
    state.counters["stale"] = static_cast<double>(after.stale - before.stale) / static_cast<double>(events);
    state.counters["bytes_per_particle"] = static_cast<double>(gas->bytes()) / c.particles;
    // Four dependent misses of the cache per collision, if nothing were in order.
    const double chase = bench::load_latency(gas->bytes());
    state.counters["chase_ns"] = 1e9 * chase;
    state.counters["of_chase_bound"] = rate * 4 * chase;
}

void add(const Case& c) {
    benchmark::RegisterBenchmark(name_of(c).c_str(), [=](benchmark::State& state) { collide(state, c); })
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime();
}

void add_all() {
    for (const simd::Isa isa : simd::available_isas()) {
        for (const double phi : {0.1, 0.3, 0.49})
            for (const std::uint32_t n : {1000U, 10000U, 100000U, 1000000U}) add({3, phi, n, isa});
        for (const double phi : {0.3, 0.65}) add({2, phi, 10000, isa});
        add({3, 0.1, 10000, isa, 0.9});
        add({3, 0.3, 10000, isa, 1, true});
    }
}

int stress(double events) {
    const Case c{2, 0.5, 10000, simd::choose_isa("auto")};
    const edmd::Setup setup = hard_gas(c);
    edmd::Simulation gas(setup, edmd::make_particles(setup, {c.particles}, 1), c.isa, 1);
    const Stopwatch clock;
    double done = 0, told = 0;
    while (done < events) {
        done += static_cast<double>(gas.run(1000000));
        if (clock.seconds() - told < 30 && done < events) continue;
        told = clock.seconds();
        const double drift = edmd::observe(setup, gas.particles()).temperature - 1;
        fmt::print("{:.3g} events, {:.0f} s: smallest gap {:.3g} R, energy {:+.3g}\n", done, told,
                   gas.tally().smallest_gap / 0.5, drift);
        if (gas.tally().smallest_gap < -1e-12 * 0.5 || std::abs(drift) > 1e-10) return 1;
    }
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    if (argc == 3 && std::strcmp(argv[1], "--stress") == 0) return stress(std::atof(argv[2]));
    add_all();
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
