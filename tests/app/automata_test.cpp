// Cellular automata through the program: every command, checkpoints, equal bits, refusals.
#include "program.hpp"

#include "simd/tables.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace sandlane::test {

using nlohmann::json;

namespace {

const std::map<std::string, std::string> scenes = {
    {"sandpile", "method = \"sandpile\"\n[sandpile]\ncolumns = 70\nrows = 40\ncentre = 9000\n"},
    {"identity",
     "method = \"sandpile\"\n[sandpile]\ncolumns = 70\nrows = 40\nstart = \"identity-doubled\"\n"},
    {"avalanches",
     "method = \"sandpile\"\n[sandpile]\ncolumns = 30\nrows = 30\ndrive = \"random\"\nsteps = 3000\n"},
    {"heap", "method = \"heap\"\n[heap]\ncolumns = 60\nroughness = 0.5\nheaps = 5\nsteps = 700\n"},
    {"ripples",
     "method = \"ripples\"\n[ripples]\ncolumns = 60\nrows = 40\ntransport = 0.6\nwind = 2\nlength = 7.3\n"
     "creep = 0.8\nsteps = 200\n"},
    {"gas", "method = \"lattice-gas\"\n[lattice_gas]\nrule = \"fhp-3\"\ncolumns = 130\nrows = 70\nvelocity = "
            "[0.1, 0]\n"
            "drive = 0.01\nsteps = 100\n[[obstacles]]\ncentre = [30, 35]\nradius = 8\n"},
    {"pipe",
     "method = \"pipe-flow\"\n[pipe_flow]\nlength = 200\nwidth = 9\ndissipation = 0.1\ngravity = 0.5\n"
     "roughness = 0.5\nsteps = 300\n"},
    {"counted",
     "method = \"pipe-flow\"\n[pipe_flow]\nvariant = \"counted-rest\"\nlength = 60\nwidth = 5\ndissipation = "
     "0.1\ngravity = 0.5\nroughness = 0.5\nsteps = 60\n"},
};

class Automata : public App {
protected:
    Automata() {
        for (const auto& [name, text] : scenes)
            write(name + ".toml", text + "[output]\npicture_width = 64\nmovie = false\n");
    }
    [[nodiscard]] json summary(std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin(), "run");
        arguments.insert(arguments.end(), {"--quiet", "--json"});
        return json::parse(run_well(arguments).out);
    }
};

TEST_F(Automata, RunLeavesItsFiles) {
    for (const auto& [name, text] : scenes) {
        const json s = summary({name + ".toml", "--out", name});
        EXPECT_EQ(s["status"], "finished");
        const bool grains = name == "avalanches" || name == "heap";
        EXPECT_GT(s[grains ? "grains_per_second" : "site_updates_per_second"], 0) << name;
        for (const char* file : {"log.csv", "plan.txt", "report.html", "summary.json", "pictures/000000.png"})
            EXPECT_TRUE(fs::exists(path(name + "/" + file))) << name << " " << file;
        EXPECT_SAYS(read(name + "/report.html"), "data:image/png;base64,");
        EXPECT_EQ(
            read(name + "/maps/" + fs::directory_iterator(path(name + "/maps"))->path().filename().string())
                .substr(1, 5),
            "NUMPY");
    }
    EXPECT_SAYS(read("avalanches/avalanche-size.csv"), "size[1],counts[1],probability[1]");
    EXPECT_SAYS(read("heap/tail.csv"), "a[1],b[1],c[1],x0[1]");
    EXPECT_TRUE(fs::exists(path("pipe/space-time.png")));
    EXPECT_TRUE(fs::exists(path("pipe/power-law.csv")));
    EXPECT_TRUE(fs::exists(path("ripples/modes.csv")));
}

// Every instruction set is in tests/automata; here, what the program makes of a scene.
TEST_F(Automata, SameBitsByReferenceAndKernels) {
    for (const auto& [name, text] : scenes)
        EXPECT_EQ(summary({name + ".toml", "--out", name + "-1", "--isa", "scalar", "--threads",
                           "1"})["state_hash"],
                  summary({name + ".toml", "--out", name + "-2", "--threads", "2"})["state_hash"])
            << name;
}

TEST_F(Automata, ResumedRunsAreTheWholeRun) {
    for (const auto& [name, text] : scenes) {
        const json whole = summary({name + ".toml", "--out", "whole-" + name});
        run_well({"run", name + ".toml", "--out", "part-" + name, "--steps", "37", "--quiet"});
        const json rest = summary({"--resume", latest_checkpoint("part-" + name), "--isa", "scalar"});
        EXPECT_EQ(rest["state_hash"], whole["state_hash"]) << name;
        EXPECT_EQ(rest["step"], whole["step"]);
        for (const char* table : {"log.csv", "spectrum.csv", "avalanche-area.csv", "modes.csv"})
            if (fs::exists(path("whole-" + name + "/" + table))) {
                EXPECT_EQ(read("part-" + name + "/" + table), read("whole-" + name + "/" + table))
                    << name << table;
            }
    }
}

