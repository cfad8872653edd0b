// What must hold whatever the engine: a run that was killed, or whose disk was full, goes on to the bits and
// files of the undisturbed one; checkpoints of other runs are refused. tools/bench faults does the same for
// longer.
#include "program.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <ostream>
#include <random>
#include <thread>

namespace sandlane::test {

namespace {

const std::string outputs = "[output]\npicture_width = 64\nmovie = false\nreport = false\n";

struct EngineCase {
    const char* name;
    std::string scene, checkpoints; // and how often it writes some
    friend void PrintTo(const EngineCase& c, std::ostream* stream) { *stream << c.name; }
};

// A function: scenes of other files are not there before main().
const std::vector<EngineCase>& engines() {
    static const std::vector<EngineCase> all = {
        {"md",
         replaced(replaced(cube_scene, "duration = \"2 ms\"\n",
                           "duration = \"40 ms\"\ntangential = \"cundall-strack\"\n"),
                  "friction = 0.5\n", "friction = 0.5\ntangential_stiffness = 1e4\n") +
             "[[analysis]]\nname = \"load\"\nkind = \"profile\"\nevery = 0.001\n",
         "0.0004"},
        {"edmd",
         "method = \"edmd\"\n[domain]\nupper = [40, 40]\nperiodic = [\"x\", \"y\"]\n[gas]\nparticles = 600\n"
         "temperature = 1\nrestitution = 0.95\n[edmd]\nduration = 50\nstructure_every = 10\n" +
             outputs + "picture_every = 50\ntrajectory_every = 30\n",
         "1"},
        {"dsmc",
         "method = \"dsmc\"\n[domain]\ndimension = 3\nupper = [10, 10, 10]\nperiodic = [\"x\", \"y\", "
         "\"z\"]\n[gas]\n"
         "particles = 3000\ndiameter = 0.3\ntemperature = 1\nrestitution = 0.9\n[dsmc]\nadaptive = true\n"
         "duration = 250\n" +
             outputs + "trajectory_every = 100\n",
         "2"},
        {"pipe",
         "method = \"pipe-flow\"\n[pipe_flow]\nlength = 500\nwidth = 21\ndissipation = 0.1\ngravity = 0.5\n"
         "roughness = 0.5\nsteps = 15000\n" +
             outputs + "picture_every = 5000\n",
         "200"},
        {"sandpile",
         "method = \"sandpile\"\n[sandpile]\ncolumns = 60\nrows = 60\ndrive = \"random\"\nsteps = 60000\n" +
             outputs + "picture_every = 5000\n",
         "200"},
    };
    return all;
}

class EveryEngine : public App, public testing::WithParamInterface<EngineCase> {
protected:
    EveryEngine() {
        write("scene.toml", GetParam().scene);
        run_well({"run", "scene.toml", "--out", "whole", "--quiet"});
    }

    [[nodiscard]] Call start(const std::string& checkpoint) const {
        if (!checkpoint.empty()) return {{"run", "--resume", checkpoint, "--quiet"}};
        fs::remove_all(path("out"));
        return {{"run", "scene.toml", "--out", "out", "--quiet", "--set",
                 "output.checkpoint_every=" + GetParam().checkpoints}};
    }
    void expect_whole() const {
        EXPECT_EQ(json_of(read("out/summary.json"))["state_hash"],
                  json_of(read("whole/summary.json"))["state_hash"]);
        // The intervals of checkpoints differ.
        auto found = results("out"), expected = results("whole");
        for (auto* files : {&found, &expected}) files->erase("scene.toml");
        for (const auto& [name, content] : expected) EXPECT_TRUE(found[name] == content) << name;
        EXPECT_EQ(found.size(), expected.size());
    }
};

INSTANTIATE_TEST_SUITE_P(All, EveryEngine, testing::ValuesIn(engines()),
                         [](const auto& instance) { return instance.param.name; });

// Four times, after moments that depend on how fast this machine is; longer ones where it got nowhere.
TEST_P(EveryEngine, KilledRunsGoOn) {
    const double whole = json_of(read("whole/summary.json"))["wall_seconds"];
    std::mt19937 random(7);
    std::uniform_real_distribution<double> part(0.15, 0.45);
    std::string checkpoint;
    int killed = 0;
    double patience = whole;
    while (killed < 4) {
        Process process(folder(), start(checkpoint));
        std::this_thread::sleep_for(std::chrono::duration<double>(patience * part(random)));
        process.send(SIGKILL);
        const Outcome o = process.wait();
        if (o.code == 0) break;
        ASSERT_EQ(o.signal, SIGKILL) << o.err;
        const std::string latest = latest_checkpoint("out");
        if (latest == checkpoint) patience *= 2;
        checkpoint = latest;
        ++killed;
    }
    EXPECT_GE(killed, 1);
    const Outcome o = run(start(checkpoint));
    EXPECT_EQ(o.code, 0) << o.err;
    expect_whole();
}

// The disk is full just before the end of one file or another.
TEST_P(EveryEngine, FullDisksAreErrorsAndRunsGoOn) {
    std::set<std::uintmax_t> sizes = {0, 100};
    for (const auto& [name, content] : results("whole"))
        if (content.size() > 1) sizes.insert(content.size() - 1);
    int resumed = 0;
    std::size_t number = 0;
    for (const std::uintmax_t size : sizes) {
        if (number++ % (1 + sizes.size() / 8) != 0) continue; // of many, some
        Call call = start("");
        call.largest_file = size;
        const Outcome o = run(call);
        if (o.code == 0) continue; // a file that is larger on the way than in the end
        ASSERT_EQ(o.code, code_of(Exit::io)) << size << o.err;
        EXPECT_SAYS(o.err, "File too large");
        for (const std::string& name : listing()) EXPECT_FALSE(name.ends_with(".tmp")) << name;
        const std::string checkpoint = fs::exists(path("out")) ? latest_checkpoint("out") : "";
        if (checkpoint.empty() || resumed >= 2) continue;
        run_well({"run", "--resume", checkpoint, "--quiet"});
        expect_whole();
        ++resumed;
    }
}

// A checkpoint that lies in the folder of another run: of another engine, or of another seed.
TEST_P(EveryEngine, CheckpointsOfOtherRunsAreRefused) {
    const auto self = std::find_if(engines().begin(), engines().end(), [](const EngineCase& c) {
        return std::string(c.name) == GetParam().name;
    });
    const EngineCase& next = self + 1 == engines().end() ? engines().front() : self[1];
    write("other.toml", next.scene);
    run_well({"run", "other.toml", "--out", "other", "--steps", "50", "--quiet"});
    run_well({"run", "scene.toml", "--out", "seed", "--steps", "50", "--quiet", "--set", "seed=77"});
    const auto before = results("whole");
    for (const char* from : {"other", "seed"}) {
        const fs::path swapped = path("whole/checkpoints/999999999999.checkpoint");
        fs::copy_file(path(latest_checkpoint(from)), swapped);
        const Outcome o = run({"run", "--resume", swapped.string(), "--quiet"});
        EXPECT_EQ(o.code, code_of(Exit::io)) << from << o.err;
        EXPECT_SAYS(o.err, "whole: holds a run of another scene than the checkpoint does");
        fs::remove(swapped);
        EXPECT_TRUE(results("whole") == before) << from;
    }
}

} // namespace

} // namespace sandlane::test
