// Faults of the surroundings: outputs that cannot be written, damaged checkpoints, runs that become unstable.
#include "program.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace sandlane::test {

using nlohmann::json;

namespace {

class Faults : public App {
protected:
    Faults() { write("scene.toml", box_scene); }

    [[nodiscard]] Outcome limited_run(rlim_t largest_file, std::vector<std::string> arguments) const {
        Call call{std::move(arguments)};
        call.largest_file = largest_file;
        return run(call);
    }
    [[nodiscard]] bool leaves_temporary_files() const {
        const auto names = listing();
        return std::any_of(names.begin(), names.end(),
                           [](const std::string& name) { return name.ends_with(".tmp"); });
    }
};

// ---- output folders

TEST_F(Faults, OutputFolderIsAFile) {
    write("out", "a letter\n");
    const auto before = listing();
    const Outcome o = run({"run", "scene.toml", "--out", "out"});
    EXPECT_EQ(o.code, code_of(Exit::io));
    EXPECT_SAYS(o.err, "out: cannot create the folder: Not a directory");
    const Outcome below = run({"run", "scene.toml", "--out", "out/deeper"});
    EXPECT_EQ(below.code, code_of(Exit::io));
    EXPECT_SAYS(below.err, "out/deeper: cannot create the folder");
    EXPECT_EQ(listing(), before);
    EXPECT_EQ(read("out"), "a letter\n");
}

TEST_F(Faults, UnwritableFolder) {
    fs::create_directory(path("closed"));
    fs::permissions(path("closed"), fs::perms::owner_read | fs::perms::owner_exec);
    for (const char* out : {"closed", "closed/out"}) {
        Call call{{"run", "scene.toml", "--out", out}};
        call.everywhere = false;
        const Outcome o = run(call);
        EXPECT_EQ(o.code, code_of(Exit::io));
        EXPECT_SAYS(o.err, "Permission denied");
    }
    EXPECT_TRUE(fs::is_empty(path("closed")));
}

TEST_F(Faults, SecondRunIntoOneFolder) {
    run_well({"run", "scene.toml", "--out", "out", "--steps", "10"});
    const auto before = listing();
    const std::string log = read("out/log.csv");
    const Outcome o = run({"run", "scene.toml", "--out", "out", "--steps", "20"});
    EXPECT_EQ(o.code, code_of(Exit::invalid_input));
    EXPECT_SAYS(o.err, "out: already holds a run");
    EXPECT_SAYS(o.err, "Choose another folder with --out");
    EXPECT_EQ(listing(), before);
    EXPECT_EQ(read("out/log.csv"), log);
}

TEST_F(Faults, TwoRunsAtOnce) {
    Process first(folder(), {{"run", "scene.toml", "--out", "out", "--set", "md.duration=1000", "--quiet"}});
    while (first.running() && !fs::exists(path("out/log.csv"))) {
    }
    const Outcome second = run({"run", "scene.toml", "--out", "out"});
    EXPECT_EQ(second.code, code_of(Exit::invalid_input));
    EXPECT_SAYS(second.err, "is writing a run here");
    first.send(SIGTERM);
    EXPECT_EQ(first.wait().code, code_of(Exit::stopped));
}

TEST_F(Faults, FreshFolderGoesWithAFailedStart) {
    const auto before = listing();
    const Outcome o = limited_run(0, {"run", "scene.toml", "--out", "deep/new/out"});
    EXPECT_EQ(o.code, code_of(Exit::io)) << o.err;
    EXPECT_SAYS(o.err, "deep/new/out/");
    EXPECT_SAYS(o.err, "cannot write: File too large");
    EXPECT_EQ(listing(), before);
    fs::create_directory(path("mine"));
    EXPECT_EQ(limited_run(100, {"run", "scene.toml", "--out", "mine"}).code, code_of(Exit::io));
    run_well({"run", "scene.toml", "--out", "mine", "--steps", "1"}); // nothing keeps the second attempt out
}

// ---- writes that fail

// Whatever write meets the limit first: it is named, and what was written before is whole.
TEST_F(Faults, EveryFullDiskIsAnErrorThatNamesItsFile) {
    const std::vector<std::string> arguments = {"run", "scene.toml", "--set",
                                                "output.checkpoint_every=0.005"};
    auto with_out = [&](const char* out) {
        auto a = arguments;
        a.insert(a.end(), {"--out", out, "--json", "--quiet"});
        return a;
    };
    const json hash = json::parse(run_well(with_out("whole")).out)["state_hash"];
    int resumed = 0;
    for (const rlim_t size : {200U, 1500U, 6000U, 20000U, 60000U, 150000U, 500000U, 1000000U}) {
        fs::remove_all(path("out"));
        const Outcome o = limited_run(size, with_out("out"));
        ASSERT_EQ(o.code, code_of(Exit::io)) << size << o.err;
        EXPECT_SAYS(o.err, "out/");
        EXPECT_SAYS(o.err, "File too large");
        EXPECT_FALSE(leaves_temporary_files()) << size;
        const std::string checkpoint = latest_checkpoint("out");
        if (checkpoint.empty()) continue;
        EXPECT_SAYS(o.err, "Last good checkpoint: " + checkpoint);
        const Outcome again = run_well({"run", "--resume", checkpoint, "--json", "--quiet"});
        EXPECT_EQ(json::parse(again.out)["state_hash"], hash) << size;
        EXPECT_EQ(read("out/log.csv"), read("whole/log.csv")) << size;
        EXPECT_EQ(read("out/trajectory.dump"), read("whole/trajectory.dump")) << size;
        ++resumed;
    }
    EXPECT_GE(resumed, 3);
}

TEST_F(Faults, OutputsOfOtherCommands) {
    run_well({"run", "scene.toml", "--out", "out", "--steps", "10", "--quiet"});
    const std::string checkpoint = latest_checkpoint("out");
    const auto before = listing();
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"render", checkpoint, "no/picture.png"},
          {"convert", checkpoint, "no/init.book"},
          {"convert", checkpoint, "/dev/full"},
          {"render", checkpoint, "/dev/full"}}) {
        const Outcome o = run(arguments);
        EXPECT_EQ(o.code, code_of(Exit::io)) << o.err;
        EXPECT_SAYS(o.err, arguments.back() + ": cannot ");
    }
    EXPECT_EQ(limited_run(100, {"render", checkpoint, "picture.png"}).code, code_of(Exit::io));
    EXPECT_EQ(listing(), before);
    EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST_F(Faults, FullStandardStreams) {
    const auto to = [&](std::vector<std::string> arguments, const char* out, const char* err) {
        Call call{std::move(arguments)};
        call.out = out;
        call.err = err;
        return run(call);
    };
    for (const char* command : {"check", "compare"}) {
        const Outcome o = to({command, "scene.toml"}, "/dev/full", "");
        EXPECT_EQ(o.code, code_of(Exit::io));
        EXPECT_SAYS(o.err, "standard output");
        EXPECT_SAYS(o.err, "No space left on device");
    }
    // Messages that nobody can read are no reason to lose the run, nor to change the exit code.
    EXPECT_EQ(to({"run", "scene.toml", "--out", "out", "--steps", "10"}, "", "/dev/full").code, 0);
    EXPECT_EQ(to({"run", "no.toml"}, "", "/dev/full").code, code_of(Exit::invalid_input));
}