TEST_F(Automata, CompareAndCheckEvery) {
    for (const auto& [name, text] : scenes) {
        EXPECT_SAYS(run_well({"compare", name + ".toml", "--steps", "5"}).out, "identical, bit for bit");
        const Outcome o =
            run_well({"run", name + ".toml", "--out", name, "--steps", "4", "--check-every", "2"});
        EXPECT_SAYS(o.err, "check at step 4: worst relative difference to the scalar reference 0\n");
    }
}

TEST_F(Automata, PlanAndBench) {
    EXPECT_SAYS(run_well({"check", "sandpile.toml"}).out, "until nothing changes");
    const json plan = json::parse(run_well({"check", "gas.toml", "--json"}).out);
    EXPECT_EQ(plan["engine"], "lattice-gas");
    EXPECT_EQ(plan["steps"], 100);
    EXPECT_SAYS(run_well({"bench", "gas.toml", "--steps", "3", "--threads", "1"}).out, "site-updates/s");
    EXPECT_SAYS(run_well({"info"}).out, "md, sandpile, heap, ripples, lattice-gas, pipe-flow");
    run_well({"render", "ripples.toml", "a.png", "--width", "100"});
    EXPECT_EQ(read("a.png").substr(1, 3), "PNG");
}

TEST_F(Automata, Refusals) {
    const auto refused = [&](const std::string& name, const std::string& set) {
        const Outcome o = run({"check", name + ".toml", "--set", set});
        EXPECT_EQ(o.code, code_of(Exit::invalid_input)) << set;
        return o.err;
    };
    EXPECT_SAYS(refused("gas", "lattice_gas.rows=71"), "needs an even number of rows");
    EXPECT_SAYS(refused("gas", "lattice_gas.columns=0"), "0 is out of range; allowed: 1 to");
    EXPECT_SAYS(refused("gas", "lattice_gas.columns=-5"), "-5 is out of range");
    EXPECT_SAYS(refused("gas", "lattice_gas.density=1.5"), "1.5 is out of range; allowed: 0 to 1");
    EXPECT_SAYS(refused("gas", "lattice_gas.rule=fhp-4"), "is not one of \"hpp\", \"fhp-1\"");
    EXPECT_SAYS(refused("gas", "lattice_gas.velocity=[0.7, 0]"), "below 0.5 sites per step");
    EXPECT_SAYS(refused("gas", "lattice_gas.chirality=alternating"), "goes with rule = \"fhp-1\"");
    EXPECT_SAYS(refused("gas", "lattice_gas.rule=hpp"), "does not go with rule = \"hpp\"");
    EXPECT_SAYS(refused("gas", "obstacles.0.radius=0"), "obstacles[0].radius: must be above 0");
    EXPECT_SAYS(refused("pipe", "pipe_flow.dissipation=-0.1"), "-0.1 is out of range; allowed: 0 to 1");
    EXPECT_SAYS(refused("pipe", "pipe_flow.window=201"), "more than the pipe has");
    EXPECT_SAYS(refused("sandpile", "sandpile.centre=65536"), "65536 is out of range; allowed: 0 to 65535");
    EXPECT_SAYS(refused("sandpile", "sandpile.height=60000"), "more than a site can hold");
    EXPECT_SAYS(refused("avalanches", "sandpile.steps=0"), "needs a number of grains");
    EXPECT_SAYS(refused("heap", "heap.retained=1"), "1 is out of range");
    EXPECT_SAYS(refused("ripples", "ripples.wnd=1"), "did you mean \"wind\"?");
    EXPECT_SAYS(refused("ripples", "md.dt=1"),
                "md: is not read by method = \"ripples\"; it goes with method = \"md\"");
    EXPECT_SAYS(refused("ripples", "obstacles=[]"), "it goes with method = \"lattice-gas\"");
    EXPECT_SAYS(refused("ripples", "method=ripple"), "did you mean \"ripples\"?");
    write("other.toml", scenes.at("heap"));
    const Outcome o = run({"convert", "heap.toml", "a.book"});
    EXPECT_EQ(o.code, code_of(Exit::invalid_input));
    EXPECT_SAYS(o.err, "has no place in the book's format");
    EXPECT_SAYS(run({"render", "heap.toml", "a.png", "--view", "0,0,1"}).err,
                "go with scenes of grains only");
}

