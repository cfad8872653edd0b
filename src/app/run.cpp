// `sandlane run`: a production run with its outputs, checkpoints and summary.
#include "app/run_outputs.hpp"

#include "app/prepare.hpp"
#include "app/summary.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "core/progress.hpp"

#include <algorithm>
#include <csignal>

namespace sandlane::app {

namespace fs = std::filesystem;

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

// The folder of the run that wrote a checkpoint.
fs::path folder_of(const fs::path& checkpoint) {
    const fs::path parent = fs::absolute(checkpoint).parent_path();
    if (parent.filename() != "checkpoints")
        fail(Exit::invalid_input,
             "--resume {}: does not lie in the folder \"checkpoints\" of a run; give --out FOLDER for the "
             "results",
             checkpoint.string());
    return parent.parent_path();
}

std::string latest_checkpoint(const fs::path& folder) {
    fs::path latest;
    std::error_code missing;
    for (const auto& entry : fs::directory_iterator(folder / "checkpoints", missing))
        if (entry.path().extension() == ".checkpoint") latest = std::max(latest, entry.path());
    return latest.string();
}

// What an error leaves behind is still worth something.
[[noreturn]] void fail_with_results(const Error& e, const fs::path& folder) {
    const std::string checkpoint = latest_checkpoint(folder);
    fail(e.code(), "{} Results so far: {}. {}", e.what(), folder.string(),
         checkpoint.empty() ? "There is no checkpoint; output.checkpoint_every asks for some."
                            : "Last good checkpoint: " + checkpoint);
}

// The loop over steps, in slices that end where an output is due or a clock must be read.
class Loop {
public:
    Loop(Engine& engine, RunOutputs& outputs, const Common& common, const RunOptions& options)
        : engine_(engine), outputs_(outputs), last_(last_step(engine, options)), walltime_(options.walltime),
          check_every_(whole_strides(engine, options.check_every)),
          progress_(engine.step(),
                    std::min(last_, engine.step() + std::max<std::int64_t>(1, engine.expected_steps())),
                    common.quiet, engine.words().work, engine.words().time_unit) {}

    Status run(const Stopwatch& wall) {
        while (engine_.step() < last_) {
            advance(next_stop());
            outputs_.write_due(false);
            if (check_every_ > 0 && engine_.step() % check_every_ == 0) compare_with_reference();
            progress_.update(engine_.step(), engine_.time(), static_cast<std::size_t>(engine_.work(1)));
            if (engine_.step() >= last_ || engine_.finished()) break;
            if (stop_signal != 0) return Status::interrupted;
            if (walltime_ > 0 && wall.seconds() > walltime_) return Status::walltime;
        }
        return Status::finished;
    }

    [[nodiscard]] const LoopTiming& timing() const { return timing_; }
    [[nodiscard]] double worst_difference() const { return worst_; }

private:
    static std::int64_t last_step(const Engine& engine, const RunOptions& options) {
        return options.steps >= 0 ? engine.step() + options.steps : std::max(engine.step(), engine.steps());
    }

    static std::int64_t whole_strides(const Engine& engine, std::int64_t steps) {
        return (steps + engine.stride() - 1) / engine.stride() * engine.stride();
    }

    [[nodiscard]] std::int64_t next_stop() const {
        std::int64_t stop = std::min({last_, outputs_.next_due(engine_.step()), engine_.step() + slice_});
        if (check_every_ > 0) stop = std::min(stop, (engine_.step() / check_every_ + 1) * check_every_);
        return stop;
    }

    void advance(std::int64_t stop) {
        const std::int64_t asked = stop - engine_.step(), before = engine_.taken();
        const Stopwatch clock;
        engine_.run_until(asked, outputs_.next_time());
        const double seconds = clock.seconds();
        const std::int64_t taken = engine_.taken() - before; // fewer if it has finished, or is at an output
        timing_.seconds += seconds;
        timing_.steps += taken;
        timing_.work += engine_.work(taken);
        if (seconds < 0.05 && asked == slice_ && engine_.step() >= stop) slice_ *= 2;
        if (seconds > 0.2 && slice_ > 1) slice_ /= 2;
    }

