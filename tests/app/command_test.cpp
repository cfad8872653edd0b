// The commands that do not run a scene to its end: check, compare, bench, info, render, convert, help.
#include "program.hpp"

#include "scene/book_format.hpp"
#include "simd/tables.hpp"

#include <nlohmann/json.hpp>

namespace sandlane::test {

using nlohmann::json;

namespace {

class Commands : public App {
protected:
    Commands() { write("scene.toml", box_scene); }
};

TEST_F(Commands, Help) {
    EXPECT_SAYS(run_well({"--version"}).out, "sandlane ");
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{}, {"--help"}, {"run", "--help"}, {"--help-scene"}}) {
        const Outcome o = run_well(arguments);
        EXPECT_GT(o.out.size(), 200U);
        EXPECT_EQ(o.err, "");
    }
    EXPECT_SAYS(run_well({"--help"}).out, "Exit codes: 0 ok");
    const std::string reference = run_well({"--help-scene"}).out;
    for (const char* key : {"[domain]", "[[materials]]", "`max_speed`", "`picture_width`", "64 to 16384"})
        EXPECT_SAYS(reference, key);
}

TEST_F(Commands, Check) {
    const Outcome text = run_well({"check", "scene.toml"});
    for (const char* part : {"80 at the start", "collision time", "time step", "Plan", "Skipped"})
        EXPECT_SAYS(text.out, part);
    EXPECT_EQ(text.err, "");
    const json d = json::parse(run_well({"check", "scene.toml", "--json", "--set", "md.dt=4e-6"}).out);
    EXPECT_EQ(d["grains"], 80);
    EXPECT_EQ(d["poured"], 0);
    EXPECT_EQ(d["dt"], 4e-6);
    EXPECT_EQ(d["steps"], 50000);
    EXPECT_GT(d["critical_dt"], 4e-6);
    EXPECT_LE(d["restitution"][0], d["restitution"][1]);
    EXPECT_LT(d["restitution"][1], 1);
    EXPECT_EQ(listing(), (std::set<std::string>{"scene.toml"}));
}

TEST_F(Commands, CompareFindsTheSameBits) {
    EXPECT_SAYS(run_well({"compare", "scene.toml", "--steps", "500"}).out, "identical, bit for bit");
    const json d = json::parse(run_well({"compare", "scene.toml", "--steps", "500", "--json"}).out);
    EXPECT_EQ(d["same_bits"], true);
    EXPECT_EQ(d["worst_relative"], 0);
    EXPECT_EQ(d["steps"], 500);
    EXPECT_EQ(d["grains"], 80);
    EXPECT_EQ(d["state_hash"][0], d["state_hash"][1]);
}

TEST_F(Commands, CompareInSpaceLooksAtAllComponents) {
    write("cube.toml", cube_scene);
    const std::string table = run_well({"compare", "cube.toml", "--steps", "20"}).out;
    for (const char* quantity : {"\nz ", "\nvz ", "\nomega_x ", "\nomega_y ", "\nomega_z ", "\npressure "})
        EXPECT_SAYS(table, quantity);
    EXPECT_SAYS(table, "identical, bit for bit");
}

TEST_F(Commands, Bench) {
    const json d =
        json::parse(run_well({"bench", "scene.toml", "--steps", "50", "--threads", "2", "--json"}).out);
    EXPECT_EQ(d["steps"], 50);
    EXPECT_EQ(d["results"].size(), 2 * simd::available_isas().size());
    for (const json& result : d["results"]) EXPECT_GT(result["particle_steps_per_second"], 0);
    EXPECT_SAYS(run_well({"bench", "scene.toml", "--steps", "50", "--threads", "1"}).out, "particle-steps/s");
}

TEST_F(Commands, Info) {
    const Outcome o = run_well({"info"});
    for (const char* part : {"compiler", "scalar        available", "threads", "engines"})
        EXPECT_SAYS(o.out, part);
}

