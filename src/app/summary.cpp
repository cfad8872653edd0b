#include "app/summary.hpp"

#include "app/json.hpp"
#include "core/parallel.hpp"
#include "scene/schema.hpp"

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
    const md::Plan& plan = simulation.plan();
    const std::string plan_text =
        fmt::format(R"({{"engine": "md", "neighbours": "{}", "order": {}, "spin": {}, "dt": {}}})",
                    scene::neighbour_choices()[static_cast<std::size_t>(plan.neighbours)], plan.order,
                    md::turns(plan), json_number(plan.dt));
    return fmt::format(
        R"({{"status": "{}", "steps": {}, "step": {}, "time": {}, "particles": {}, "removed": {}, )"
        R"("wall_seconds": {:.6g}, "total_wall_seconds": {:.6g}, "loop_seconds": {:.6g}, )"
        R"("particle_steps_per_second": {:.6g}, "threads": {}, "isa": "{}", "plan": {}, "state_hash": "{}"}})",
        status_name(status), loop.steps, simulation.step(), json_number(simulation.time()),
        simulation.state().size(), simulation.removed(), wall_seconds, wall_before + wall_seconds,
        loop.seconds, loop.rate(), plan.threads, simd::isa_name(plan.isa), plan_text,
        simulation.state_hash().hex());
}

std::string Summary::benchmark_json() const {
    const std::string name = json_text(simulation.scene().title);
    const double step_time = loop.steps > 0 ? 1e9 * loop.seconds / static_cast<double>(loop.steps) : 0;
    return fmt::format(
        R"({{"context": {{"executable": "sandlane", "num_cpus": {}}}, "benchmarks": [{{"name": {}, "run_name": {}, )"
        R"("run_type": "iteration", "repetitions": 1, "threads": {}, "iterations": {}, "real_time": {:.9g}, )"
        R"("cpu_time": {:.9g}, "time_unit": "ns", "particle_steps_per_second": {:.6g}}}]}})"
        "\n",
        allowed_cpus(), name, name, simulation.plan().threads, loop.steps, step_time, step_time, loop.rate());
}

} // namespace sandlane::app