// ---- checkpoints

class Checkpoints : public Faults {
protected:
    Checkpoints() {
        run_well({"run", "scene.toml", "--out", "out", "--steps", "100", "--quiet"});
        good_ = read("out/checkpoints/000000000100.checkpoint");
    }

    void expect_damaged(const std::string& bytes, const std::string& says) {
        write("bad.checkpoint", bytes);
        const auto before = listing();
        for (const std::vector<std::string>& arguments :
             {std::vector<std::string>{"run", "--resume", "bad.checkpoint", "--out", "new"},
              {"render", "bad.checkpoint", "a.png"},
              {"convert", "bad.checkpoint", "a.toml"}}) {
            const Outcome o = run(arguments);
            EXPECT_EQ(o.code, code_of(Exit::io)) << o.err;
            EXPECT_SAYS(o.err, "bad.checkpoint: not a usable checkpoint: " + says);
            EXPECT_SAYS(o.err, "Take an older one");
        }
        EXPECT_EQ(listing(), before);
    }

    std::string good_;
};

TEST_F(Checkpoints, Truncated) {
    for (const std::size_t size : {std::size_t{1}, std::size_t{30}, good_.size() / 2, good_.size() - 1})
        expect_damaged(good_.substr(0, size), "it ");
    expect_damaged("", "it does not start like one");
    expect_damaged(good_ + "x", "it is truncated or has bytes too many");
}

TEST_F(Checkpoints, Damaged) {
    for (const std::size_t at : {std::size_t{40}, good_.size() / 2, good_.size() - 1}) {
        std::string bytes = good_;
        bytes[at] = static_cast<char>(bytes[at] ^ 0x10);
        expect_damaged(bytes, "its checksum does not match");
    }
}

TEST_F(Checkpoints, OfAnotherVersion) {
    std::string bytes = good_;
    bytes[8] = 99;
    expect_damaged(bytes, "it was written by another version");
}

TEST_F(Checkpoints, SomethingElse) {
    expect_damaged(box_scene, "it does not start like one");
}

