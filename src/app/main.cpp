// The command line: sandlane run|check|compare|bench|info|render|convert.
#include "app/commands.hpp"
#include "core/error.hpp"
#include "core/progress.hpp"
#include "scene/reader.hpp"
#include "scene/schema.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <functional>
#include <system_error>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace {

using namespace sandlane;
using Job = std::function<int()>;

constexpr const char* exit_codes = "Exit codes: 0 ok, 1 comparison failed, 2 usage or invalid input, 4 "
                                   "instruction set, threads or memory not\n"
                                   "available, 5 output failed or checkpoint damaged, 6 simulation unstable, "
                                   "7 stopped by limit or signal after a\n"
                                   "checkpoint, 70 internal error.";

constexpr std::int64_t most_steps = std::int64_t{1} << 53;
const CLI::Range step_count(std::int64_t{0}, most_steps);

// All options of all commands; each command reads its own.
struct Options {
    app::Common common;
    app::RunOptions run;
    app::CompareOptions compare;
    app::RenderOptions render;
    app::ConvertOptions convert;
    std::int64_t bench_steps = 1000;
};

void add_common(CLI::App* command, app::Common& common, bool scene_required) {
    auto* scene = command->add_option("scene", common.scene, "Scene file (TOML)");
    if (scene_required) scene->required();
    command->add_option("--set", common.overrides, "Override a key: path=value, repeatable")
        ->allow_extra_args(false);
    command
        ->add_option("-j,--threads", common.threads, "Threads (default: OMP_NUM_THREADS, affinity, cgroup)")
        ->check(CLI::Range(1, 4096));
    command->add_option("--isa", common.isa, "Instruction set: auto, scalar, sse4.2, avx2, avx512");
    command->add_flag("--quiet", common.quiet, "No progress and no messages but errors");
    command->add_flag("--json", common.json, "One JSON object on standard output");
}

void add_run(CLI::App& cli, Options& o, Job& job) {
    CLI::App* run = cli.add_subcommand("run", "Run a scene");
    add_common(run, o.common, false);
    run->add_option("--out", o.run.out, "Folder for results (default: results/SCENE)");
    run->add_option("--resume", o.run.resume, "Continue from a checkpoint");
    run->add_option("--steps", o.run.steps, "Stop after N steps")->check(step_count);
    run->add_option("--check-every", o.run.check_every,
                    "Compare forces with the scalar reference every N steps")
        ->check(step_count);
    run->add_option("--walltime", o.run.walltime, "Stop after this many seconds, with a checkpoint")
        ->check(CLI::NonNegativeNumber);
    run->add_option("--bench-json", o.run.bench_json, "Write timings in Google Benchmark's format");
    run->add_flag("--dry-run", o.run.dry_run, "Print the plan and stop");
    run->callback([&] { job = [&] { return app::run(o.common, o.run); }; });
}

void add_inspection(CLI::App& cli, Options& o, Job& job) {
    CLI::App* check =
        cli.add_subcommand("check", "Validate a scene and print derived quantities and the plan");
    add_common(check, o.common, true);
    check->callback([&] { job = [&] { return app::check(o.common); }; });

    CLI::App* compare =
        cli.add_subcommand("compare", "Run vector and scalar side by side and report differences");
    add_common(compare, o.common, true);
    compare->add_option("--steps", o.compare.steps, "Steps to run")->check(step_count);
    compare->add_option("--with", o.compare.second, "Instruction set of the other side (default: scalar)");
    compare->add_option("--tolerance", o.compare.tolerance, "Relative difference allowed (default: none)")
        ->check(CLI::NonNegativeNumber);
    compare->callback([&] { job = [&] { return app::compare(o.common, o.compare); }; });

    CLI::App* bench =
        cli.add_subcommand("bench", "Particle-steps per second of a scene for every instruction set");
    add_common(bench, o.common, true);
    bench->add_option("--steps", o.bench_steps, "Steps to time")
        ->check(CLI::Range(std::int64_t{1}, most_steps));
    bench->callback([&] { job = [&] { return app::bench(o.common, o.bench_steps); }; });

    CLI::App* info = cli.add_subcommand("info", "What this program and this machine can do");
    info->add_option("-j,--threads", o.common.threads, "Threads");
    info->callback([&] { job = [&] { return app::info(o.common); }; });
}

