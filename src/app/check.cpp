// `sandlane check`, `sandlane info` and `sandlane bench`: what a scene will do, what this program can do, how
// fast.
#include "app/json.hpp"
#include "app/prepare.hpp"
#include "core/progress.hpp"
#include "scene/reader.hpp"
#include "scene/schema.hpp"

#include <fmt/ranges.h>

#include <cstdio>

namespace sandlane::app {

int check(const Common& common) {
    print_plan(*prepare(common), common.json);
    return 0;
}

int info(const Common& common) {
    const ThreadChoice threads = choose_threads(common.threads);
    fmt::print("sandlane {}\ncompiler      {}\n", SANDLANE_VERSION, SANDLANE_COMPILER);
    for (const simd::Isa isa : {simd::Isa::scalar, simd::Isa::sse4_2, simd::Isa::avx2, simd::Isa::avx512})
        fmt::print("{:<14}{}\n", simd::isa_name(isa),
                   simd::isa_supported(isa) ? "available"
                   : simd::isa_built(isa)   ? "built, not on this machine"
                                            : "not built");
    fmt::print("threads       {} ({}); {} CPUs allowed\n", threads.count, threads.reason, allowed_cpus());
    fmt::print("engines       {}\n", fmt::join(scene::engine_choices(), ", "));
    return 0;
}

namespace {

struct BenchResult {
    simd::Isa isa = simd::Isa::scalar;
    int threads = 1;
    Words words;
    double seconds = 0, rate = 0; // rate: things times steps per second
};

BenchResult time_steps(const scene::Scene& scene, Common common, simd::Isa isa, int threads,
                       std::int64_t steps) {
    common.isa = simd::isa_name(isa);
    common.threads = threads;
    const std::unique_ptr<Engine> engine = prepare(scene, common)->start();
    engine->run(steps / 10 + 1);
    const std::int64_t before = engine->taken();
    const Stopwatch clock;
    engine->run(steps);
    const double seconds = clock.seconds();
    return {isa, threads, engine->words(), seconds,
            static_cast<double>(engine->taken() - before) * static_cast<double>(engine->size()) / seconds};
}

} // namespace

int bench(const Common& common, std::int64_t steps) {
    const scene::Scene scene = scene::read_scene(common.scene, common.overrides);
    const int most = choose_threads(common.threads).count;
    std::string json;
    for (const simd::Isa isa : simd::available_isas())
        for (int threads = 1; threads <= most; threads *= 2) {
            const BenchResult r = time_steps(scene, common, isa, threads, steps);
            const bool first = json.empty();
            json += fmt::format(R"({}{{"isa": "{}", "threads": {}, "loop_seconds": {}, "{}": {}}})",
                                first ? "" : ", ", simd::isa_name(r.isa), r.threads, json_number(r.seconds),
                                r.words.rate_key(), json_number(r.rate));
            if (common.json) continue;
            if (first)
                fmt::print("{:<10}{:>8}{:>14}{:>22}\n", "isa", "threads", "loop s", r.words.work + "/s");
            fmt::print("{:<10}{:>8}{:>14.4g}{:>22.4g}\n", simd::isa_name(r.isa), r.threads, r.seconds,
                       r.rate);
            std::fflush(stdout);
        }
    if (common.json) fmt::print("{{\"steps\": {}, \"results\": [{}]}}\n", steps, json);
    return 0;
}

} // namespace sandlane::app
