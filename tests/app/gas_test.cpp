// Gases through the program: run, compare, checkpoints, outputs, refusals.
#include "program.hpp"

#include <algorithm>

namespace sandlane::test {

namespace {

const std::string gas_scene = R"(title = "Gas"
method = "dsmc"

[domain]
dimension = 3
upper = [8, 8, 8]
periodic = ["x", "y"]

[gas]
particles = 4000
weight = 0.01
temperature = 1
restitution = 0.9

[[sides]]
side = "-z"
kind = "heated"
temperature = 1

[dsmc]
cells = [8, 8, 8]
dt = 0.1
duration = 20
)";

class Gas : public App {};

} // namespace

TEST_F(Gas, RunsAndLeavesItsFiles) {
    write("gas.toml", gas_scene);
    run_well({"run", "gas.toml", "--quiet"});
    for (const char* file : {"log.csv", "profile.csv", "distribution.csv", "plan.txt", "scene.toml",
                             "summary.json", "report.html"})
        EXPECT_TRUE(fs::exists(path("results/gas") / file)) << file;
    EXPECT_FALSE(fs::exists(path("results/gas/pictures"))); // for those who ask
    const auto summary = json_of(read("results/gas/summary.json"));
    EXPECT_GT(summary["collisions"].get<int>(), 1000);
    const std::string log = read("results/gas/log.csv");
    EXPECT_SAYS(log, "temperature[J],a2[1]");
    EXPECT_EQ(std::count(log.begin(), log.end(), '\n'), 202); // header, start, 200 rows
    const std::string profile = read("results/gas/profile.csv");
    EXPECT_SAYS(profile, "x[m],density[1/m^3]");
    EXPECT_EQ(std::count(profile.begin(), profile.end(), '\n'), 9);
    // The effective scene is a scene, of the same result.
    run_well({"run", "results/gas/scene.toml", "--out", "again", "--quiet"});
    EXPECT_EQ(json_of(read("again/summary.json"))["state_hash"], summary["state_hash"]);
}

// A gas that walls heat takes ever shorter steps, many more than were expected, and ends at its time.
TEST_F(Gas, AdaptiveRunsEndAtTheirTime) {
    write("gas.toml", gas_scene);
    run_well({"run", "gas.toml", "--quiet", "--set", "gas.temperature=1e-4", "--set", "gas.particles=400",
              "--set", "dsmc.adaptive=true", "--set", "output.report=false"});
    const std::string log = read("results/gas/log.csv");
    const std::string last = log.substr(log.rfind('\n', log.size() - 2) + 1);
    EXPECT_NEAR(std::stod(last), 20, 0.1); // the longest step
}

TEST_F(Gas, StructureOnDemand) {
    write("gas.toml", gas_scene);
    const std::vector<std::string> set = {"--set", "dsmc.structure_every=2"};
    run_well({"run", "gas.toml", "--quiet", "--out", "whole", set[0], set[1]});
    const std::string clusters = read("whole/clusters.csv");
    EXPECT_EQ(std::count(clusters.begin(), clusters.end(), '\n'), 12); // header, start, ten
    EXPECT_SAYS(read("whole/structure.csv"), "k[1/m],structure_factor[1]");
    EXPECT_SAYS(read("whole/cluster_sizes.csv"), "clusters[1]");
    const std::string report = read("whole/report.html");
    for (const char* caption : {"Structure factor S(k)", "largest cluster", "Mean density along x", "<svg"})
        EXPECT_SAYS(report, caption);
    run_well({"run", "gas.toml", "--quiet", "--out", "part", "--steps", "77", set[0], set[1]});
    run_well({"run", "--resume", latest_checkpoint("part"), "--quiet"});
    for (const char* file : {"clusters.csv", "structure.csv", "cluster_sizes.csv"})
        EXPECT_EQ(read(std::string("part/") + file), read(std::string("whole/") + file)) << file;
}

TEST_F(Gas, PicturesAndTrajectoriesOnDemand) {
    write("gas.toml", gas_scene);
    run_well({"run", "gas.toml", "--quiet", "--set", "output.picture_every=10", "--set",
              "output.trajectory_every=10", "--set", "output.picture_width=64", "--set",
              "output.movie=false"});
    EXPECT_TRUE(fs::exists(path("results/gas/pictures/000000.png")));
    EXPECT_TRUE(fs::exists(path("results/gas/trajectory.dump")));
    run_well({"render", latest_checkpoint("results/gas"), "end.png"});
    EXPECT_TRUE(fs::exists(path("end.png")));
}

