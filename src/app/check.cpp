// `sandlane check`, `sandlane info` and `sandlane bench`: what a scene will do, what this program can do, how
// fast.
#include "app/prepare.hpp"
#include "core/progress.hpp"

#include <fmt/format.h>

#include <cstdio>

namespace sandlane::app {

int check(const Common& common) {
    const Prepared p = prepare(common);
    if (common.json)
        fmt::print("{{\"grains\": {}, \"poured\": {}, \"dt\": {}, \"steps\": {}, \"collision_time\": {}, "
                   "\"critical_dt\": {}, "
                   "\"restitution\": [{}, {}], \"isa\": \"{}\", \"threads\": {}}}\n",
                   p.needs.grains, p.needs.poured, p.plan.dt, p.plan.steps, p.derived.collision_time,
                   p.derived.critical_dt, p.derived.restitution_min, p.derived.restitution_max,
                   simd::isa_name(p.plan.isa), p.plan.threads);
    else
        fmt::print("{}", md::describe(p.scene, p.needs, p.derived, p.plan));
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

int bench(const Common& common, std::int64_t steps) {
    const scene::Scene scene = scene::read_scene(common.scene, common.overrides);
    fmt::print("{:<10}{:>8}{:>14}{:>22}\n", "isa", "threads", "loop s", "particle-steps/s");
    for (const simd::Isa isa : simd::available_isas())
        for (int threads = 1; threads <= choose_threads(common.threads).count; threads *= 2) {
            Common one = common;
            one.isa = simd::isa_name(isa);
            one.threads = threads;
            md::Simulation simulation = prepare(scene, one).simulation();
            simulation.run(steps / 10 + 1);
            const Stopwatch clock;
            simulation.run(steps);
            const double seconds = clock.seconds();
            fmt::print("{:<10}{:>8}{:>14.4g}{:>22.4g}\n", simd::isa_name(isa), threads, seconds,
                       static_cast<double>(steps) * static_cast<double>(simulation.state().size()) / seconds);
            std::fflush(stdout);
        }
    return 0;
}

} // namespace sandlane::app
