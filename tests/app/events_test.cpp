// Event-driven dynamics through the program: run, compare, checkpoints, outputs, refusals.
#include "program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace sandlane::test {

namespace {

const std::string hard_scene = R"(title = "Hard spheres"
method = "edmd"

[domain]
dimension = 3
upper = [12, 12, 12]
periodic = ["x", "y"]

[gas]
particles = 400
temperature = 1
restitution = 0.9

[[sides]]
side = "-z"
kind = "heated"
temperature = 1

[edmd]
duration = 10
)";

class Events : public App {};

} // namespace

TEST_F(Events, RunAndLeaveTheirFiles) {
    write("hard.toml", hard_scene);
    run_well({"run", "hard.toml", "--quiet"});
    for (const char* file : {"log.csv", "profile.csv", "distribution.csv", "plan.txt", "scene.toml",
                             "summary.json", "report.html"})
        EXPECT_TRUE(fs::exists(path("results/hard") / file)) << file;
    const auto summary = json_of(read("results/hard/summary.json"));
    EXPECT_GT(summary["collisions"].get<int>(), 500);
    EXPECT_GT(summary["wall_hits"].get<int>(), 100);
    EXPECT_SAYS(read("results/hard/log.csv"), "collision_rate[1/s],compressibility[1]");
    // The effective scene is a scene, of the same result.
    run_well({"run", "results/hard/scene.toml", "--quiet", "--out", "again"});
    EXPECT_EQ(json_of(read("again/summary.json"))["state_hash"], summary["state_hash"]);
    EXPECT_EQ(json_of(read("again/summary.json"))["event_log_hash"], summary["event_log_hash"]);
}

TEST_F(Events, CompareInstructionSetsAndAlgorithms) {
    write("hard.toml", hard_scene);
    const Outcome o = run_well({"compare", "hard.toml", "--steps", "700"});
    EXPECT_SAYS(o.out, "identical, bit for bit");
    EXPECT_SAYS(o.out, "700 of them, the same");
    std::string hashes[2];
    for (int k = 0; k < 2; ++k) {
        const std::string algorithm = k == 0 ? "improved" : "simple";
        run_well({"run", "hard.toml", "--quiet", "--steps", "700", "--out", algorithm, "--set",
                  "edmd.algorithm=" + algorithm});
        const auto summary = json_of(read(algorithm + "/summary.json"));
        hashes[k] = summary["state_hash"].get<std::string>();
        EXPECT_EQ(summary["collisions"].get<int>() + summary["wall_hits"].get<int>(), 700);
    }
    EXPECT_EQ(hashes[0], hashes[1]);
}

TEST_F(Events, GoOnAfterACheckpoint) {
    write("hard.toml", hard_scene);
    run_well({"run", "hard.toml", "--quiet", "--out", "once"});
    run_well({"run", "hard.toml", "--quiet", "--out", "parts", "--steps", "613", "--set",
              "output.checkpoint_every=1"});
    run_well({"run", "--resume", latest_checkpoint("parts"), "--quiet"});
    EXPECT_EQ(json_of(read("once/summary.json"))["state_hash"],
              json_of(read("parts/summary.json"))["state_hash"]);
    const std::string log = read("parts/log.csv");
    EXPECT_EQ(read("once/log.csv").substr(0, 300), log.substr(0, 300));
}

// A column of log.csv.
std::vector<double> column(const std::string& log, const std::string& name) {
    std::istringstream lines(log);
    std::string line, cell;
    std::getline(lines, line);
    std::istringstream header(line);
    std::size_t at = 0;
    while (std::getline(header, cell, ',') && cell != name) ++at;
    std::vector<double> values;
    while (std::getline(lines, line)) {
        std::istringstream cells(line);
        for (std::size_t n = 0; n <= at; ++n) std::getline(cells, cell, ',');
        values.push_back(std::stod(cell));
    }
    return values;
}

// Means of independent runs with their errors; each replica is the run of its own seed.
TEST_F(Events, Replicas) {
    write("hard.toml", hard_scene);
    const std::vector<std::string> three = {"--set", "edmd.replicas=3", "--set", "edmd.duration=2"};
    const auto with = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.end(), three.begin(), three.end());
        return arguments;
    };
    run_well(with({"run", "hard.toml", "--quiet", "--out", "all", "--threads", "2"}));
    const std::string log = read("all/log.csv");
    EXPECT_SAYS(log.substr(0, log.find('\n')), "temperature_error[J]");
    EXPECT_SAYS(read("all/plan.txt"), "3, of seeds 1 to 3");
    double temperature = 0;
    for (const char* seed : {"1", "2", "3"}) {
        run_well({"run", "hard.toml", "--quiet", "--out", seed, "--set", "edmd.duration=2", "--set",
                  std::string("seed=") + seed});
        temperature += column(read(std::string(seed) + "/log.csv"), "temperature[J]").back() / 3;
    }
    EXPECT_NEAR(column(log, "temperature[J]").back(), temperature, 1e-7);
    run_well(with({"run", "hard.toml", "--quiet", "--out", "parts", "--steps", "300"}));
    run_well({"run", "--resume", latest_checkpoint("parts"), "--quiet"});
    EXPECT_EQ(json_of(read("all/summary.json"))["state_hash"],
              json_of(read("parts/summary.json"))["state_hash"]);
    EXPECT_EQ(read("parts/log.csv"), log);
    EXPECT_SAYS(run_well(with({"compare", "hard.toml", "--steps", "200"})).out, "identical, bit for bit");
}

