// Runs that go well, and runs that are interrupted: a resumed run ends with the bits of the undisturbed one.
#include "program.hpp"

#include "simd/tables.hpp"

#include <nlohmann/json.hpp>

#include <fmt/format.h>

#include <chrono>
#include <csignal>
#include <random>
#include <thread>

namespace sandlane::test {

using nlohmann::json;

namespace {

class Runs : public App {
protected:
    Runs() { write("scene.toml", box_scene); }

    [[nodiscard]] json summary(const std::string& out) const {
        return json::parse(read(out + "/summary.json"));
    }
    [[nodiscard]] std::string hash_of(const std::string& out) const { return summary(out)["state_hash"]; }
    void expect_same_results(const std::string& out, const std::string& reference) const {
        EXPECT_EQ(hash_of(out), hash_of(reference));
        for (const char* file : {"/log.csv", "/trajectory.dump", "/trajectory.book"})
            EXPECT_EQ(read(out + file), read(reference + file)) << file;
    }
    // The data of plots and replay in the report.
    [[nodiscard]] std::string shown(const std::string& out) const {
        const std::string page = read(out + "/report.html");
        const std::size_t first = page.find("<script type=\"application/json\"");
        return page.substr(first, page.find("<script>", first) - first);
    }
};

TEST_F(Runs, SummaryIsOneJsonObject) {
    const Outcome o = run_well({"run", "scene.toml", "--out", "out", "--json"});
    EXPECT_EQ(std::count(o.out.begin(), o.out.end(), '\n'), 1);
    const json d = json::parse(o.out);
    EXPECT_EQ(d["status"], "finished");
    EXPECT_EQ(d["particles"], 80);
    EXPECT_EQ(d["steps"], d["step"]);
    const double steps = d["steps"], dt = d["plan"]["dt"], loop = d["loop_seconds"];
    EXPECT_NEAR(steps * dt, 0.2, dt);
    EXPECT_LE(loop, d["wall_seconds"]);
    EXPECT_EQ(d["total_wall_seconds"], d["wall_seconds"]);
    // Both numbers have six digits.
    EXPECT_NEAR(static_cast<double>(d["particle_steps_per_second"]) * loop, 80 * steps, 1e-5 * 80 * steps);
    EXPECT_GE(d["threads"], 1);
    EXPECT_TRUE(simd::isa_from_name(std::string(d["isa"])).has_value());
    const std::string hash = d["state_hash"];
    EXPECT_EQ(hash.size(), 32U);
    EXPECT_EQ(hash.find_first_not_of("0123456789abcdef"), std::string::npos);
    EXPECT_EQ(read("out/summary.json"), o.out);
}

TEST_F(Runs, TheLogOfSpaceHasThreeComponents) {
    write("cube.toml", cube_scene);
    run_well({"run", "cube.toml", "--out", "out", "--quiet"});
    const std::string log = read("out/log.csv"), header = log.substr(0, log.find('\n'));
    for (const char* column : {"momentum_z[kg m/s]", "floor_force_z[N]", "floor_torque_x[N m]",
                               "floor_torque_y[N m]", "floor_torque_z[N m]"})
        EXPECT_SAYS(header, column);
    EXPECT_EQ(header.find("floor_torque[N m]"), std::string::npos);
    const std::size_t columns = static_cast<std::size_t>(std::count(header.begin(), header.end(), ',')) + 1;
    EXPECT_EQ(columns, 19U + 7U);
    EXPECT_SAYS(read("out/report.html"), "\"dimension\": 3");
}

TEST_F(Runs, StreamsCarryWhatWasAskedFor) {
    const Outcome usual = run_well({"run", "scene.toml", "--out", "a", "--steps", "5"});
    EXPECT_EQ(usual.out, "");
    EXPECT_SAYS(usual.err, "finished: 5 steps, 80 grains");
    EXPECT_SAYS(usual.err, "Results: a");
    const Outcome quiet = run_well({"run", "scene.toml", "--out", "b", "--steps", "5", "--quiet"});
    EXPECT_EQ(quiet.out + quiet.err, "");
    const Outcome dry = run_well({"run", "scene.toml", "--out", "c", "--dry-run"});
    EXPECT_SAYS(dry.out, "collision time");
    EXPECT_EQ(dry.err, "");
    EXPECT_FALSE(fs::exists(path("c")));
}

TEST_F(Runs, DefaultFolderIsNamedAfterTheScene) {
    run_well({"run", "scene.toml", "--steps", "5"});
    EXPECT_TRUE(fs::exists(path("results/scene/log.csv")));
    EXPECT_TRUE(fs::exists(path("results/scene/plan.txt")));
}

TEST_F(Runs, EffectiveSceneReproducesTheRun) {
    run_well({"run", "scene.toml", "--out", "a", "--set", "domain.gravity=[0, -1]", "--steps", "500"});
    run_well({"run", "a/scene.toml", "--out", "b", "--steps", "500"});
    expect_same_results("b", "a");
    run_well({"run", "scene.toml", "--out", "c", "--steps", "500"});
    EXPECT_NE(hash_of("c"), hash_of("a"));
}

TEST_F(Runs, StepsStopEarly) {
    const Outcome o = run_well({"run", "scene.toml", "--out", "out", "--steps", "137", "--json"});
    EXPECT_EQ(json::parse(o.out)["steps"], 137);
    EXPECT_EQ(latest_checkpoint("out"), "out/checkpoints/000000000137.checkpoint");
    EXPECT_EQ(
        json::parse(run_well({"run", "scene.toml", "--out", "none", "--steps", "0", "--json"}).out)["step"],
        0);
}

TEST_F(Runs, TitlesAreEscaped) {
    const std::string title = R"(He said \"a\\b\" \u0007 ü)";
    write("scene.toml", replaced(box_scene, "Box of glass", title));
    run_well({"run", "scene.toml", "--out", "out", "--steps", "10", "--bench-json", "bench.json"});
    const json d = json::parse(read("bench.json"))["benchmarks"][0];
    EXPECT_EQ(d["name"], "He said \"a\\b\" \a ü");
    EXPECT_EQ(d["iterations"], 10);
    EXPECT_EQ(d["time_unit"], "ns");
}

TEST_F(Runs, NoGrainsIsAValidScene) {
    write("scene.toml", replaced(box_scene, "counts = [10, 8]", "counts = [0, 8]"));
    const Outcome o = run_well({"run", "scene.toml", "--out", "out", "--json"});
    EXPECT_EQ(json::parse(o.out)["particles"], 0);
    EXPECT_TRUE(json::parse(run_well({"check", "scene.toml", "--json"}).out)["critical_dt"].is_null());
    run_well({"render", latest_checkpoint("out"), "a.png"});
    run_well({"compare", "scene.toml"});
}

TEST_F(Runs, ForcesAreCheckedOnTheWay) {
    const Outcome o =
        run_well({"run", "scene.toml", "--out", "a", "--steps", "2000", "--check-every", "500"});
    EXPECT_SAYS(o.err, "check at step 500: worst relative difference to the scalar reference 0\n");
    EXPECT_SAYS(o.err, "check at step 2000:");
    run_well({"run", "scene.toml", "--out", "b", "--steps", "2000"});
    expect_same_results("a", "b"); // looking changes nothing
}

// ---- interruptions

TEST_F(Runs, ResumedRunHasTheBitsOfTheUndisturbed) {
    run_well({"run", "scene.toml", "--out", "whole", "--quiet"});
    const std::string best(simd::isa_name(simd::available_isas().back()));
    run_well({"run", "scene.toml", "--out", "parts", "--steps", "7001", "--quiet"});
    run_well({"run", "--resume", latest_checkpoint("parts"), "--steps", "9000", "--threads", "2", "--isa",
              "scalar", "--quiet"});
    const Outcome o =
        run_well({"run", "--resume", latest_checkpoint("parts"), "--threads", "3", "--isa", best, "--json"});
    expect_same_results("parts", "whole");
    const json d = json::parse(o.out);
    EXPECT_GT(d["total_wall_seconds"], d["wall_seconds"]);
    EXPECT_EQ(static_cast<int>(d["step"]) - static_cast<int>(d["steps"]), 16001);
}

TEST_F(Runs, ResumedRunHasEveryFileOfTheUndisturbed) {
    const auto with_all = [](std::vector<std::string> arguments) {
        for (const char* set :
             {"output.trajectory=[\"dump\", \"xyz\", \"vtp\", \"book\"]", "output.report=true",
              "output.picture_every=0.02", "output.trajectory_every=0.02"})
            arguments.insert(arguments.end(), {"--set", set});
        arguments.emplace_back("--quiet");
        return arguments;
    };
    run_well(with_all({"run", "scene.toml", "--out", "whole"}));
    run_well(with_all({"run", "scene.toml", "--out", "parts", "--steps", "7001"}));
    const fs::path early = path(latest_checkpoint("parts")), kept = path("kept");
    fs::copy_file(early, kept);
    // Beyond the checkpoint and back to it: what came after is cut off.
    run_well({"run", "--resume", latest_checkpoint("parts"), "--steps", "9000", "--quiet"});
    fs::copy_file(kept, early, fs::copy_options::overwrite_existing);
    run_well({"run", "--resume", early.string(), "--quiet"});
    const auto whole = results("whole"), parts = results("parts");
    EXPECT_GT(whole.size(), 30U); // 11 pictures, 11 vtp frames of grains and one of walls, single files
    for (const auto& [name, content] : whole)
        EXPECT_TRUE(parts.contains(name) && parts.at(name) == content) << name;
    EXPECT_EQ(parts.size(), whole.size());
    EXPECT_GT(shown("whole").size(), 10'000U);
    EXPECT_TRUE(shown("parts") == shown("whole"));
}

TEST_F(Runs, ResumedAnalysesHaveTheBytesOfTheUndisturbed) {
    write("scene.toml", box_scene +
                            "[[analysis]]\nname = \"load\"\nkind = \"map\"\nevery = 0.01\nstart = 0.03\n"
                            "[[analysis]]\nname = \"fall\"\nkind = \"flow\"\nevery = 0.005\n"
                            "from = [0.08, 0.03]\nto = [0, 0.03]\n"
                            "[[analysis]]\nname = \"chains\"\nkind = \"force-chains\"\n");
    run_well({"run", "scene.toml", "--out", "whole", "--quiet"});
    run_well({"run", "scene.toml", "--out", "parts", "--steps", "7001", "--quiet"});
    run_well({"run", "--resume", latest_checkpoint("parts"), "--threads", "2", "--isa", "scalar", "--quiet"});
    for (const char* name : {"load.csv", "load-pressure.png", "load-chains.png", "load-outside.png",
                             "fall.csv", "chains.csv", "log.csv"})
        EXPECT_EQ(read(std::string("parts/") + name), read(std::string("whole/") + name)) << name;
}

class Interruptions : public Runs {
protected:
    Interruptions() {
        long_run_ = {"run", "scene.toml", "--set", "md.duration=1.2", "--quiet"};
        auto whole = long_run_;
        whole.insert(whole.end(), {"--out", "whole"});
        run_well(whole);
    }

    [[nodiscard]] Call broken_run() const {
        Call call{long_run_};
        call.arguments.insert(call.arguments.end(),
                              {"--out", "broken", "--set", "output.checkpoint_every=0.01"});
        return call;
    }
    void wait_for_rows(Process& process) const {
        while (process.running() &&
               (!fs::exists(path("broken/log.csv")) || fs::file_size(path("broken/log.csv")) < 2000))
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }

    std::vector<std::string> long_run_;
};

TEST_F(Interruptions, SignalsStopWithACheckpoint) {
    for (const int signal : {SIGINT, SIGTERM}) {
        fs::remove_all(path("broken"));
        Process process(folder(), broken_run());
        wait_for_rows(process);
        process.send(signal);
        const Outcome stopped = process.wait();
        ASSERT_EQ(stopped.code, code_of(Exit::stopped)) << stopped.err;
        EXPECT_EQ(summary("broken")["status"], "interrupted");
        run_well({"run", "--resume", latest_checkpoint("broken"), "--quiet"});
        expect_same_results("broken", "whole");
    }
}

TEST_F(Interruptions, WalltimeStopsWithACheckpoint) {
    Call call = broken_run();
    call.arguments.insert(call.arguments.end(), {"--walltime", "0.05"});
    Outcome o = run(call);
    ASSERT_EQ(o.code, code_of(Exit::stopped)) << o.err;
    EXPECT_EQ(summary("broken")["status"], "walltime");
    for (int n = 1; n < 100 && o.code == code_of(Exit::stopped); ++n)
        o = run({"run", "--resume", latest_checkpoint("broken"), "--quiet", "--walltime",
                 std::to_string(0.1 * n)});
    EXPECT_EQ(o.code, 0) << o.err;
    expect_same_results("broken", "whole");
}

// Killed at any moment: what is on the disk is enough to go on.
TEST_F(Interruptions, KilledRunsGoOn) {
    std::mt19937 random(1);
    std::uniform_int_distribution<int> milliseconds(5, 80);
    int killed = 0, patience = 1; // grows on machines too slow to reach the next checkpoint
    std::string checkpoint;
    for (bool finished = false; !finished && killed < 200;) {
        if (checkpoint.empty()) fs::remove_all(path("broken"));
        Process process(folder(),
                        checkpoint.empty() ? broken_run() : Call{{"run", "--resume", checkpoint, "--quiet"}});
        std::this_thread::sleep_for(std::chrono::milliseconds(patience * milliseconds(random)));
        process.send(SIGKILL);
        const Outcome o = process.wait();
        finished = o.code == 0;
        ASSERT_TRUE(finished || o.signal == SIGKILL) << o.err;
        const std::string latest = latest_checkpoint("broken");
        if (latest == checkpoint) patience *= 2;
        if (!finished) ++killed;
        checkpoint = latest;
    }
    EXPECT_GE(killed, 2);
    expect_same_results("broken", "whole");
}

} // namespace

} // namespace sandlane::test