TEST_F(Checkpoints, OfAnotherSceneAfterOverrides) {
    const auto before = listing();
    const auto resumed = [&](const std::string& change) {
        const Outcome o = run(
            {"run", "--resume", "out/checkpoints/000000000100.checkpoint", "--out", "new", "--set", change});
        EXPECT_EQ(listing(), before) << change;
        EXPECT_TRUE(o.code == code_of(Exit::io) || o.code == code_of(Exit::invalid_input)) << o.err;
        return o.err;
    };
    EXPECT_SAYS(resumed("md.dt=1e-6"), "its state does not belong to its scene");
    EXPECT_SAYS(resumed("md.integrator=gear6"), "Overrides by --set must keep");
    EXPECT_SAYS(resumed("grains.0.radius=\"1 mm\""), "its grains are not those that its scene describes now");
    EXPECT_SAYS(resumed("md.duratoin=1"), "did you mean \"duration\"?");
}

TEST_F(Checkpoints, LiesOutsideARun) {
    fs::copy_file(path("out/checkpoints/000000000100.checkpoint"), path("a.checkpoint"));
    const Outcome o = run({"run", "--resume", "a.checkpoint"});
    EXPECT_EQ(o.code, code_of(Exit::invalid_input));
    EXPECT_SAYS(o.err, "--resume a.checkpoint: does not lie in the folder");
    EXPECT_SAYS(o.err, "give --out FOLDER");
    run_well({"run", "--resume", "a.checkpoint", "--out", "new", "--steps", "10"});
}

TEST_F(Checkpoints, WithoutTheFilesOfItsRun) {
    fs::remove(path("out/log.csv"));
    const Outcome o = run({"run", "--resume", "out/checkpoints/000000000100.checkpoint"});
    EXPECT_EQ(o.code, code_of(Exit::io));
    EXPECT_SAYS(o.err, "out/log.csv: is shorter than the checkpoint says");
}

TEST_F(Checkpoints, WithAnotherFileOfGrains) {
    write("grains.csv", "x,y,radius\n0.02,0.02,0.002\n0.03,0.03,0.002\n");
    const std::string no_lattice = replaced(box_scene, "lower = [\"10 mm\", \"10 mm\"]\n", "");
    write("file.toml", replaced(no_lattice, "kind = \"lattice\"", "kind = \"file\"\nfile = \"grains.csv\""));
    run_well({"run", "file.toml", "--out", "file", "--steps", "10"});
    const std::string checkpoint = latest_checkpoint("file");
    run_well({"run", "--resume", checkpoint, "--out", "same", "--steps", "10"});
    write("grains.csv", "x,y,radius\n0.02,0.02,0.002\n0.03,0.03,0.0021\n");
    const Outcome o = run({"run", "--resume", checkpoint, "--out", "other"});
    EXPECT_EQ(o.code, code_of(Exit::io));
    EXPECT_SAYS(o.err, "a file of grains has changed");
}

// ---- runs that fail on the way

TEST_F(Faults, UnstableRunKeepsWhatItHas) {
    // 3 m/s^2 more every second sidewards, until the grains leave through the open side.
    const std::string open =
        replaced(replaced(box_scene, "gravity = [0, -9.81]", "gravity = [100, 0]\noutside = \"error\""),
                 "closed = true\n", "");
    write("open.toml", replaced(open, "[0.005, 0.005], [0.075, 0.005], [0.075, 0.075], [0.005, 0.075]",
                                "[0.005, 0.075], [0.005, 0.005], [0.07, 0.005]"));
    const std::vector<std::string> arguments = {"run", "open.toml", "--out", "out", "--quiet"};
    const Outcome bare = run(arguments);
    EXPECT_EQ(bare.code, code_of(Exit::unstable)) << bare.err;
    EXPECT_SAYS(bare.err, "left the domain at");
    EXPECT_SAYS(bare.err,
                "Results so far: out. There is no checkpoint; output.checkpoint_every asks for some.");
    fs::remove_all(path("out"));
    auto with_checkpoints = arguments;
    with_checkpoints.insert(with_checkpoints.end(), {"--set", "output.checkpoint_every=0.002"});
    const Outcome o = run(with_checkpoints);
    EXPECT_EQ(o.code, code_of(Exit::unstable));
    const std::string checkpoint = latest_checkpoint("out");
    ASSERT_NE(checkpoint, "") << o.err;
    EXPECT_SAYS(o.err, "Last good checkpoint: " + checkpoint);
    EXPECT_GT(read("out/log.csv").size(), 200U);
    EXPECT_TRUE(fs::exists(path("out/pictures/000000.png")));
    run_well({"render", checkpoint, "last.png"});
}

} // namespace

} // namespace sandlane::test