    void compare_with_reference() {
        const double worst = worst_relative(engine_.compare_kernels(engine_.isa(), simd::Isa::scalar));
        worst_ = std::max(worst_, worst);
        tell(fmt::format("check at step {}: worst relative difference to the scalar reference {:.3g}\n",
                         engine_.step(), worst));
    }

    Engine& engine_;
    RunOutputs& outputs_;
    std::int64_t last_;
    double walltime_; // s
    std::int64_t check_every_;
    Progress progress_;
    LoopTiming timing_;
    double worst_ = 0;
    std::int64_t slice_ = 1; // steps between looks at the clock and at signals
};

// Without the setup, which holds the grains of the start.
struct Start {
    std::string plan, plan_json;
    std::unique_ptr<Engine> engine;
    fs::path folder;
    std::unique_ptr<output::Checkpoint> resumed; // null: from the beginning
    bool in_place = false;                       // goes on in the folder of the earlier run
};

Start start_from_checkpoint(const Common& common, const RunOptions& options) {
    Restorable r = prepare_checkpoint(options.resume, common);
    const bool in_place = options.out.empty();
    std::unique_ptr<Engine> engine = r.engine();
    r.checkpoint.engine_state = std::string();
    return {r.setup->description(),
            r.setup->json(),
            std::move(engine),
            in_place ? folder_of(options.resume) : options.out,
            std::make_unique<output::Checkpoint>(std::move(r.checkpoint)),
            in_place};
}

Start start_from_scene(const Common& common, const RunOptions& options) {
    const std::unique_ptr<Setup> setup = prepare(common);
    return {setup->description(),
            setup->json(),
            setup->start(),
            options.out.empty() ? "results" / common.scene.stem() : options.out,
            nullptr,
            false};
}

void report(const Summary& summary, const Common& common, const fs::path& folder,
            const std::string& checkpoint) {
    if (common.json) fmt::print("{}\n", summary.json());
    if (common.quiet) return;
    const Words& words = summary.engine.words();
    tell(fmt::format("{}: {} {}, {} {}, {:.3g} {}/s, {}. Results: {}\n", status_name(summary.status),
                     summary.loop.steps, words.steps, summary.engine.size(), words.things,
                     summary.loop.rate(), words.work, clock_text(summary.wall_seconds), folder.string()));
    if (summary.status != Status::finished)
        tell(fmt::format("Continue with: sandlane run --resume {}\n", checkpoint));
}

int execute(Start& start, const Common& common, const RunOptions& options, const Stopwatch& wall) {
    Engine& engine = *start.engine;
    const double wall_before = start.resumed ? start.resumed->wall_seconds : 0;
    RunOutputs outputs(start.folder, engine, start.plan, start.in_place ? start.resumed.get() : nullptr);
    outputs.be_quiet(common.quiet);
    outputs.spent_before(wall_before);
    try {
        if (!start.in_place) outputs.write_due(true);
        Loop loop(engine, outputs, common, options);
        const Status status = loop.run(wall);
        const Summary summary{engine, status, loop.timing(), wall.seconds(), wall_before};
        const std::string checkpoint =
            outputs.finish(status != Status::finished, summary.json(), loop.timing().rate());
        if (!options.bench_json.empty()) write_file_atomically(options.bench_json, summary.benchmark_json());
        report(summary, common, start.folder, checkpoint);
        if (loop.worst_difference() > 1e-12) return static_cast<int>(Exit::comparison_failed);
        return static_cast<int>(status == Status::finished ? Exit::ok : Exit::stopped);
    } catch (const Error& e) {
        fail_with_results(e, start.folder);
    }
}

} // namespace

int run(const Common& common, const RunOptions& options) {
    const Stopwatch wall;
    if (common.scene.empty() == options.resume.empty())
        fail(Exit::invalid_input, "run: give either a scene file, or a checkpoint with --resume");
    Start start =
        options.resume.empty() ? start_from_scene(common, options) : start_from_checkpoint(common, options);
    if (options.dry_run) {
        fmt::print("{}{}", common.json ? start.plan_json : start.plan, common.json ? "\n" : "");
        return 0;
    }
    catch_signals();
    return execute(start, common, options, wall);
}

} // namespace sandlane::app
