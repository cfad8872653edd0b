// What the machine can do: rates of double and single precision operations per instruction set, bandwidth of
// the integrator's access pattern and latency of dependent loads against the size of the working set.
#include "core/parallel.hpp"
#include "machine.hpp"

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <functional>
#include <string>
#include <vector>

namespace {

using namespace sandlane;

// The measurements bring their own repetitions: one iteration, the value as a counter.
void add(const std::string& name, const char* unit, const std::function<double()>& measure) {
    benchmark::RegisterBenchmark(name.c_str(),
                                 [=](benchmark::State& state) {
                                     for (auto _ : state) state.counters[unit] = measure();
                                 })
        ->Iterations(1)
        ->Unit(benchmark::kMillisecond);
}

void add_rates(simd::Isa isa, int threads) {
    const auto rate = [&](const char* name, double bench::Rates::*member) {
        add(fmt::format("rate/{}/{}/threads={}", name, simd::isa_name(isa), threads), "per_second",
            [=] { return bench::rates(isa, threads).*member; });
    };
    rate("double", &bench::Rates::arithmetic);
    rate("single", &bench::Rates::single_arithmetic);
    rate("multiply-add", &bench::Rates::multiply_add);
    rate("divide", &bench::Rates::divide);
    rate("sqrt", &bench::Rates::square_root);
}

} // namespace

int main(int argc, char** argv) {
    std::vector<int> threads = {1};
    if (allowed_cpus() > 1) threads.push_back(2);
    for (const simd::Isa isa : simd::available_isas())
        for (const int t : threads) add_rates(isa, t);
    constexpr std::size_t kib = 1024, mib = 1024 * kib;
    const simd::Isa best = simd::available_isas().back();
    for (const std::size_t size : {32 * kib, 512 * kib, 8 * mib, 64 * mib, 512 * mib})
        for (const int t : threads)
            add(fmt::format("bandwidth/KiB={}/{}/threads={}", size / kib, simd::isa_name(best), t),
                "bytes_per_second", [=] { return bench::bandwidth(best, t, size); });
    for (const std::size_t size : {32 * kib, 512 * kib, 8 * mib, 64 * mib, 512 * mib})
        add(fmt::format("latency/KiB={}", size / kib), "seconds", [=] { return bench::load_latency(size); });
    benchmark::Initialize(&argc, argv);
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