TEST_F(Gas, ComparesBitForBit) {
    write("gas.toml", gas_scene);
    for (const char* change : {"seed=2", "gas.tangential_restitution=0.3", "gas.model=saturating",
                               "dsmc.adaptive=true", "dsmc.heating=0.01", "dsmc.scheme=direction-first",
                               "dsmc.scheme=maxwell", "domain.shear_rate=0.1", "domain.gravity=[0,0,-0.1]"}) {
        const Outcome o = run_well({"compare", "gas.toml", "--steps", "20", "--set", change});
        EXPECT_SAYS(o.out, "identical, bit for bit");
        EXPECT_SAYS(o.out, "velocity z");
        EXPECT_SAYS(o.out, "of them, the same");
    }
}

TEST_F(Gas, WhatAShearedBoxCannotHave) {
    write("gas.toml", gas_scene);
    for (const char* change : {"dsmc.scheme=maxwell", "dsmc.structure_every=1"}) {
        const Outcome o = run({"run", "gas.toml", "--set", "domain.shear_rate=0.1", "--set", change});
        EXPECT_EQ(o.code, code_of(Exit::invalid_input)) << change;
        EXPECT_SAYS(o.err, "domain.shear_rate");
    }
}

// Kinds of particles: temperatures of each, the same bits, a checkpoint.
TEST_F(Gas, Mixtures) {
    const std::string more = "[[species]]\nparticles = 2000\nmass = 3\ndiameter = 1.5\n\n[[gas_pairs]]\n"
                             "between = [1, 0]\nrestitution = 0.6\n\n[dsmc]";
    write("gas.toml", replaced(gas_scene, "[dsmc]", more));
    EXPECT_SAYS(run_well({"check", "gas.toml"}).out, "6000 of 2 kinds");
    EXPECT_SAYS(run_well({"compare", "gas.toml", "--steps", "20", "--set", "dsmc.enskog=true"}).out,
                "identical, bit for bit");
    run_well({"run", "gas.toml", "--quiet", "--out", "whole"});
    EXPECT_SAYS(read("whole/log.csv"), "temperature_0[J],temperature_1[J]");
    run_well({"run", "gas.toml", "--quiet", "--out", "part", "--steps", "77"});
    run_well({"run", "--resume", latest_checkpoint("part"), "--quiet"});
    EXPECT_EQ(read("part/log.csv"), read("whole/log.csv"));
    const auto refused = [&](const std::string& pairs, const char* says) {
        write("bad.toml", replaced(gas_scene, "[dsmc]", pairs + "\n[dsmc]"));
        const Outcome o = run({"check", "bad.toml"});
        EXPECT_EQ(o.code, code_of(Exit::invalid_input)) << pairs;
        EXPECT_SAYS(o.err, says);
    };
    refused("[[gas_pairs]]\nbetween = [0, 1]\nrestitution = 0.6", "kind 1; allowed: 0 to 0");
    refused("[[gas_pairs]]\nbetween = [0]", "[kind, kind]");
    refused("[[gas_pairs]]\nbetween = [0, 0]\ndissipation = 1", "not viscoelastic");
    refused("[[gas_pairs]]\nbetween = [0, 0]\n[[gas_pairs]]\nbetween = [0, 0]", "the same pair");
    refused("[[gas_pairs]]\nbetween = [0, 0]\nrestitution = 0.6", "there is one kind of particles");
    std::string many;
    for (int n = 0; n < 16; ++n) many += "[[species]]\nparticles = 1\n";
    refused(many, "up to 15");
}

TEST_F(Gas, GoesOnAfterACheckpoint) {
    for (const char* adaptive : {"false", "true"}) {
        write("gas.toml", gas_scene);
        const std::string set = std::string("dsmc.adaptive=") + adaptive;
        run_well({"run", "gas.toml", "--quiet", "--out", "whole", "--set", set, "--threads", "2"});
        run_well({"run", "gas.toml", "--quiet", "--out", "part", "--set", set, "--steps", "77"});
        run_well({"run", "--resume", latest_checkpoint("part"), "--quiet"});
        for (const char* file : {"log.csv", "profile.csv", "distribution.csv"})
            EXPECT_EQ(read(std::string("part/") + file), read(std::string("whole/") + file))
                << file << adaptive;
        EXPECT_EQ(json_of(read("part/summary.json"))["state_hash"],
                  json_of(read("whole/summary.json"))["state_hash"]);
        fs::remove_all(path("part"));
        fs::remove_all(path("whole"));
    }
}

TEST_F(Gas, ChecksAndWarns) {
    write("gas.toml", gas_scene);
    const Outcome o = run_well({"check", "gas.toml"});
    for (const char* part : {"mean free path", "cells                     8 x 8 x 8", "Skipped", "spins"})
        EXPECT_SAYS(o.out, part);
    const Outcome coarse =
        run_well({"check", "gas.toml", "--set", "dsmc.cells=[1, 1, 2]", "--set", "dsmc.dt=2"});
    for (const char* part :
         {"longer than a third of the mean free path", "above 0.2: use dt <=", "more than half of one"})
        EXPECT_SAYS(coarse.out, part);
    const auto json = json_of(run_well({"check", "gas.toml", "--json"}).out);
    EXPECT_EQ(json["particles"], 4000);
}