void add_conversion(CLI::App& cli, Options& o, Job& job) {
    CLI::App* render = cli.add_subcommand("render", "Picture of a checkpoint, or of the start of a scene");
    render->add_option("from", o.render.from, "Checkpoint, or scene (.toml)")->required();
    render->add_option("png", o.render.png, "Picture to write")->required();
    const scene::Choices& colours = scene::colour_choices();
    render
        ->add_option("--colour", o.render.look.colour,
                     "What the colour of a grain shows (default: as in the scene)")
        ->check(CLI::IsMember(std::vector<std::string>(colours.begin(), colours.end())));
    render->add_option("--width", o.render.look.width, "Pixels (default: as in the scene)")
        ->check(CLI::Range(64, 16384));
    render
        ->add_option("--view", o.render.look.view,
                     "3D: direction to the viewer, x,y,z (default: as in the scene)")
        ->delimiter(',')
        ->expected(3);
    render->callback([&] { job = [&] { return app::render(o.render); }; });

    CLI::App* convert = cli.add_subcommand(
        "convert",
        "Between scenes (.toml), checkpoints (.checkpoint) and the book's init files and snapshots");
    convert->add_option("from", o.convert.from, "Scene, checkpoint, or book file (any other ending)")
        ->required();
    convert->add_option("to", o.convert.to, "Scene, or book file (any other ending)")->required();
    convert
        ->add_option("--frame", o.convert.frame,
                     "Frame of a book file of snapshots, from 0 (default: the last)")
        ->check(step_count);
    convert->add_flag("--snapshot", o.convert.snapshot, "Write a snapshot frame instead of an init file");
    convert->callback([&] { job = [&] { return app::convert(o.convert); }; });
}

int failed(Exit code, const std::string& message) {
    tell(fmt::format("sandlane: {}\n", message));
    return static_cast<int>(code);
}

int guarded(const Job& job) {
    try {
        const int code = job();
        if (std::fflush(stdout) != 0) throw std::system_error(errno, std::generic_category());
        return code;
    } catch (const Error& e) {
        return failed(e.code(), e.what());
    } catch (const std::bad_alloc&) {
        return failed(Exit::unavailable, "out of memory; use fewer grains or a smaller domain");
    } catch (const std::system_error& e) {
        return failed(Exit::io, fmt::format("standard output or a file: {}", e.what()));
    } catch (const std::exception& e) {
        return failed(Exit::internal, fmt::format("internal error: {}", e.what()));
    }
}

} // namespace

int main(int argc, char** argv) {
    std::signal(SIGXFSZ, SIG_IGN); // a limit on file sizes is an error of the write, with a message
#if defined(__GLIBC__)
    mallopt(M_MMAP_THRESHOLD, 1 << 20); // buffers as long as all grains go back to the system
#endif
    CLI::App cli("sandlane: a simulator of granular matter");
    cli.set_version_flag("--version", std::string("sandlane ") + SANDLANE_VERSION);
    cli.footer(exit_codes);
    cli.require_subcommand(0, 1);
    bool help_scene = false;
    cli.add_flag("--help-scene", help_scene, "Print the scene reference (Markdown)");
    Options options;
    Job job;
    add_run(cli, options, job);
    add_inspection(cli, options, job);
    add_conversion(cli, options, job);
    try {
        cli.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        return cli.exit(e) == 0 ? 0 : static_cast<int>(Exit::invalid_input);
    }
    return guarded([&] {
        if (job && !help_scene) return job();
        fmt::print("{}", help_scene ? scene::scene_reference() : cli.help());
        return 0;
    });
}
