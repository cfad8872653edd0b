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
    static const char* spares[] = {
        "", "+spare_rotation", "+spare_memory", "+spare_radii", "+spare_materials", "+spare_space"};
    return fmt::format("{}{}{}{}{}{}{}{}{}", s.normal == scene::NormalLaw::viscoelastic ? "hertz" : "linear",
                       s.springs    ? "+springs"
                       : s.friction ? "+friction"
                                    : "",
                       s.equal_radii ? "+equal" : "", s.two_materials ? "+two" : "",
                       s.integrator == scene::Integrator::velocity_verlet ? "+vv" : "",
                       spares[static_cast<int>(s.spare)], s.half_empty ? "+half_empty" : "",
                       s.large ? "+large" : "", s.one_grid ? "+one_grid" : "");
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
    setup.one_grid = false;
    setup.spare = bench::Spare::nothing;
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
    state.counters["cycles_per_step"] = bench::clock_rate() * c.threads / rate;
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

// What `tools/bench skips` compares: the same state with and without what it has no need of.
void add_skips() {
    using bench::Spare;
    const bench::Setup base{10000, 0.82, 2, scene::NormalLaw::viscoelastic, true};
    const auto add_spare = [](bench::Setup setup, NeighbourMethod method, Spare spare) {
        setup.neighbours = method;
        setup.spare = spare;
        add({setup, simd::available_isas().back()});
    };
    bench::Setup smooth = base, equal = base, half_empty = base, twice = base;
    smooth.friction = false;
    equal.equal_radii = true;
    half_empty.half_empty = true;
    twice.grains = 2 * base.grains;
    for (const auto method : {NeighbourMethod::verlet, NeighbourMethod::lattice_half}) {
        add_spare(smooth, method, Spare::rotation);
        add_spare(base, method, Spare::materials);
    }
    add_spare(smooth, NeighbourMethod::verlet, Spare::memory);
    add_spare(equal, NeighbourMethod::lattice_half, Spare::radii);
    add_spare(equal, NeighbourMethod::lattice_half, Spare::nothing);
    add_spare(base, NeighbourMethod::verlet, Spare::space);
    add_spare(half_empty, NeighbourMethod::lattice_half, Spare::nothing);
    add_spare(twice, NeighbourMethod::lattice_half, Spare::nothing);
}

// A few large grains among many small ones, with a grid of cells for each and with one for all.
void add_sizes() {
    for (const int dimension : {2, 3})
        for (const auto method : {NeighbourMethod::link_cells, NeighbourMethod::verlet})
            for (const bool one_grid : {false, true}) {
                bench::Setup setup{40000, dimension == 3 ? 0.3 : 0.5, dimension};
                setup.neighbours = method;
                setup.large = true;
                setup.one_grid = one_grid;
                add({setup, simd::available_isas().back()});
            }
}

// Numbers of grains for `tools/bench scaling` that the cases above do not have.
void add_scaling() {
    for (const std::size_t n : {4000U, 16000U, 64000U, 250000U, 10000000U}) {
        bench::Setup setup{n, 0.82};
        setup.neighbours = NeighbourMethod::verlet;
        add({setup, simd::available_isas().back()});
    }
    bench::Setup spheres{10000000, 0.64, 3, scene::NormalLaw::viscoelastic};
    spheres.neighbours = NeighbourMethod::verlet;
    spheres.springs = true;
    add({spheres, simd::available_isas().back()});
}

// ---- what is not computed, on against off

// Discs in a round pile on the floor of a wide box with a ceiling of many pieces that they never reach.
scene::Scene walled_scene() {
    scene::Scene s = bench::agitated_scene({});
    s.domain.periodic = {};
    for (const double y : {-1.0, s.domain.upper.y + 1}) {
        scene::Wall w;
        w.kind = scene::WallKind::polyline;
        for (int n = 0; n <= 64; ++n) w.points.push_back({s.domain.upper.x * n / 64.0, y, 0});
        s.walls.push_back(w);
    }
    s.domain.lower.y = -2;
    s.domain.upper.y += 2;
    s.domain.outside = scene::Outside::remove;
    return s;
}

// Forces of walls alone: of those near each grain, or of all.
void walls(benchmark::State& state, bool near_only) {
    const scene::Scene s = walled_scene();
    const auto grains = bench::agitated_grains({}, bench::agitated_scene({}));
    const md::Needs needs = md::analyse(s, grains);
    const md::Plan plan =
        md::make_plan(s, needs, md::derive(s, needs), simd::available_isas().back(), {1, "benchmark"});
    const md::Simulation simulation(s, grains, needs, plan);
    const md::State& now = simulation.state();
    md::Walls walls(s, plan, needs);
    const std::vector<double> coefficients = md::pair_table(s);
    std::vector<double> force(now.force_stride() * md::tile_size);
    const Stopwatch clock;
    std::int64_t steps = 0;
    for (auto _ : state) {
        walls.account(0);
        walls.update(now, now.record.data());
        for (std::size_t tile = 0; tile < now.tiles(); ++tile)
            benchmark::DoNotOptimize(
                walls.add_forces({now.record.data(), now.material.data(), coefficients.data(), 1,
                                  force.data(), tile * md::tile_size, nullptr, nullptr, 0, plan.dt,
                                  1 / plan.dt, nullptr, static_cast<int>(now.force_stride())},
                                 tile, now.size(), near_only));
        ++steps;
    }
    state.counters["particle_steps_per_second"] =
        static_cast<double>(steps) * static_cast<double>(now.size()) / clock.seconds();
}