// One line that names the key, exit code 2, and no folder of results.
TEST_F(Automata, BadValuesLeaveNothing) {
    const std::map<std::string, std::vector<std::string>> bad = {
        {"sandpile",
         {"columns=0", "columns=-1", "columns=3.5", "columns=nan", "columns=\"x\"", "columns=99999999999",
          "rows=0", "centre=-1", "centre=65536", "height=56536", "height=-1", "start=\"full\"",
          "sweep=\"half\"", "steps=-1", "columns=16777216"}},
        {"identity", {"height=3", "centre=1", "columns=100001"}},
        {"avalanches", {"steps=0", "height=256", "burn_in=-1", "drive=\"often\""}},
        {"heap",
         {"columns=1", "columns=0", "retained=1", "retained=-0.1", "sticking=0", "roughness=1.5",
          "roughness=-1", "steps=1900000001", "heaps=0", "heaps=65537", "steepest=-1", "sides=\"three\""}},
        {"ripples",
         {"columns=0", "rows=-1", "creep=1.5", "creep=-0.1", "transport=-1", "transport=101", "length=-1",
          "noise=1001", "landing=\"soft\"", "arithmetic=\"exact\"", "columns=500000"}},
        {"gas",
         {"columns=0", "columns=-64", "rows=0", "rows=71", "density=1.1", "density=-0.1", "density=nan",
          "drive=2", "drive=-1e-9", "rule=\"fhp-4\"", "rule=3", "rule=\"hpp\"", "velocity=[0.5, 0]",
          "velocity=0.1", "velocity=[nan, 0]", "chirality=\"alternating\"", "sides=\"open\"", "steps=-3",
          "steps=4294967296"}},
        {"pipe",
         {"length=0", "width=-1", "dissipation=1.0001", "gravity=-0.1", "roughness=nan", "density=7.5",
          "density=-1", "variant=\"two-rest\"", "window=201", "window=0"}},
        {"counted", {"density=6.5"}},
    };
    const std::map<std::string, std::string> tables = {{"gas", "lattice_gas"},
                                                       {"pipe", "pipe_flow"},
                                                       {"counted", "pipe_flow"},
                                                       {"identity", "sandpile"},
                                                       {"avalanches", "sandpile"}};
    const std::set<std::string> before = listing();
    for (const auto& [name, keys] : bad) {
        const std::string table = tables.contains(name) ? tables.at(name) : name;
        std::vector<std::string> command = {"run", name + ".toml", "--out", "bad"};
        if (name == "sandpile") command.insert(command.end(), {"--set", "sandpile.rows=16777216"});
        for (const std::string& key : keys) {
            std::vector<std::string> arguments = command;
            arguments.insert(arguments.end(), {"--set", table + "." + key});
            const Outcome o = run(arguments);
            EXPECT_EQ(o.code, code_of(Exit::invalid_input)) << name << ' ' << key;
            EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
            EXPECT_SAYS(o.err, table);
            EXPECT_EQ(o.out, "");
        }
    }
    EXPECT_EQ(listing(), before);
}

// What `check` says a scene needs is what it takes, beside some 20 MB of the program and its libraries.
TEST_F(Automata, SlowMemoryIsWhatThePlanSays) {
    const std::map<std::string, std::vector<std::string>> large = {
        {"sandpile", {"sandpile.columns=3000", "sandpile.rows=2000", "sandpile.steps=3"}},
        {"identity", {"sandpile.columns=300", "sandpile.rows=300"}},
        {"avalanches", {"sandpile.columns=1500", "sandpile.rows=1500", "sandpile.steps=30"}},
        {"ripples", {"ripples.columns=1500", "ripples.rows=1500", "ripples.steps=2"}},
        {"gas", {"lattice_gas.columns=8192", "lattice_gas.rows=4096", "lattice_gas.steps=2"}},
        {"counted", {"pipe_flow.length=20000", "pipe_flow.width=100", "pipe_flow.steps=2"}},
    };
    for (const auto& [name, keys] : large) {
        std::vector<std::string> arguments = {name + ".toml"};
        for (const std::string& key : keys) arguments.insert(arguments.end(), {"--set", key});
        std::vector<std::string> check = arguments;
        check.insert(check.begin(), "check");
        check.emplace_back("--json");
        const double said = json::parse(run_well(check).out)["memory_bytes"];
        arguments.insert(arguments.begin(), "run");
        arguments.insert(arguments.end(), {"--out", "large-" + name, "--threads", "1"});
        const double peak = run_well(arguments).memory;
        EXPECT_LT(peak, said + 25e6) << name;
        EXPECT_GT(peak, said / 4) << name;
    }
}

TEST_F(Automata, StatesOfOtherLatticesAreRefused) {
    for (const auto& [name, set] : std::map<std::string, std::string>{{"sandpile", "sandpile.columns=71"},
                                                                      {"heap", "heap.columns=61"},
                                                                      {"ripples", "ripples.rows=41"},
                                                                      {"gas", "lattice_gas.rows=72"},
                                                                      {"pipe", "pipe_flow.length=900"}}) {
        run_well({"run", name + ".toml", "--out", name, "--steps", "5", "--quiet"});
        const Outcome o = run({"run", "--resume", latest_checkpoint(name), "--set", set, "--out", "other"});
        EXPECT_EQ(o.code, code_of(Exit::io)) << name << o.err;
        EXPECT_SAYS(o.err, "Overrides by --set must keep the lattice and the model");
    }
}

} // namespace

} // namespace sandlane::test