TEST_F(Commands, Render) {
    run_well({"run", "scene.toml", "--out", "out", "--steps", "100", "--quiet"});
    const std::string checkpoint = "out/checkpoints/000000000100.checkpoint", signature = "\x89PNG\r\n\x1a\n";
    for (const char* colour : {"speed", "pressure", "spin", "radius"}) {
        run_well({"render", checkpoint, "a.png", "--colour", colour, "--width", "100"});
        const std::string png = read("a.png");
        EXPECT_EQ(png.substr(0, 8), signature);
        EXPECT_EQ(png.substr(16, 4), std::string("\0\0\0\x64", 4)); // IHDR: width
    }
    run_well({"render", "scene.toml", "b.png"});
    EXPECT_EQ(read("b.png").substr(16, 4), std::string("\0\0\0\x40", 4)); // as the scene says
}

TEST_F(Commands, RenderInSpaceFromAnyDirection) {
    write("cube.toml", cube_scene);
    std::set<std::string> pictures;
    for (const char* view : {"0,-1,0", "0,0,1", "1,2,3"}) {
        run_well({"render", "cube.toml", "a.png", "--view", view});
        pictures.insert(read("a.png"));
    }
    EXPECT_EQ(pictures.size(), 3U);
    write("top.toml", replaced(cube_scene, "[output]\n", "[output]\nview = [0, 0, 1]\n"));
    run_well({"render", "top.toml", "top.png"});
    run_well({"render", "cube.toml", "a.png", "--view", "0,0,1"});
    EXPECT_EQ(read("a.png"), read("top.png"));
    const Outcome o = run({"render", "scene.toml", "plane.png", "--view", "0,0,1"});
    EXPECT_EQ(o.code, code_of(Exit::invalid_input));
    EXPECT_SAYS(o.err, "--view goes with three-dimensional scenes only");
    EXPECT_FALSE(fs::exists(path("plane.png")));
}

// ---- convert

TEST_F(Commands, ConvertSceneToEffectiveScene) {
    run_well({"convert", "scene.toml", "full.toml"});
    EXPECT_SAYS(read("full.toml"), "tangential_damping = 0.1");
    run_well({"run", "scene.toml", "--out", "a", "--steps", "300", "--quiet"});
    run_well({"run", "full.toml", "--out", "b", "--steps", "300", "--quiet"});
    EXPECT_EQ(read("a/log.csv"), read("b/log.csv"));
    run_well({"convert", "a/checkpoints/000000000300.checkpoint", "again.toml"});
    EXPECT_EQ(read("again.toml"), read("full.toml"));
}

TEST_F(Commands, ConvertWritesThroughLinksAndPipes) {
    write("target.toml", "");
    fs::create_symlink("target.toml", path("link.toml"));
    run_well({"convert", "scene.toml", "link.toml"});
    EXPECT_TRUE(fs::is_symlink(path("link.toml")));
    EXPECT_SAYS(read("target.toml"), "[domain]");
    EXPECT_SAYS(run_well({"convert", "scene.toml", "/dev/stdout"}).out, "#gravity: 0 -9.81 0");
}

TEST_F(Commands, ConvertToTheBookAndBack) {
    write("scene.toml",
          replaced(box_scene,
                   "kind = \"polyline\"\nclosed = true\npoints = [[0.005, 0.005], [0.075, "
                   "0.005], [0.075, 0.075], [0.005, 0.075]]",
                   "kind = \"grains\"\nradius = \"2 mm\"\npoints = [[0.002, 0.004], [0.078, 0.004]]"));
    run_well({"run", "scene.toml", "--out", "out", "--steps", "3000", "--quiet"});
    const std::string checkpoint = "out/checkpoints/000000003000.checkpoint";
    run_well({"convert", checkpoint, "init.book"});
    run_well({"convert", checkpoint, "frame.book", "--snapshot"});
    const scene::Book init = scene::parse_book(read("init.book"), "init.book");
    const auto frames = scene::parse_book_frames(read("frame.book"), "frame.book");
    ASSERT_EQ(frames.size(), 1U);
    EXPECT_EQ(frames[0].records, init.records);
    EXPECT_EQ(frames[0].header.time, init.header.time);
    EXPECT_EQ(init.records.size(), 80U + 20U); // 76 mm of wall grains of 4 mm
    // The scene made of it writes the same grains again; a second frame follows the first in one file.
    for (const char* from : {"init.book", "frame.book"}) {
        run_well({"convert", from, "back.toml"});
        run_well({"convert", "back.toml", "again.book"});
        const scene::Book again = scene::parse_book(read("again.book"), "again.book");
        ASSERT_EQ(again.records.size(), init.records.size());
        for (std::size_t i = 0; i < again.records.size(); ++i) {
            EXPECT_EQ(again.records[i].x, init.records[i].x);
            // Velocities are stored as v dt: one rounding each way.
            EXPECT_NEAR(again.records[i].vy, init.records[i].vy, 4e-16 * std::abs(init.records[i].vy));
            EXPECT_EQ(again.records[i].mass, init.records[i].type == 0 ? init.records[i].mass : 1.0);
        }
    }
}

