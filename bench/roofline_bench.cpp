// What the machine can do: bandwidth of the state's access pattern and rate of independent double operations.
#include "core/column.hpp"
#include "core/parallel.hpp"

#include <benchmark/benchmark.h>

namespace {

using sandlane::Column;

// In-place read and write, as the integrator does with its state.
void in_place(benchmark::State& state) {
    const auto n = static_cast<std::size_t>(state.range(0)) / sizeof(double);
    const int threads = static_cast<int>(state.range(1));
    Column<double> x(n, 1.0);
    constexpr std::size_t tile = 8192;
    for (auto _ : state) {
        sandlane::for_tiles(n / tile, threads, [&](std::size_t t) {
            double* p = x.data() + t * tile;
            for (std::size_t i = 0; i < tile; ++i) p[i] = p[i] * 0.999 + 1.0;
        });
        benchmark::ClobberMemory();
    }
    state.SetBytesProcessed(state.iterations() * state.range(0) * 2);
}
BENCHMARK(in_place)
    ->ArgsProduct({{1 << 19, 8 << 20, 512 << 20}, {1, 2}})
    ->ArgNames({"bytes", "threads"})
    ->UseRealTime();

void copy(benchmark::State& state) {
    const auto n = static_cast<std::size_t>(state.range(0)) / sizeof(double);
    const int threads = static_cast<int>(state.range(1));
    Column<double> x(n, 1.0), y(n, 0.0);
    constexpr std::size_t tile = 8192;
    for (auto _ : state) {
        sandlane::for_tiles(n / tile, threads, [&](std::size_t t) {
            const double* p = x.data() + t * tile;
            double* q = y.data() + t * tile;
            for (std::size_t i = 0; i < tile; ++i) q[i] = p[i] + 1.0;
        });
        benchmark::ClobberMemory();
    }
    state.SetBytesProcessed(state.iterations() * state.range(0) * 2);
}
BENCHMARK(copy)
    ->ArgsProduct({{1 << 19, 8 << 20, 512 << 20}, {1, 2}})
    ->ArgNames({"bytes", "threads"})
    ->UseRealTime();

} // namespace

BENCHMARK_MAIN();