TEST_F(Gas, Refuses) {
    struct Bad {
        std::string piece, by;
        std::vector<std::string> says;
    };
    const Bad bads[] = {
        {"restitution = 0.9", "restitution = 1.1", {"gas.restitution", "1.1", "0 to 1"}},
        {"restitution = 0.9", "restitution = -0.1", {"gas.restitution", "-0.1"}},
        {"temperature = 1\nrest", "temperature = 0\nrest", {"gas.temperature", "above 0"}},
        {"kind = \"heated\"\ntemperature = 1", "kind = \"heated\"", {"sides[0].temperature = 0", "above 0"}},
        {"kind = \"heated\"\ntemperature = 1",
         "kind = \"heated\"\ntemperature = -1",
         {"sides[0].temperature", "-1"}},
        {"side = \"-z\"", "side = \"-x\"", {"sides[0].side = \"-x\"", "periodic"}},
        {"weight = 0.01", "weight = 1", {"packing fraction is 4.091", "up to 0.49"}},
        {"cells = [8, 8, 8]", "cells = [8, 8]", {"dsmc.cells", "[columns, rows, layers]"}},
        {"cells = [8, 8, 8]", "cells = [8, 8, -1]", {"dsmc.cells", "-1"}},
        {"cells = [8, 8, 8]", "cells = [10000, 10000, 10000]", {"dsmc.cells", "1e9"}},
        {"particles = 4000", "particles = 0", {"gas.particles", "0"}},
        {"[gas]", "[md]\ndt = 1\n[gas]", {"md", "is not read by method = \"dsmc\""}},
        {"upper = [8, 8, 8]", "upper = [8, 8, 0]", {"domain", "[8, 8, 0] must lie above lower"}},
        {"dt = 0.1", "dt = -0.1", {"dsmc.dt", "-0.1"}},
        {"restitution = 0.9", "friction = 0.9", {"gas.friction", "smooth"}},
        {"periodic = [\"x\", \"y\"]",
         "periodic = [\"x\"]\nshear_rate = 1",
         {"domain.shear_rate", "needs periodic"}},

        {"restitution = 0.9", "model = \"viscoelastic\"", {"gas.dissipation", "needs it"}},
        {"duration = 20", "duration = 20\nadaptive = true\nheating = 1", {"dsmc.adaptive", "heat"}},
        {"temperature = 1\n\n[dsmc]",
         "temperature = 1\nphase = 1\n\n[dsmc]",
         {"sides[0].phase", "oscillate"}},
        {"temperature = 1\n\n[dsmc]", "temperature = 1\namplitude = 1\n\n[dsmc]", {"sides[0]", "frequency"}},
    };
    for (const Bad& bad : bads) {
        write("gas.toml", replaced(gas_scene, bad.piece, bad.by));
        const Outcome o = run({"run", "gas.toml", "--out", "new/out"});
        EXPECT_EQ(o.code, code_of(Exit::invalid_input)) << bad.by << o.err;
        for (const std::string& part : bad.says) EXPECT_SAYS(o.err, part);
        EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
        EXPECT_FALSE(fs::exists(path("new")));
    }
}

// A state of another scene is an error of the file, not a crash.
TEST_F(Gas, RefusesTheCheckpointOfAnotherScene) {
    write("gas.toml", gas_scene);
    run_well({"run", "gas.toml", "--quiet", "--steps", "5"});
    const Outcome o = run(
        {"run", "--resume", latest_checkpoint("results/gas"), "--out", "new", "--set", "gas.particles=50"});
    EXPECT_EQ(o.code, code_of(Exit::io)) << o.err;
    EXPECT_SAYS(o.err, "another scene");
    for (const char* key : {"dsmc.dt=0.05", "dsmc.cells=[4, 8, 16]", "domain.upper=[8, 8, 9]"})
        EXPECT_EQ(
            run({"run", "--resume", latest_checkpoint("results/gas"), "--out", "new", "--set", key}).code,
            code_of(Exit::io))
            << key;
}

// Collisions without end: an error in words, with the last checkpoint.
TEST_F(Gas, TellsWhenAStepIsFarTooLong) {
    write("gas.toml", gas_scene);
    const Outcome o =
        run({"run", "gas.toml", "--quiet", "--set", "dsmc.dt=1e9", "--set", "dsmc.duration=1e10"});
    EXPECT_EQ(o.code, code_of(Exit::unstable)) << o.err;
    EXPECT_SAYS(o.err, "smaller time step");
}

} // namespace sandlane::test