// Steps with outputs that are never due, and with a row of the log and a snapshot in every step.
void outputs(benchmark::State& state, std::int64_t every) {
    const bench::Setup setup{
        10000, 0.82, 2, scene::NormalLaw::viscoelastic, true, false, NeighbourMethod::verlet};
    md::Simulation simulation = bench::make(setup, agitated(setup), simd::available_isas().back(), 1);
    simulation.run(64);
    std::int64_t steps = 0;
    const Stopwatch clock;
    for (auto _ : state) {
        for (std::int64_t n = 0; n < 64; n += every) {
            simulation.run(every);
            if (every > 1) continue;
            benchmark::DoNotOptimize(simulation.observe());
            benchmark::DoNotOptimize(simulation.snapshot());
        }
        steps += 64;
    }
    state.counters["particle_steps_per_second"] =
        static_cast<double>(steps) * static_cast<double>(simulation.state().size()) / clock.seconds();
}

// Steps of one length, and steps whose length follows the contacts: whole steps, whatever their length.
void adaptive(benchmark::State& state, bool adapts) {
    const bench::Setup setup{
        10000, 0.82, 2, scene::NormalLaw::viscoelastic, true, false, NeighbourMethod::verlet};
    scene::Scene s = bench::agitated_scene(setup);
    const auto& grains = agitated(setup);
    s.md.adaptive_dt = adapts;
    const md::Needs needs = md::analyse(s, grains);
    md::Simulation simulation(
        s, grains, needs,
        md::make_plan(s, needs, md::derive(s, needs), simd::available_isas().back(), {1, "benchmark"}));
    const std::int64_t block = md::sort_interval * simulation.plan().largest_stride;
    simulation.run(block);
    const std::int64_t before = simulation.taken(), from = simulation.step();
    const Stopwatch clock;
    for (auto _ : state) simulation.run(block);
    const auto steps = static_cast<double>(simulation.taken() - before);
    state.counters["particle_steps_per_second"] =
        steps * static_cast<double>(grains.size()) / clock.seconds();
    state.counters["mean_step"] = // in units of the step that does not adapt
        static_cast<double>(simulation.step() - from) / static_cast<double>(simulation.plan().base_stride) /
        steps;
}

// Two compartments: a gas in the upper one, grains at rest that do not touch in the lower one.
void at_rest(benchmark::State& state, bool freeze) {
    const bench::Setup setup{
        20000, 0.5, 2, scene::NormalLaw::linear_dashpot, true, false, NeighbourMethod::verlet};
    scene::Scene s = bench::agitated_scene(setup);
    auto grains = bench::agitated_grains(setup, s);
    const double row = s.domain.upper.y / static_cast<double>(bench::side_of(setup)),
                 middle = row * static_cast<double>(bench::side_of(setup) / 2);
    for (scene::GrainState& g : grains)
        if (g.position.y < middle) g.velocity = {};
    for (const double y : {0.0, middle}) {
        scene::Wall w;
        w.kind = scene::WallKind::segment;
        w.points = {{-1, y, 0}, {s.domain.upper.x + 1, y, 0}};
        s.walls.push_back(w);
    }
    s.md.freeze = freeze;
    const md::Needs needs = md::analyse(s, grains);
    md::Simulation simulation(
        s, grains, needs,
        md::make_plan(s, needs, md::derive(s, needs), simd::available_isas().back(), {1, "benchmark"}));
    simulation.run(256);
    std::int64_t steps = 0;
    const Stopwatch clock;
    for (auto _ : state) {
        simulation.run(256);
        steps += 256;
    }
    state.counters["particle_steps_per_second"] =
        static_cast<double>(steps) * static_cast<double>(grains.size()) / clock.seconds();
}

void add_parts() {
    const auto add_part = [](const char* name, auto body) {
        benchmark::RegisterBenchmark(name, body)->Unit(benchmark::kMillisecond)->UseRealTime();
    };
    add_part("part/walls/all", [](benchmark::State& state) { walls(state, false); });
    add_part("part/walls/near", [](benchmark::State& state) { walls(state, true); });
    add_part("part/rest/computed", [](benchmark::State& state) { at_rest(state, false); });
    add_part("part/rest/frozen", [](benchmark::State& state) { at_rest(state, true); });
    add_part("part/adaptive/on", [](benchmark::State& state) { adaptive(state, true); });
    add_part("part/adaptive/off", [](benchmark::State& state) { adaptive(state, false); });
    add_part("part/outputs/always", [](benchmark::State& state) { outputs(state, 1); });
    add_part("part/outputs/never", [](benchmark::State& state) { outputs(state, 64); });
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
        add_sizes();
        add_scaling();
        add_parts();
    }
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
