#include "machine.hpp"

#include "core/column.hpp"
#include "core/parallel.hpp"
#include "core/progress.hpp"
#include "simd/bench/rates.hpp"

#include <algorithm>
#include <bit>
#include <functional>
#include <map>
#include <numeric>
#include <random>
#include <tuple>
#include <utility>
#include <vector>

namespace sandlane::simd {

const RateKernels& rate_kernels_scalar();
#define ISA(name) const RateKernels& rate_kernels_##name();
#include "isas.def"
#undef ISA

const RateKernels& rate_kernels(Isa isa) {
#define ISA(name)                                                                                            \
    if (isa == Isa::name) return rate_kernels_##name();
#include "isas.def"
#undef ISA
    return rate_kernels_scalar();
}

} // namespace sandlane::simd

namespace sandlane::bench {

namespace {

// Best of several short trials: a roof is what the machine can do undisturbed.
constexpr int trials = 5;
constexpr double trial_seconds = 0.01;

// Calls work(repetitions) until it lasts long enough; returns the smallest time of one repetition in seconds.
template <class Work> double fastest(const Work& work) {
    std::int64_t repetitions = 1;
    double best = 0;
    for (int trial = 0; trial < trials;) {
        const Stopwatch clock;
        work(repetitions);
        const double seconds = clock.seconds();
        if (seconds < trial_seconds) {
            repetitions *= 2;
            continue;
        }
        const double one = seconds / static_cast<double>(repetitions);
        best = trial == 0 ? one : std::min(best, one);
        ++trial;
    }
    return best;
}

double operation_rate(simd::RateKernels::Registers kernel, int threads) {
    constexpr std::size_t line = 8; // doubles of a cache line: threads do not share one
    std::vector<double> sinks(static_cast<std::size_t>(threads) * line);
    constexpr std::int64_t rounds = 1000;
    const auto operations = static_cast<double>(kernel(rounds, sinks.data()));
    const double seconds = fastest([&](std::int64_t repetitions) {
        for_tiles(static_cast<std::size_t>(threads), threads,
                  [&](std::size_t t) { kernel(rounds * repetitions, sinks.data() + t * line); });
    });
    return operations * threads / seconds;
}

// Where others use the machine too, several threads may measure less than one alone: no roof.
double roof(const std::function<double(int)>& measure, int threads) {
    return threads > 1 ? std::max(measure(1), measure(threads)) : measure(1);
}

Rates measure_rates(simd::Isa isa, int threads) {
    const simd::RateKernels& k = simd::rate_kernels(isa);
    const auto rate = [&](simd::RateKernels::Registers kernel) {
        return roof([&](int count) { return operation_rate(kernel, count); }, threads);
    };
    return {rate(k.arithmetic), rate(k.single_arithmetic), rate(k.multiply_add), rate(k.divide),
            rate(k.square_root)};
}

// Each thread passes over a share of its own again and again: no barrier between passes.
double measure_bandwidth(simd::Isa isa, int threads, std::size_t working_set) {
    constexpr std::size_t block = 16; // doubles, what the kernels want a multiple of
    const auto shares = static_cast<std::size_t>(threads);
    const std::size_t share = std::max<std::size_t>(1, working_set / sizeof(double) / shares / block) * block;
    Column<double> x(share * shares, 1.0);
    const simd::RateKernels& k = simd::rate_kernels(isa);
    const double seconds = fastest([&](std::int64_t repetitions) {
        for_tiles(shares, threads, [&](std::size_t t) {
            for (std::int64_t r = 0; r < repetitions; ++r) k.in_place(x.data() + t * share, share);
        });
    });
    return 2.0 * static_cast<double>(x.bytes()) / seconds;
}

} // namespace

const Rates& rates(simd::Isa isa, int threads) {
    static std::map<std::pair<simd::Isa, int>, Rates> known;
    const auto [entry, fresh] = known.try_emplace({isa, threads});
    if (fresh) entry->second = measure_rates(isa, threads);
    return entry->second;
}

double bandwidth(simd::Isa isa, int threads, std::size_t working_set) {
    constexpr std::size_t most = std::size_t{512} << 20; // far beyond every cache
    const std::size_t size = std::min(std::bit_floor(working_set), most);
    static std::map<std::tuple<simd::Isa, int, std::size_t>, double> known;
    const auto [entry, fresh] = known.try_emplace({isa, threads, size});
    if (fresh) entry->second = roof([&](int count) { return measure_bandwidth(isa, count, size); }, threads);
    return entry->second;
}

double load_latency(std::size_t working_set) {
    constexpr std::size_t line = 64 / sizeof(std::uint64_t);
    const std::size_t lines = std::max<std::size_t>(2, working_set / 64);
    std::vector<std::uint64_t> next(lines * line);
    std::vector<std::size_t> order(lines);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::shuffle(order.begin(), order.end(), std::mt19937_64(1));
    for (std::size_t i = 0; i < lines; ++i) next[order[i] * line] = order[(i + 1) % lines] * line;
    constexpr std::int64_t jumps = 1000;
    std::uint64_t at = 0;
    const double seconds = fastest([&](std::int64_t repetitions) {
        for (std::int64_t j = 0; j < jumps * repetitions; ++j) at = next[at];
    });
    return at < next.size() ? seconds / jumps : 0;
}

double clock_rate() {
    static const double rate = [] {
        constexpr std::int64_t additions = 1000; // one after the other, a cycle each
        std::uint64_t sum = 0;
        const double seconds = fastest([&](std::int64_t repetitions) {
            for (std::int64_t n = 0; n < additions * repetitions; ++n) {
                sum += static_cast<std::uint64_t>(n) | 1;
                asm volatile("" : "+r"(sum));
            }
        });
        return additions / seconds;
    }();
    return rate;
}

} // namespace sandlane::bench
