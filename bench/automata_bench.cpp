// Cellular automata in site updates per second: model x size of the lattice x instruction set x threads.
// `bound` is what the measured bandwidth of an in-place pass over the same bytes allows, site updates per
// second; `share` the part of it that was reached.
#include "automata/counted_pipe.hpp"
#include "automata/gas.hpp"
#include "automata/heap.hpp"
#include "automata/ripples.hpp"
#include "automata/sandpile.hpp"
#include "core/parallel.hpp"
#include "machine.hpp"

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <functional>
#include <string>

namespace {

using namespace sandlane;
using namespace sandlane::automata;

// bytes: that a step reads and writes per site; two lattices are twice as much memory as one.
struct Work {
    double sites = 0, bytes = 0, memory = 0;
    std::function<void()> step;
};

void report(benchmark::State& state, const Work& work, simd::Isa isa, int threads) {
    for (auto _ : state) work.step();
    const auto steps = static_cast<double>(state.iterations());
    const double bound = bench::bandwidth(isa, threads, static_cast<std::size_t>(work.memory)) / work.bytes;
    state.counters["sites/s"] = benchmark::Counter(work.sites * steps, benchmark::Counter::kIsRate);
    state.counters["bound"] = bound;
    state.counters["share"] = benchmark::Counter(work.sites * steps / bound, benchmark::Counter::kIsRate);
}

void fill(GasLattice& lattice, int planes) {
    for (int i = 0; i < planes; ++i)
        for (std::size_t w = 0; w < lattice.plane[0].size(); ++w) {
            const auto n = static_cast<std::uint32_t>(w);
            const PhiloxCounter r = philox({n, static_cast<std::uint32_t>(i), 0, 0}, {1, 2});
            // A quarter of the bits.
            lattice.plane[static_cast<std::size_t>(i)][w] =
                (std::uint64_t{r[0]} << 32 | r[1]) & (std::uint64_t{r[2]} << 32 | r[3]);
        }
}

struct GasCase {
    const char* name;
    GasModel model;
    bool alternating;
    double probability;     // of dissipation, gravity and roughness in a pipe
    bool by_planes = false; // FHP-III by Boolean expressions
};
constexpr GasCase gases[] = {{"fhp1-philox", GasModel::fhp1, false, 0},
                             {"fhp1-alternating", GasModel::fhp1, true, 0},
                             {"fhp2", GasModel::fhp2, false, 0},
                             {"fhp3", GasModel::fhp3, false, 0},
                             {"fhp3-planes", GasModel::fhp3, false, 0, true},
                             {"hpp", GasModel::hpp, false, 0},
                             {"pipe", GasModel::pipe, false, 0.1}};

void gas(benchmark::State& state, const GasCase& c, std::int32_t columns, std::int32_t rows, simd::Isa isa,
         int threads) {
    GasRules rules;
    rules.model = c.model;
    rules.alternating = c.alternating;
    rules.closed = c.model == GasModel::pipe;
    rules.dissipation = rules.gravity = rules.roughness = sixteenths(c.probability);
    rules.seed = {1, 0};
    GasLattice lattice(columns, rows);
    fill(lattice, rules.planes());
    GasStepper stepper(lattice, rules, {isa, threads}, false, c.by_planes);
    std::uint32_t t = 0;
    const double sites = static_cast<double>(columns) * rows, bits = rules.planes();
    // A run of 16 steps, two in a pass; a pipe is looked at after each.
    const bool looked_at = c.model == GasModel::pipe;
    const std::uint32_t steps = looked_at ? 1 : sites > 1e7 ? 2 : 16;
    const auto run = [&] {
        if (looked_at)
            stepper.step(lattice, t);
        else
            stepper.run(lattice, t, steps);
        t += steps;
    };
    report(state, {steps * sites, 2 * bits / 8 / (looked_at ? 1 : 2), sites * bits / 8, run}, isa, threads);
}

// A particle per site, all probabilities 0.1; after 500 steps as many rest as in the long run.
void counted_pipe(benchmark::State& state, std::int32_t columns, std::int32_t rows, simd::Isa isa,
                  int threads) {
    GasRules rules;
    rules.model = GasModel::pipe;
    rules.closed = true;
    rules.dissipation = rules.gravity = rules.roughness = sixteenths(0.1);
    rules.seed = {1, 0};
    CountedPipe pipe(columns, rows);
    for (int i = 0; i < 6; ++i)
        for (std::size_t w = 0; w < pipe.several.size(); ++w) {
            const PhiloxCounter r =
                philox({static_cast<std::uint32_t>(w), static_cast<std::uint32_t>(i), 0, 0}, {1, 2});
            const std::uint64_t eighth = (std::uint64_t{r[0]} << 32 | r[1]) &
                                         (std::uint64_t{r[2]} << 32 | r[3]) &
                                         (std::uint64_t{r[1]} << 32 | r[2]);
            pipe.lattice.plane[static_cast<std::size_t>(i)][w] = eighth;
        }
    CountedStepper stepper(pipe, rules, {isa, threads});
    std::uint32_t t = 0;
    for (; t < (columns > 10000 ? 50U : 500U); ++t) stepper.step(pipe, t);
    const double sites = static_cast<double>(columns) * rows;
    report(state, {sites, 2 * 7 / 8. + 4 / 8., sites * 11 / 8, [&] { stepper.step(pipe, t++); }}, isa,
           threads);
}

// Grains on 64 heaps that fill their table of 100 columns: the reference, or a heap to a lane.
struct HeapCase {
    const char* name;
    double roughness;
    std::int64_t steepest;
    bool two_sided;
};
constexpr HeapCase heaps[] = {{"heap", 0, 0, false},
                              {"heap-rough", 0.5, 0, false},
                              {"heap-two-sided", 0.5, 0, true},
                              {"heap-avalanches", 0.5, 3, true}};

void heap(benchmark::State& state, const HeapCase& c, simd::Isa isa, int threads) {
    constexpr std::uint32_t count = 64, grains = 100, full = 12000;
    std::vector<HeapTable> tables;
    for (std::uint32_t n = 0; n < count; ++n) {
        tables.emplace_back(100, HeapRules{.5, 1.5, 0, c.roughness, c.steepest, c.two_sided, {n, 0}});
        for (std::uint32_t g = 0; g < full; ++g) tables.back().drop(g);
    }
    std::uint32_t grain = full;
    for (auto _ : state) {
        for_tiles_dynamic(count / simd::heap_lanes, threads, [&](std::size_t k) {
            const std::span part = std::span(tables).subspan(k * simd::heap_lanes, simd::heap_lanes);
            if (isa == simd::Isa::scalar)
                for (HeapTable& table : part)
                    for (std::uint32_t g = 0; g < grains; ++g) table.drop(grain + g);
            else
                drop_on_lanes(part, isa, grain, grains);
        });
        grain += grains;
    }
    state.counters["grains/s"] =
        benchmark::Counter(static_cast<double>(count * grains) * static_cast<double>(state.iterations()),
                           benchmark::Counter::kIsRate);
}

void pile(benchmark::State& state, std::int32_t columns, std::int32_t rows, int bytes, simd::Isa isa,
          int threads) {
    PileLattice lattice(columns, rows, bytes);
    for (std::int32_t y = 0; y < rows; ++y)
        for (std::int32_t x = 0; x < columns; ++x) lattice.set(x, y, 6);
    PileSweeper sweeper(lattice, {isa, threads}, false);
    const double sites = static_cast<double>(columns) * rows;
    // Reads a lattice, and reads before it writes the other; two sweeps in a pass where that pays.
    const double sweeps = sweeper.pairs_pay() ? 2 : 1;
    const auto sweep = [&] {
        if (sweeps > 1)
            sweeper.sweep_pair(lattice, false);
        else
            sweeper.sweep(lattice, false);
    };
    report(state, {sweeps * sites, 3.0 * bytes / sweeps, 2 * sites * bytes, sweep}, isa, threads);
}

void ripples(benchmark::State& state, std::int32_t columns, std::int32_t rows, simd::Isa isa, int threads) {
    RippleRules rules{.6, 2, 7.3, .8, scene::RippleLanding::interpolated, {1, 0}};
    const std::size_t stride = padded(static_cast<std::size_t>(columns)) + 2 * simd::ripple_pad;
    Column<std::int64_t> heights(stride * static_cast<std::size_t>(rows), 0);
    for (std::size_t i = 0; i < heights.size(); ++i)
        heights[i] =
            static_cast<std::int64_t>(philox({static_cast<std::uint32_t>(i), 0, 0, 0}, {1, 2})[0] >> 8);
    RippleStepper stepper(columns, rows, rules, {isa, threads});
    std::uint32_t t = 0;
    for (; t < 100; ++t) stepper.step(heights, t); // ripples have grown
    const double sites = static_cast<double>(columns) * rows;
    report(state, {sites, 2 * 3 * 8.0, 2 * 8 * sites, [&] { stepper.step(heights, t++); }}, isa, threads);
}

// Sizes in L2 and beyond the caches.
void add_all() {
    const int most = allowed_cpus();
    for (const simd::Isa isa : simd::available_isas()) {
        for (const HeapCase& c : heaps)
            for (int threads = 1; threads <= (isa == simd::Isa::scalar ? 1 : most); threads *= 2)
                benchmark::RegisterBenchmark(
                    fmt::format("automata/{}/{}/threads={}", c.name, simd::isa_name(isa), threads).c_str(),
                    [=](benchmark::State& s) { heap(s, c, isa, threads); })
                    ->UseRealTime();
        if (isa == simd::Isa::scalar) continue; // other references are there to be right
        for (int threads = 1; threads <= most; threads *= 2)
            for (const bool large : {false, true}) {
                const auto add = [&](const std::string& name, const auto& body) {
                    benchmark::RegisterBenchmark(fmt::format("automata/{}/{}/{}/threads={}", name,
                                                             large ? "memory" : "L2", simd::isa_name(isa),
                                                             threads)
                                                     .c_str(),
                                                 body)
                        ->UseRealTime();
                };
                for (const GasCase& c : gases) {
                    const std::int32_t columns = large ? 1 << 15 : 1 << 12;
                    const std::int32_t rows = large ? 1 << 14 : 128;
                    add(c.name, [=](benchmark::State& s) { gas(s, c, columns, rows, isa, threads); });
                }
                add("pipe-counted", [=](benchmark::State& s) {
                    counted_pipe(s, large ? 1 << 14 : 1 << 12, large ? 1 << 13 : 128, isa, threads);
                });
                for (const int bytes : {1, 2})
                    add(fmt::format("pile-{}", bytes == 1 ? "bytes" : "words"), [=](benchmark::State& s) {
                        pile(s, large ? 1 << 14 : 512, large ? 1 << 13 : 512, bytes, isa, threads);
                    });
                add("ripples", [=](benchmark::State& s) {
                    ripples(s, large ? 4096 : 256, large ? 4096 : 128, isa, threads);
                });
            }
    }
}

} // namespace

int main(int argc, char** argv) {
    add_all();
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