TEST_F(Commands, ConvertChoosesAFrame) {
    run_well({"run", "scene.toml", "--out", "out", "--steps", "2000", "--set",
              "output.trajectory_every=0.004", "--quiet"});
    const auto frames = scene::parse_book_frames(read("out/trajectory.book"), "trajectory.book");
    ASSERT_GE(frames.size(), 4U);
    const auto first_x = [&](std::vector<std::string> more) {
        std::vector<std::string> arguments = {"convert", "out/trajectory.book", "a.toml"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        run_well(arguments);
        run_well({"convert", "a.toml", "a.book"});
        return scene::parse_book(read("a.book"), "a.book").records[0].x;
    };
    EXPECT_EQ(first_x({"--frame", "0"}), frames[0].records[0].x);
    EXPECT_EQ(first_x({"--frame", "2"}), frames[2].records[0].x);
    EXPECT_EQ(first_x({}), frames.back().records[0].x);
    const Outcome o = run({"convert", "out/trajectory.book", "b.toml", "--frame", "1000"});
    EXPECT_EQ(o.code, code_of(Exit::invalid_input));
    EXPECT_SAYS(o.err, "--frame 1000: the file has ");
}

TEST_F(Commands, ConvertRefusesWhatItCannotSay) {
    write("a.book",
          "#gravity: 0 0 0\n#lx: 1\n#ly: 1\n0.5 0.5 0 0 0 0 0.1 1 0 1e7 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0\n");
    write("soft.book", "#lx: 1\n#ly: 1\n0.5 0.5 0 0 0 0 0.1 1 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0\n");
    write("linear.toml", replaced(replaced(box_scene, "[md]\n", "[md]\nnormal = \"linear-dashpot\"\n"),
                                  "young = \"10 MPa\"", "stiffness = \"1 kN/m\""));
    write("cube.toml", cube_scene);
    const auto before = listing();
    const auto refused = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), "convert");
        const Outcome o = run(arguments);
        EXPECT_EQ(o.code, code_of(Exit::invalid_input));
        EXPECT_EQ(listing(), before);
        return o.err;
    };
    EXPECT_SAYS(refused({"a.book", "b.book"}), "the target must end in .toml");
    EXPECT_SAYS(refused({"a.book", "b.toml", "--frame", "0"}), "is an init file without frames");
    EXPECT_SAYS(refused({"scene.toml", "b.book", "--frame", "0"}), "--frame goes with");
    EXPECT_SAYS(refused({"scene.toml", "b.toml", "--snapshot"}), "--snapshot goes with");
    EXPECT_SAYS(refused({"soft.book", "b.toml"}), "materials[0].young: 0 is out of range");
    EXPECT_SAYS(refused({"linear.toml", "b.book"}), "linear-dashpot");
    EXPECT_SAYS(refused({"cube.toml", "b.book"}), "the book's format knows two dimensions only");
    EXPECT_SAYS(run_well({"convert", "scene.toml", "b.book"}).err, "1 walls are left out");
}

} // namespace

} // namespace sandlane::test
