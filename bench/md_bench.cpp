// Whole time steps of molecular dynamics in particle-steps per second: method x law x packing fraction x
// number of grains x instruction set x threads, each with the roofline of its case (step_cost.hpp).
// --rounds=R registers every case R times in turn, A B A B, so that slow drifts of the machine hit all cases
// alike.
#include "agitated.hpp"
#include "core/progress.hpp"
#include "step_cost.hpp"

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <charconv>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace {

using namespace sandlane;
using scene::NeighbourMethod;

struct Case {
    bench::Setup setup;
    simd::Isa isa = simd::Isa::scalar;
    int threads = 1;
};

std::string law_name(const bench::Setup& s) {
    return fmt::format("{}{}{}{}{}", s.normal == scene::NormalLaw::viscoelastic ? "hertz" : "linear",
                       s.springs    ? "+springs"
                       : s.friction ? "+friction"
                                    : "",
                       s.equal_radii ? "+equal" : "", s.two_materials ? "+two" : "",
                       s.integrator == scene::Integrator::velocity_verlet ? "+vv" : "");
}

std::string name_of(const Case& c) {
    static const char* methods[] = {"auto", "brute", "cells", "lattice", "half", "verlet"};
    return fmt::format("{}/{}/{}/phi={}/N={}/{}/threads={}", c.setup.dimension == 3 ? "md3" : "md",
                       methods[static_cast<int>(c.setup.neighbours)], law_name(c.setup),
                       c.setup.packing_fraction, c.setup.grains, simd::isa_name(c.isa), c.threads);
}

// The state that all methods, instruction sets and thread counts of a setup start from.
const std::vector<scene::GrainState>& agitated(bench::Setup setup) {
    static std::map<std::string, std::vector<scene::GrainState>> known;
    constexpr std::size_t large = 300000; // grains: of these only the last state is kept
    setup.integrator = scene::Integrator::gear5;
    const std::string key =
        fmt::format("{}/{}/{}/{}", setup.dimension, law_name(setup), setup.packing_fraction, setup.grains);
    const auto found = known.find(key);
    if (found != known.end()) return found->second;
    if (setup.grains > large)
        std::erase_if(known, [](const auto& entry) { return entry.second.size() > large; });
    setup.neighbours = NeighbourMethod::automatic;
    const auto start = bench::agitated_grains(setup, bench::agitated_scene(setup));
    md::Simulation simulation = bench::make(setup, start, simd::available_isas().back(), 1);
    simulation.run(setup.grains > large ? 200 : bench::at_rest(setup) ? 3000 : 1000);
    return known.emplace(key, bench::later_grains(simulation)).first->second;
}

// The library calls a benchmark several times to find its number of iterations; the simulation goes on
// meanwhile.
md::Simulation& running(const Case& c) {
    static std::string name;
    static std::optional<md::Simulation> simulation;
    if (name != name_of(c)) {
        simulation.reset();
        simulation.emplace(bench::make(c.setup, agitated(c.setup), c.isa, c.threads));
        name = name_of(c);
    }
    return *simulation;
}

void step(benchmark::State& state, const Case& c) {
    md::Simulation& simulation = running(c);
    const auto n = static_cast<double>(simulation.state().size());
    const std::int64_t block = std::max<std::int64_t>(4, 1000000 / static_cast<std::int64_t>(c.setup.grains));
    simulation.run(block);
    std::int64_t steps = 0;
    const Stopwatch clock;
    for (auto _ : state) {
        simulation.run(block);
        steps += block;
    }
    const double rate = static_cast<double>(steps) * n / clock.seconds();
    const double contacts = static_cast<double>(simulation.observe().contacts) / n;
    const bench::StepCost cost = bench::step_cost(simulation, contacts);
    const bench::Bound bound = bench::bound(cost, simulation);
    state.counters["particle_steps_per_second"] = rate;
    state.counters["neighbours"] = 2 * contacts; // touching, per grain
    state.counters["bytes_per_step"] = cost.bytes;
    state.counters["operations_per_step"] =
        cost.arithmetic + cost.single_arithmetic + cost.divide + cost.square_root;
    state.counters["bound_bytes"] = bound.bytes;
    state.counters["bound_compute"] = bound.compute;
    state.counters["of_bound"] = rate / bound.least();
    state.counters["working_set"] = static_cast<double>(simulation.bytes());
}

void add(const Case& c) {
    benchmark::RegisterBenchmark(name_of(c).c_str(), [=](benchmark::State& state) { step(state, c); })
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime();
}

// All methods, instruction sets and thread counts of one system.
void add_methods(bench::Setup setup) {
    for (const auto method : {NeighbourMethod::lattice, NeighbourMethod::lattice_half,
                              NeighbourMethod::link_cells, NeighbourMethod::verlet})
        for (const auto integrator : {scene::Integrator::gear5, scene::Integrator::velocity_verlet})
            for (const simd::Isa isa : simd::available_isas())
                for (int threads = 1; threads <= std::min(2, allowed_cpus()); ++threads) {
                    setup.neighbours = method;
                    setup.integrator = integrator;
                    add({setup, isa, threads});
                }
}

void add_all() {
    for (const std::size_t n : {1000U, 10000U, 100000U, 1000000U})
        for (const double phi : {0.2, 0.5, 0.82, 0.88})
            for (const auto normal : {scene::NormalLaw::linear_dashpot, scene::NormalLaw::viscoelastic})
                for (const bool friction : {true, false}) add_methods({n, phi, 2, normal, friction});
}

// Spheres: a packing at rest and a gas, by lists.
void add_space() {
    for (const std::size_t n : {512U, 4096U, 32768U, 262144U, 1000000U})
        for (const double phi : {0.3, 0.64})
            for (const auto normal : {scene::NormalLaw::linear_dashpot, scene::NormalLaw::viscoelastic})
                for (const int friction : {0, 1, 2})
                    for (const auto integrator :
                         {scene::Integrator::gear5, scene::Integrator::velocity_verlet})
                        for (const simd::Isa isa : simd::available_isas())
                            for (int threads = 1; threads <= std::min(2, allowed_cpus()); ++threads) {
                                bench::Setup setup{n, phi, 3, normal, friction > 0};
                                setup.springs = friction == 2;
                                setup.neighbours = NeighbourMethod::verlet;
                                setup.integrator = integrator;
                                add({setup, isa, threads});
                            }
}

// What `tools/bench skips` compares besides.
void add_skips() {
    bench::Setup base{10000, 0.82, 2, scene::NormalLaw::viscoelastic, true};
    for (const auto method : {NeighbourMethod::lattice_half, NeighbourMethod::verlet}) {
        base.neighbours = method;
        bench::Setup equal = base, two = base, springs = base;
        equal.equal_radii = two.two_materials = springs.springs = true;
        add({equal, simd::available_isas().back()});
        add({two, simd::available_isas().back()});
        if (method == NeighbourMethod::verlet) add({springs, simd::available_isas().back()});
    }
}

// Takes --rounds=R out of the arguments.
int take_rounds(int& argc, char** argv) {
    constexpr std::string_view option = "--rounds=";
    int rounds = 1, kept = 0;
    for (int a = 0; a < argc; ++a) {
        const std::string_view text = argv[a];
        if (text.starts_with(option))
            std::from_chars(text.data() + option.size(), text.data() + text.size(), rounds);
        else
            argv[kept++] = argv[a];
    }
    argc = kept;
    return rounds;
}

} // namespace

int main(int argc, char** argv) {
    const int rounds = take_rounds(argc, argv);
    for (int round = 0; round < rounds; ++round) {
        add_all();
        add_space();
        add_skips();
    }
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
