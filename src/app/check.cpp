// `sandlane check`, `sandlane info` and `sandlane bench`: what a scene will do, what this program can do, how
// fast.
#include "app/json.hpp"
#include "app/prepare.hpp"
#include "core/progress.hpp"

#include <cstdio>

namespace sandlane::app {

void print_plan(const Prepared& p, bool json) {
    if (!json) {
        fmt::print("{}", p.description());
        return;
    }
    fmt::print(
        R"({{"grains": {}, "poured": {}, "dt": {}, "steps": {}, "collision_time": {}, "critical_dt": {}, )"
        R"("restitution": [{}, {}], "memory_bytes": {}, "isa": "{}", "threads": {}}})"
        "\n",
        p.needs.grains, p.needs.poured, json_number(p.plan.dt), p.plan.steps,
        json_number(p.derived.collision_time), json_number(p.derived.critical_dt),
        json_number(p.derived.restitution_min), json_number(p.derived.restitution_max),
        md::memory_bytes(p.needs, p.plan), simd::isa_name(p.plan.isa), p.plan.threads);
}

int check(const Common& common) {
    print_plan(prepare(common), common.json);
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
    fmt::print("engines       md\n");
    return 0;
}

namespace {

struct BenchResult {
    simd::Isa isa = simd::Isa::scalar;
    int threads = 1;
    double seconds = 0, rate = 0; // rate: particle-steps per second
};

BenchResult time_steps(const scene::Scene& scene, Common common, simd::Isa isa, int threads,
                       std::int64_t steps) {
    common.isa = simd::isa_name(isa);
    common.threads = threads;
    md::Simulation simulation = prepare(scene, common).simulation();
    simulation.run(steps / 10 + 1);
    const Stopwatch clock;
    simulation.run(steps);
    const double seconds = clock.seconds();
    return {isa, threads, seconds,
            static_cast<double>(steps) * static_cast<double>(simulation.state().size()) / seconds};
}

} // namespace

int bench(const Common& common, std::int64_t steps) {
    const scene::Scene scene = scene::read_scene(common.scene, common.overrides);
    const int most = choose_threads(common.threads).count;
    if (!common.json) fmt::print("{:<10}{:>8}{:>14}{:>22}\n", "isa", "threads", "loop s", "particle-steps/s");
    std::string json;
    for (const simd::Isa isa : simd::available_isas())
        for (int threads = 1; threads <= most; threads *= 2) {
            const BenchResult r = time_steps(scene, common, isa, threads, steps);
            json += fmt::format(
                R"({}{{"isa": "{}", "threads": {}, "loop_seconds": {}, "particle_steps_per_second": {}}})",
                json.empty() ? "" : ", ", simd::isa_name(r.isa), r.threads, json_number(r.seconds),
                json_number(r.rate));
            if (common.json) continue;
            fmt::print("{:<10}{:>8}{:>14.4g}{:>22.4g}\n", simd::isa_name(r.isa), r.threads, r.seconds,
                       r.rate);
            std::fflush(stdout);
        }
    if (common.json) fmt::print("{{\"steps\": {}, \"results\": [{}]}}\n", steps, json);
    return 0;
}

} // namespace sandlane::app
