// Runs that watch their own error, and the error that a scene asks for, through the program.
#include "program.hpp"

#include <fmt/format.h>

#include <ostream>

namespace sandlane::test {

namespace {

class WatchedRuns : public App {
protected:
    // The box of glass with a table [watch].
    void watch(const std::string& limits) const { write("scene.toml", box_scene + "\n[watch]\n" + limits); }
};

TEST_F(WatchedRuns, AreLoggedAndSummedUp) {
    watch("largest_overlap = [0, 0]\nenergy_residual = [0, 0]\nmomentum_error = [0, 0]\n"
          "step_error = [0, 0]\n");
    const Outcome o =
        run_well({"run", "scene.toml", "--out", "out", "--json", "--set", "output.report=true"});
    const nlohmann::json watch = json_of(o.out)["watch"];
    EXPECT_EQ(watch, json_of(read("out/summary.json"))["watch"]);
    for (const char* key : {"largest_overlap", "energy_residual", "momentum_error", "step_error"}) {
        EXPECT_GT(watch[key]["largest"], 0) << key;
        EXPECT_LT(watch[key]["largest"], 0.05) << key;
        EXPECT_LE(watch[key]["time"], 0.2) << key;
    }
    EXPECT_SAYS(read("out/log.csv"), "overlap_peak[1],energy_residual[1],momentum_error[1],step_error[1]");
    EXPECT_SAYS(read("out/report.html"), "Largest residual of the energy balance");
    // Not of a scene that asks for nothing.
    write("scene.toml", box_scene);
    EXPECT_FALSE(json_of(run_well({"run", "scene.toml", "--out", "plain", "--json"}).out).contains("watch"));
    EXPECT_EQ(read("plain/log.csv").find("residual"), std::string::npos);
}

TEST_F(WatchedRuns, WarnOnceAndStop) {
    watch("step_error = [1e-9, 0]\n");
    const Outcome warned = run_well({"run", "scene.toml", "--out", "warned"});
    const std::string first = "above 1e-09 of watch.step_error; the largest, ";
    EXPECT_SAYS(warned.err, first);
    EXPECT_EQ(warned.err.find(first), warned.err.rfind(first));
    watch("energy_residual = [0, 1e-12]\n");
    const Outcome stopped = run({"run", "scene.toml", "--out", "stopped"});
    EXPECT_EQ(stopped.code, code_of(Exit::unstable));
    for (const char* part : {"step ", ", t = ", "the residual of the energy balance is ",
                             ", above 1e-12 of watch.energy_residual", "the fastest grain is ",
                             "Lower the time step", "Results so far: stopped"})
        EXPECT_SAYS(stopped.err, part);
    EXPECT_SAYS(read("stopped/log.csv"), "energy_residual[1]");
    watch("largest_overlap = [0, 1e-4]\n");
    EXPECT_EQ(run({"run", "scene.toml", "--out", "overlap"}).code, code_of(Exit::unstable));
}

TEST_F(WatchedRuns, TheCheckSaysWhatWasChosenAndWhy) {
    write("scene.toml", box_scene);
    const auto with = [](const char* command, std::vector<std::string> more) {
        std::vector<std::string> all = {command, "scene.toml", "--set", "md.accuracy=2e-3"};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    };
    const std::string text = run_well(with("check", {})).out;
    EXPECT_SAYS(text, "accuracy: 0.002 asked for; cheapest: ");
    EXPECT_SAYS(text, "accuracy: not ");
    const nlohmann::json plan = json_of(run_well(with("check", {"--json"})).out);
    EXPECT_LE(plan["accuracy"]["error"], 2e-3);
    const auto done = json_of(run_well(with("run", {"--out", "out", "--json", "--steps", "300"})).out);
    EXPECT_EQ(done["plan"]["dt"], plan["dt"]);
    EXPECT_EQ(done["plan"]["order"], plan["order"]);
    // The effective scene asks for the same, and a checkpoint goes on.
    EXPECT_SAYS(read("out/scene.toml"), "accuracy = 0.002");
    EXPECT_EQ(json_of(run_well({"check", "out/scene.toml", "--json"}).out)["dt"], plan["dt"]);
    run_well({"run", "--resume", latest_checkpoint("out"), "--out", "more", "--steps", "10"});
}

// An elastic gas: what is kept, is kept to rounding.
TEST_F(WatchedRuns, GasesKeepEnergyAndMomentum) {
    const std::string gas = "[domain]\nupper = [20, 20]\nperiodic = [\"x\", \"y\"]\n[gas]\nparticles = 200\n"
                            "temperature = 1\nmass = 1\ndiameter = 0.5\nrestitution = 1\n"
                            "[watch]\nenergy_residual = [0, 1e-9]\nmomentum_error = [0, 1e-9]\n";
    write("edmd.toml", "method = \"edmd\"\n" + gas + "largest_overlap = [0, 1e-9]\n[edmd]\nduration = 20\n");
    write("dsmc.toml", "method = \"dsmc\"\n" + gas + "[dsmc]\nduration = 20\n");
    for (const std::string method : {"edmd", "dsmc"}) {
        const auto watch =
            json_of(run_well({"run", method + ".toml", "--out", method, "--json"}).out)["watch"];
        for (const char* key : {"energy_residual", "momentum_error"}) {
            EXPECT_LT(watch[key]["largest"], 1e-10) << method << key;
            EXPECT_GT(watch[key]["largest"], 0) << method << key;
        }
        EXPECT_SAYS(read(method + "/log.csv"), "energy_residual[1],momentum_error[1]");
        const Outcome o = run(
            {"run", method + ".toml", "--out", "bad-" + method, "--set", "watch.energy_residual=[0, 1e-30]"});
        EXPECT_EQ(o.code, code_of(Exit::unstable)) << method;
        EXPECT_SAYS(run({"check", method + ".toml", "--set", "gas.restitution=0.9"}).err,
                    "watch.energy_residual: is defined for gases in which");
    }
}

struct Contradiction {
    const char* name;
    std::vector<std::string> set, says;

