// `sandlane run`: a production run with its outputs, checkpoints and summary.
#include "app/run_outputs.hpp"

#include "app/difference.hpp"
#include "app/prepare.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "core/progress.hpp"
#include "output/checkpoint.hpp"

#include <algorithm>
#include <csignal>
#include <cstdio>

namespace sandlane::app {

namespace {

volatile std::sig_atomic_t stop_signal = 0;

void on_signal(int signal) {
    stop_signal = signal;
}

// First signal: finish the step and write a checkpoint. A second one ends the program as usual.
void catch_signals() {
    struct sigaction action = {};
    action.sa_handler = on_signal;
    action.sa_flags = static_cast<int>(SA_RESETHAND);
    for (const int signal : {SIGINT, SIGTERM, SIGUSR1}) sigaction(signal, &action, nullptr);
}

std::string default_folder(const Common& common, const scene::Scene& scene) {
    const std::string stem = common.scene.stem().string();
    return "results/" + (stem.empty() ? scene.title : stem);
}

struct Timing {
    double loop_seconds = 0, particle_steps = 0, wall_seconds = 0;
    std::int64_t steps = 0;
    [[nodiscard]] double rate() const { return loop_seconds > 0 ? particle_steps / loop_seconds : 0; }
};

std::string summary_json(const md::Simulation& sim, const Timing& t, const char* status) {
    const md::Plan& plan = sim.plan();
    static const char* methods[] = {"auto", "brute-force", "link-cells", "lattice", "lattice-half", "verlet"};
    return fmt::format(
        "{{\"status\": \"{}\", \"steps\": {}, \"step\": {}, \"time\": {}, \"particles\": {}, "
        "\"wall_seconds\": {:.6g}, "
        "\"loop_seconds\": {:.6g}, \"particle_steps_per_second\": {:.6g}, \"threads\": {}, \"isa\": \"{}\", "
        "\"plan\": {{\"engine\": \"md\", \"neighbours\": \"{}\", \"order\": {}, \"spin\": {}, \"dt\": {}}}, "
        "\"removed\": {}, \"state_hash\": \"{}\"}}",
        status, t.steps, sim.step(), sim.time(), sim.state().size(), t.wall_seconds, t.loop_seconds, t.rate(),
        plan.threads, simd::isa_name(plan.isa), methods[static_cast<int>(plan.neighbours)], plan.order,
        plan.spin, plan.dt, sim.removed(), sim.state_hash().hex());
}

// The schema that Google Benchmark writes, so that its compare.py reads production runs.
std::string benchmark_json(const md::Simulation& sim, const Timing& t, const std::string& name) {
    return fmt::format("{{\"context\": {{\"executable\": \"sandlane\", \"num_cpus\": {}}}, \"benchmarks\": "
                       "[{{\"name\": \"{}\", "
                       "\"run_name\": \"{}\", \"run_type\": \"iteration\", \"repetitions\": 1, \"threads\": "
                       "{}, \"iterations\": {}, "
                       "\"real_time\": {:.9g}, \"cpu_time\": {:.9g}, \"time_unit\": \"ns\", "
                       "\"particle_steps_per_second\": {:.6g}}}]}}\n",
                       allowed_cpus(), name, name, sim.plan().threads, t.steps,
                       t.steps > 0 ? 1e9 * t.loop_seconds / static_cast<double>(t.steps) : 0.0,
                       t.steps > 0 ? 1e9 * t.loop_seconds / static_cast<double>(t.steps) : 0.0, t.rate());
}

void report_check(md::Simulation& sim, double& worst) {
    const auto differences = compare_forces(sim, sim.plan().isa, simd::Isa::scalar);
    worst = std::max(worst, worst_relative(differences));
    fmt::print(stderr, "check at step {}: worst relative difference to the scalar reference {:.3g}\n",
               sim.step(), worst_relative(differences));
}

struct Loaded {
    Prepared prepared;
    output::Checkpoint checkpoint;
    bool resumed = false;
};

Loaded load(const Common& common, const RunOptions& options) {
    if (options.resume.empty()) return {prepare(common), {}, false};
    output::Checkpoint checkpoint = output::read_checkpoint(options.resume);
    scene::Scene scene = scene::parse_scene(checkpoint.scene, options.resume.string(), common.overrides);
    return {prepare(std::move(scene), common), std::move(checkpoint), true};
}

} // namespace

int run(const Common& common, const RunOptions& options) {
    const Stopwatch wall;
    Loaded loaded = load(common, options);
    const md::Plan& plan = loaded.prepared.plan;
    if (options.dry_run) {
        fmt::print("{}",
                   md::describe(loaded.prepared.scene, loaded.prepared.needs, loaded.prepared.derived, plan));
        return 0;
    }
    md::Simulation sim = loaded.prepared.simulation();
    if (loaded.resumed) sim.restore(loaded.checkpoint.engine_state);
    const bool in_place = loaded.resumed && options.out.empty();
    const std::filesystem::path folder =
        !options.out.empty() ? options.out
        : in_place           ? options.resume.parent_path().parent_path()
                             : std::filesystem::path(default_folder(common, loaded.prepared.scene));
    RunOutputs outputs(
        folder, sim,
        md::describe(loaded.prepared.scene, loaded.prepared.needs, loaded.prepared.derived, plan),
        in_place ? &loaded.checkpoint : nullptr);
    outputs.warn_into(common.quiet ? nullptr : stderr);

    const std::int64_t first = sim.step();
    const std::int64_t last = options.steps >= 0 ? first + options.steps : std::max(first, plan.steps);
    Progress progress(first, last, common.quiet);
    catch_signals();
    Timing timing;
    double worst = 0;
    const char* status = "finished";
    if (!loaded.resumed || !in_place) outputs.write_due(sim, true);
    std::int64_t slice = 1; // steps between looks at the clock and at signals
    while (sim.step() < last) {
        std::int64_t stop = std::min({last, outputs.next_due(sim.step()), sim.step() + slice});
        if (options.check_every > 0)
            stop = std::min(stop, (sim.step() / options.check_every + 1) * options.check_every);
        const std::int64_t before = sim.step();
        const Stopwatch loop;
        sim.run(stop - before);
        const double seconds = loop.seconds();
        timing.loop_seconds += seconds;
        timing.steps += stop - before;
        timing.particle_steps += static_cast<double>(stop - before) * static_cast<double>(sim.state().size());
        if (seconds < 0.05 && stop - before == slice) slice *= 2;
        if (seconds > 0.2 && slice > 1) slice /= 2;
        outputs.write_due(sim, false);
        if (options.check_every > 0 && sim.step() % options.check_every == 0) report_check(sim, worst);
        progress.update(sim.step(), sim.time(), sim.state().size());
        if (stop_signal != 0) status = "interrupted";
        if (options.walltime > 0 && wall.seconds() > options.walltime) status = "walltime";
        if (status[0] != 'f' && sim.step() < last) break;
        status = "finished";
    }
    const bool stopped = status[0] != 'f';
    timing.wall_seconds = wall.seconds();
    const std::string checkpoint =
        outputs.finish(sim, stopped, summary_json(sim, timing, status), timing.rate());
    if (!options.bench_json.empty())
        write_file_atomically(options.bench_json, benchmark_json(sim, timing, loaded.prepared.scene.title));
    if (common.json) fmt::print("{}\n", summary_json(sim, timing, status));
    if (!common.quiet)
        fmt::print(stderr, "{}: {} steps, {} grains, {:.3g} particle-steps/s, {} s. Results: {}\n", status,
                   timing.steps, sim.state().size(), timing.rate(), clock_text(timing.wall_seconds),
                   folder.string());
    if (stopped && !common.quiet) fmt::print(stderr, "Continue with: sandlane run --resume {}\n", checkpoint);
    if (worst > 1e-12) return static_cast<int>(Exit::comparison_failed);
    return static_cast<int>(stopped ? Exit::stopped : Exit::ok);
}

} // namespace sandlane::app