// Shear without walls: compare, checkpoints, the stress in the log.
TEST_F(Events, ShearFlow) {
    const std::string open =
        replaced(hard_scene, "[[sides]]\nside = \"-z\"\nkind = \"heated\"\ntemperature = 1\n", "");
    write("shear.toml",
          replaced(open, "periodic = [\"x\", \"y\"]", "periodic = [\"x\", \"y\", \"z\"]\nshear_rate = 0.5"));
    EXPECT_SAYS(run_well({"compare", "shear.toml", "--steps", "500"}).out, "identical, bit for bit");
    run_well({"run", "shear.toml", "--quiet", "--out", "once"});
    run_well({"run", "shear.toml", "--quiet", "--out", "parts", "--steps", "700"});
    run_well({"run", "--resume", latest_checkpoint("parts"), "--quiet"});
    EXPECT_EQ(read("once/log.csv"), read("parts/log.csv"));
    EXPECT_GT(column(read("once/log.csv"), "shear_stress[Pa]").back(), 0);
    write("walls.toml", replaced(hard_scene, "dimension = 3", "dimension = 3\nshear_rate = 0.5"));
    const Outcome refused = run({"run", "walls.toml", "--quiet"});
    EXPECT_EQ(refused.code, code_of(Exit::invalid_input));
    EXPECT_SAYS(refused.err, "add \"z\" to domain.periodic");
}

TEST_F(Events, OutputsFollowTheClock) {
    write("hard.toml", hard_scene);
    run_well({"run", "hard.toml", "--quiet", "--out", "even", "--set", "output.log_every=0.5"});
    const auto even = column(read("even/log.csv"), "time[s]");
    ASSERT_EQ(even.size(), 21U);
    for (std::size_t k = 0; k < even.size(); ++k)
        EXPECT_NEAR(even[k], 0.5 * static_cast<double>(k), 1e-6) << k;
    run_well({"run", "hard.toml", "--quiet", "--out", "log", "--set", "output.log_every=0.1", "--set",
              "edmd.output_spacing=log-time"});
    const auto log = column(read("log/log.csv"), "time[s]");
    ASSERT_EQ(log.size(), 42U); // at the start, at 0.1, and twenty for each of two decades
    for (std::size_t k = 2; k < log.size(); ++k) EXPECT_NEAR(log[k] / log[k - 1], std::pow(10, 0.05), 1e-5);
    // Where outputs stop the run leaves no trace in it.
    const auto of = [&](const char* name) { return json_of(read(std::string(name) + "/summary.json")); };
    run_well({"run", "hard.toml", "--quiet", "--out", "events", "--set", "edmd.output_spacing=events"});
    EXPECT_EQ(of("even")["state_hash"], of("log")["state_hash"]);
    EXPECT_EQ(of("even")["state_hash"], of("events")["state_hash"]);
    // A checkpoint between two rows.
    run_well(
        {"run", "hard.toml", "--quiet", "--out", "parts", "--steps", "613", "--set", "output.log_every=0.5"});
    run_well({"run", "--resume", latest_checkpoint("parts"), "--quiet"});
    EXPECT_EQ(read("even/log.csv"), read("parts/log.csv"));
}

// Where a run is looked at, it depends on the clock on the wall; here it is cut at an event just before a
// row.
TEST_F(Events, RowsDoNotDependOnWhereARunIsCut) {
    write("hard.toml", hard_scene);
    run_well({"run", "hard.toml", "--quiet", "--steps", "500", "--out", "events", "--set",
              "edmd.output_spacing=events", "--set", "output.log_every=1e-9"});
    const double last = column(read("events/log.csv"), "time[s]").back();
    for (const double part : {1.0, 0.2})
        for (const char* spacing : {"time", "log-time"}) {
            const std::vector<std::string> run = {"run",
                                                  "hard.toml",
                                                  "--quiet",
                                                  "--set",
                                                  "output.log_every=" +
                                                      fmt::format("{:.17g}", part * last * (1 + 3e-7)),
                                                  "--set",
                                                  std::string("edmd.output_spacing=") + spacing};
            const auto with = [&](std::vector<std::string> more) {
                more.insert(more.begin(), run.begin(), run.end());
                return more;
            };
            for (const char* out : {"once", "parts"}) fs::remove_all(path(out));
            run_well(with({"--out", "once"}));
            run_well(with({"--out", "parts", "--steps", "500"}));
            run_well({"run", "--resume", latest_checkpoint("parts"), "--quiet"});
            EXPECT_EQ(read("once/log.csv"), read("parts/log.csv")) << part << spacing;
            EXPECT_EQ(json_of(read("once/summary.json"))["state_hash"],
                      json_of(read("parts/summary.json"))["state_hash"]);
        }
}