    friend void PrintTo(const Contradiction& c, std::ostream* stream) { *stream << c.name; }
};

class Contradictions : public App, public testing::WithParamInterface<Contradiction> {};

TEST_P(Contradictions, AreRefused) {
    write("scene.toml", box_scene);
    std::vector<std::string> arguments = {"check", "scene.toml"};
    for (const std::string& set : GetParam().set) arguments.insert(arguments.end(), {"--set", set});
    const Outcome o = run(arguments);
    EXPECT_EQ(o.code, code_of(Exit::invalid_input));
    for (const std::string& part : GetParam().says) EXPECT_SAYS(o.err, part);
}

INSTANTIATE_TEST_SUITE_P(
    All, Contradictions,
    testing::Values(
        Contradiction{"step",
                      {"md.accuracy=1e-3", "md.dt=1e-6"},
                      {"md.dt: 1e-06 s contradicts md.accuracy = 0.001", "leave out"}},
        Contradiction{"integrator",
                      {"md.accuracy=1e-3", "md.integrator=gear5"},
                      {"md.integrator: is given", "write \"auto\""}},
        Contradiction{
            "adaptive", {"md.accuracy=1e-3", "md.adaptive_dt=true"}, {"md.adaptive_dt", "leave out"}},
        Contradiction{"coarse", {"md.accuracy=0.2"}, {"md.accuracy", "allowed: 0 to 0.1"}},
        Contradiction{"fine", {"md.accuracy=1e-9"}, {"md.accuracy", "allowed: 1e-08 to 0.1"}},
        Contradiction{"beyond",
                      {"md.accuracy=1e-8", "md.contact_onset=step"},
                      {"no integrator meets it", "Allowed here: about "}},
        Contradiction{"limit", {"watch.step_error=0.1"}, {"watch.step_error", "[warning, stop]"}},
        Contradiction{"order", {"watch.step_error=[0.1, 0.01]"}, {"the warning must not lie above the stop"}},
        Contradiction{"shear",
                      {"watch.momentum_error=[0, 0]", "domain.shear_rate=1", "domain.gravity=[0, 0]",
                       "domain.periodic=[\"x\", \"y\"]", "walls=[]"},
                      {"watch.momentum_error: is not defined with domain.shear_rate"}}),
    [](const auto& instance) { return instance.param.name; });

} // namespace

} // namespace sandlane::test
