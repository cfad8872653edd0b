// The command line: sandlane run|check|compare|bench|info|render|convert.
#include "app/commands.hpp"
#include "core/error.hpp"
#include "scene/reader.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <functional>

namespace {

using namespace sandlane;

constexpr const char* exit_codes = "Exit codes: 0 ok, 1 comparison failed, 2 usage or invalid input, 4 "
                                   "instruction set or threads not available,\n"
                                   "5 output failed or checkpoint damaged, 6 simulation unstable, 7 stopped "
                                   "by limit or signal after a checkpoint,\n"
                                   "70 internal error.";

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

int guarded(const std::function<int()>& command) {
    try {
        return command();
    } catch (const Error& e) {
        fmt::print(stderr, "sandlane: {}\n", e.what());
        return static_cast<int>(e.code());
    } catch (const std::bad_alloc&) {
        fmt::print(stderr, "sandlane: out of memory; use fewer grains or a smaller domain\n");
        return static_cast<int>(Exit::internal);
    } catch (const std::exception& e) {
        fmt::print(stderr, "sandlane: internal error: {}\n", e.what());
        return static_cast<int>(Exit::internal);
    }
}

} // namespace

int main(int argc, char** argv) {
    CLI::App cli("sandlane: a simulator of granular matter");
    cli.set_version_flag("--version", std::string("sandlane ") + SANDLANE_VERSION);
    cli.footer(exit_codes);
    cli.require_subcommand(0, 1);
    bool help_scene = false;
    cli.add_flag("--help-scene", help_scene, "Print the scene reference (Markdown)");

    app::Common common;
    app::RunOptions run_options;
    app::CompareOptions compare_options;
    std::int64_t bench_steps = 1000;
    std::filesystem::path from, to;
    std::string colour = "speed";
    int width = 800;
    std::function<int()> job;

    CLI::App* run = cli.add_subcommand("run", "Run a scene");
    add_common(run, common, false);
    run->add_option("--out", run_options.out, "Folder for results (default: results/SCENE)");
    run->add_option("--resume", run_options.resume, "Continue from a checkpoint");
    run->add_option("--steps", run_options.steps, "Stop after N steps")->check(CLI::NonNegativeNumber);
    run->add_option("--check-every", run_options.check_every,
                    "Compare forces with the scalar reference every N steps")
        ->check(CLI::NonNegativeNumber);
    run->add_option("--walltime", run_options.walltime, "Stop after this many seconds, with a checkpoint")
        ->check(CLI::NonNegativeNumber);
    run->add_option("--bench-json", run_options.bench_json, "Write timings in Google Benchmark's format");
    run->add_flag("--dry-run", run_options.dry_run, "Print the plan and stop");
    run->callback([&] {
        job = [&] {
            if (common.scene.empty() && run_options.resume.empty())
                fail(Exit::invalid_input, "run: give a scene file, or a checkpoint with --resume");
            return app::run(common, run_options);
        };
    });

    CLI::App* check =
        cli.add_subcommand("check", "Validate a scene and print derived quantities and the plan");
    add_common(check, common, true);
    check->callback([&] { job = [&] { return app::check(common); }; });

    CLI::App* compare =
        cli.add_subcommand("compare", "Run vector and scalar side by side and report differences");
    add_common(compare, common, true);
    compare->add_option("--steps", compare_options.steps, "Steps to run")->check(CLI::NonNegativeNumber);
    compare->add_option("--with", compare_options.second,
                        "Instruction set of the other side (default: scalar)");
    compare->add_option("--tolerance", compare_options.tolerance,
                        "Relative difference allowed (default: none)");
    compare->callback([&] { job = [&] { return app::compare(common, compare_options); }; });

    CLI::App* bench =
        cli.add_subcommand("bench", "Particle-steps per second of a scene for every instruction set");
    add_common(bench, common, true);
    bench->add_option("--steps", bench_steps, "Steps to time")->check(CLI::PositiveNumber);
    bench->callback([&] { job = [&] { return app::bench(common, bench_steps); }; });

    CLI::App* info = cli.add_subcommand("info", "What this program and this machine can do");
    info->add_option("-j,--threads", common.threads, "Threads");
    info->callback([&] { job = [&] { return app::info(common); }; });

    CLI::App* render = cli.add_subcommand("render", "Picture of a checkpoint");
    render->add_option("checkpoint", from, "Checkpoint file")->required();
    render->add_option("png", to, "Picture to write")->required();
    render->add_option("--colour", colour, "speed, pressure, spin or radius")
        ->check(CLI::IsMember({"speed", "pressure", "spin", "radius"}));
    render->add_option("--width", width, "Pixels")->check(CLI::Range(64, 16384));
    render->callback([&] { job = [&] { return app::render(from, to, colour, width); }; });

    CLI::App* convert =
        cli.add_subcommand("convert", "Between scenes (.toml), the book's init files and snapshots");
    convert->add_option("from", from, "Scene, checkpoint or book file")->required();
    convert->add_option("to", to, "Scene (.toml) or book file (any other ending)")->required();
    convert->callback([&] { job = [&] { return app::convert(from, to); }; });

    try {
        cli.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        return cli.exit(e) == 0 ? 0 : static_cast<int>(Exit::invalid_input);
    }
    if (help_scene) {
        fmt::print("{}", scene::scene_reference());
        return 0;
    }
    if (!job) {
        fmt::print("{}", cli.help());
        return 0;
    }
    return guarded(job);
}
