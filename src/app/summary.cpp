#include "app/summary.hpp"

#include "app/json.hpp"
#include "core/parallel.hpp"

namespace sandlane::app {

const char* status_name(Status status) {
    switch (status) {
    case Status::finished:
        return "finished";
    case Status::interrupted:
        return "interrupted";
    case Status::walltime:
        return "walltime";
    }
    return "";
}

std::string Summary::json() const {
    const Words& words = engine.words();
    return fmt::format(R"({{"status": "{}", "steps": {}, "step": {}, "time": {}, "{}": {}, {})"
                       R"("wall_seconds": {:.6g}, "total_wall_seconds": {:.6g}, "loop_seconds": {:.6g}, )"
                       R"("{}": {:.6g}, "threads": {}, "isa": "{}", "plan": {}, "state_hash": "{}"}})",
                       status_name(status), loop.steps, engine.step(), json_number(engine.time()), words.key,
                       engine.size(), engine.summary_json(), wall_seconds, wall_before + wall_seconds,
                       loop.seconds, words.rate_key(), loop.rate(), engine.threads(),
                       simd::isa_name(engine.isa()), engine.plan_json(), engine.state_hash().hex());
}

std::string Summary::benchmark_json() const {
    const std::string name = json_text(engine.scene().title);
    const double step_time = loop.steps > 0 ? 1e9 * loop.seconds / static_cast<double>(loop.steps) : 0;
    return fmt::format(
        R"({{"context": {{"executable": "sandlane", "num_cpus": {}}}, "benchmarks": [{{"name": {}, "run_name": {}, )"
        R"("run_type": "iteration", "repetitions": 1, "threads": {}, "iterations": {}, "real_time": {:.9g}, )"
        R"("cpu_time": {:.9g}, "time_unit": "ns", "{}": {:.6g}}}]}})"
        "\n",
        allowed_cpus(), name, name, engine.threads(), loop.steps, step_time, step_time,
        engine.words().rate_key(), loop.rate());
}

} // namespace sandlane::app
