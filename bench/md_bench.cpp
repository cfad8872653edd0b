// Whole time steps of molecular dynamics in particle-steps per second: instruction set x method x law x
// packing fraction x number of grains x threads. `tools/bench` prints the distance to the measured roofline
// beside it.
#include "agitated_discs.hpp"

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <string>

namespace {

using namespace sandlane;
using scene::NeighbourMethod;

void step(benchmark::State& state, bench::Setup setup, simd::Isa isa, int threads) {
    md::Simulation simulation = bench::make(setup, isa, threads);
    simulation.run(setup.grains > 300000 ? 200 : 1000); // contacts form
    const std::int64_t block = setup.grains > 300000 ? 20 : setup.grains > 30000 ? 100 : 1000;
    std::int64_t steps = 0;
    for (auto _ : state) {
        simulation.run(block);
        steps += block;
    }
    const md::Observables o = simulation.observe();
    const auto n = static_cast<double>(simulation.state().size());
    state.counters["particle_steps_per_second"] =
        benchmark::Counter(static_cast<double>(steps) * n, benchmark::Counter::kIsRate);
    state.counters["contacts_per_grain"] = 2 * static_cast<double>(o.contacts) / n;
    state.counters["bytes_per_grain"] = static_cast<double>(simulation.bytes()) / n;
}

std::string name_of(const bench::Setup& s, simd::Isa isa, int threads) {
    static const char* methods[] = {"auto", "brute", "cells", "lattice", "half", "verlet"};
    return fmt::format("md/{}/{}{}{}{}/phi={}/N={}/{}/threads={}", methods[static_cast<int>(s.neighbours)],
                       s.normal == scene::NormalLaw::viscoelastic ? "hertz" : "linear",
                       s.friction ? "+friction" : "", s.equal_radii ? "+equal" : "",
                       s.integrator == scene::Integrator::velocity_verlet ? "+vv" : "", s.packing_fraction,
                       s.grains, simd::isa_name(isa), threads);
}

void add(const bench::Setup& setup, simd::Isa isa, int threads) {
    benchmark::RegisterBenchmark(name_of(setup, isa, threads).c_str(),
                                 [=](benchmark::State& state) { step(state, setup, isa, threads); })
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime();
}

void add_all() {
    for (const std::size_t n : {1000U, 10000U, 100000U, 1000000U})
        for (const double phi : {0.2, 0.5, 0.82})
            for (const auto method : {NeighbourMethod::lattice, NeighbourMethod::lattice_half,
                                      NeighbourMethod::link_cells, NeighbourMethod::verlet})
                for (const auto normal : {scene::NormalLaw::linear_dashpot, scene::NormalLaw::viscoelastic})
                    for (const bool friction : {true, false})
                        for (const simd::Isa isa : simd::available_isas())
                            for (const int threads : {1, 2}) {
                                if (threads > allowed_cpus()) continue;
                                add({n, phi, normal, friction, false, method}, isa, threads);
                                if (method == NeighbourMethod::verlet)
                                    add({n, phi, normal, friction, false, method,
                                         scene::Integrator::velocity_verlet},
                                        isa, threads);
                            }
}

} // namespace

int main(int argc, char** argv) {
    add_all();
    benchmark::Initialize(&argc, argv);
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