TEST_F(Events, RefuseWhatTheyCannotDo) {
    struct Case {
        std::string from, to;
        std::vector<std::string> says;
    };
    for (const Case& c : std::vector<Case>{
             {"restitution = 0.9", "restitution = 1.1", {"gas.restitution", "1.1"}},
             {"restitution = 0.9", "restitution = -0.1", {"gas.restitution", "-0.1"}},
             {"particles = 400", "particles = 4000", {"packing fraction", "0.7405"}},
             {"particles = 400", "particles = 2400", {"do not fit", "2400"}},
             {"particles = 400", "particles = 400\nweight = 2", {"gas.weight", "stand for themselves"}},
             {"particles = 400", "particles = 4\ndiameter = 6.5", {"domain", "two diameters"}},
             {"temperature = 1\n\n[edmd]", "temperature = 0\n\n[edmd]", {"sides[0].temperature", "above 0"}},
             {"duration = 10", "events = 0", {"edmd", "no end"}},
             {"duration = 10", "duration = 10\ncell_edge = 20", {"edmd.cell_edge", "12"}},
             {"duration = 10", "duration = 10\ncontact_time = -1", {"edmd.contact_time", "-1"}},
             {"duration = 10", "duration = 10\nalgorithm = \"fast\"", {"edmd.algorithm", "improved"}},
             {"kind = \"heated\"", "speed = 2\nkind = \"heated\"", {"sides[0].speed", "a slower piston"}},
             {"[edmd]",
              "[[sides]]\nside = \"+z\"\nspeed = 1.15\n[edmd]",
              {"sides[1].speed", "0.5 m of 12 m left"}},
             {"[edmd]",
              "[[curved_walls]]\ncenter = [6, 6, 6]\nradius = 5\n[edmd]",
              {"curved_walls[0]", "periodic"}},
             {"duration = 10", "duration = 10\nstart = \"grow\"", {"edmd.start", "growth"}},
             {"duration = 10", "duration = 10\ngrowth_rate = 1", {"edmd.growth_rate", "start"}},
             {"duration = 10", "duration = 10\nheating_interval = 1", {"edmd.heating_interval", "heating"}},
             {"duration = 10",
              "duration = 10\nsample_every = 1e-12",
              {"edmd.sample_every: 1e-12 s", "at least 1e-08 s"}},
             {"[edmd]", "[output]\nlog_every = 1e-300\n[edmd]", {"output.log_every: 1e-300 s"}},
             {"duration = 10",
              "events = 10\n[output]\nlog_every = 1e-12",
              {"output.log_every: 1e-12 s", "a billionth of it"}},
             {"[edmd]", "[dsmc]\ndt = 1\n[edmd]", {"dsmc", "is not read by method = \"edmd\""}},
             {"[edmd]", "[[species]]\nparticles = 3\ndiameter = 0.001\n[edmd]", {"species.diameter", "100"}},
         }) {
        SCOPED_TRACE(c.to);
        std::string scene = hard_scene;
        const std::size_t at = scene.find(c.from);
        ASSERT_NE(at, std::string::npos);
        scene.replace(at, c.from.size(), c.to);
        write("bad.toml", scene);
        const Outcome result = run({"run", "bad.toml", "--quiet"});
        EXPECT_EQ(result.code, code_of(Exit::invalid_input));
        for (const std::string& word : c.says) EXPECT_SAYS(result.err, word);
    }
}

TEST_F(Events, SayThatTheGasCollapsesSlow) {
    const std::string flat = replaced(hard_scene, "dimension = 3\nupper = [12, 12, 12]", "upper = [18, 18]");
    const std::string open =
        replaced(flat, "[[sides]]\nside = \"-z\"\nkind = \"heated\"\ntemperature = 1\n", "");
    const std::string strong = replaced(open, "restitution = 0.9", "restitution = 0.2");
    const std::string scene = replaced(replaced(strong, "duration = 10", "duration = 1e6"), "= 400", "= 100");
    write("collapse.toml", scene);
    const Outcome result = run({"run", "collapse.toml", "--quiet"});
    EXPECT_EQ(result.code, code_of(Exit::unstable));
    EXPECT_SAYS(result.err, "inelastic collapse");
    EXPECT_SAYS(result.err, "edmd.contact_time");
}

} // namespace sandlane::test
