// Bad input: the documented exit code, one message that says where, what and what to do, and nothing written.
#include "program.hpp"

#include "core/memory.hpp"
#include "simd/tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ostream>
#include <utility>

namespace sandlane::test {

namespace {

struct BadScene {
    const char* name;
    std::string piece, by;         // of box_scene
    std::vector<std::string> says; // parts of the message

    friend void PrintTo(const BadScene& bad, std::ostream* stream) { *stream << bad.by; }
};

class BadScenes : public App, public testing::WithParamInterface<BadScene> {};

TEST_P(BadScenes, AreRefused) {
    const BadScene& bad = GetParam();
    write("scene.toml", replaced(box_scene, bad.piece, bad.by));
    const auto before = listing();
    const Outcome o = run({"run", "scene.toml", "--out", "new/out"});
    EXPECT_EQ(o.code, code_of(Exit::invalid_input)) << o.err;
    for (const std::string& part : bad.says) EXPECT_SAYS(o.err, part);
    EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
    EXPECT_EQ(o.out, "");
    EXPECT_EQ(listing(), before);
}

const std::string grain_spacing = "spacing = [\"6 mm\", \"6 mm\"]", counts = "counts = [10, 8]",
                  radii = R"({ law = "uniform", min = "2 mm", max = "2.5 mm" })",
                  duration = "duration = \"0.2 s\"", title = "title = \"Box of glass\"\n",
                  friction = "friction = 0.5", walls = "[[walls]]\n",
                  polyline = "kind = \"polyline\"\nclosed = true\npoints = [[0.005, 0.005], [0.075, 0.005], "
                             "[0.075, 0.075], [0.005, 0.075]]";

const BadScene bad_scenes[] = {
    {"SyntaxError", title, "title = \n", {"scene.toml:1:", "syntax error"}},
    {"UnknownKey",
     friction,
     "frition = 0.5",
     {"scene.toml:13: materials[0].frition", "did you mean \"friction\"?"}},
    {"UnknownTable", "[md]", "[mdd]", {"scene.toml:30: mdd", "did you mean \"md\"?"}},
    {"DuplicatedKey", title, title + title, {"scene.toml:2:", "title"}},
    {"MissingKey", "name = \"glass\"\n", "", {"scene.toml:8: materials[0].name", "is missing"}},
    {"NoDomain", "[domain]", "[output2]", {"output2", "unknown key"}},
    {"WrongType", duration, "duration = true", {"scene.toml:31: md.duration", "true is not a number"}},
    {"WrongUnit",
     duration,
     "duration = \"2 kg\"",
     {"md.duration", "\"2 kg\" is not a quantity in s", "\"2 ms\""}},
    {"OutOfRange",
     friction,
     "friction = -1",
     {"materials[0].friction", "-1 is out of range; allowed: 0 or more"}},
    {"NotANumber", friction, "friction = nan", {"materials[0].friction", "not a finite number"}},
    {"NanPosition", "lower = [\"10 mm\"", "lower = [nan", {"grains[0].lower[0]", "not a finite number"}},
    {"WrongChoice",
     "kind = \"lattice\"",
     "kind = \"latice\"",
     {"grains[0].kind", "\"latice\" is not one of", "did you mean \"lattice\"?"}},
    {"Twice",
     "[\"dump\", \"book\"]",
     "[\"dump\", \"dump\"]",
     {"output.trajectory", "\"dump\" is there twice"}},
    {"Overlap",
     grain_spacing,
     "spacing = [\"3 mm\", \"6 mm\"]",
     {"grain ", "overlap by", "% of the smaller radius; allowed: up to 5 %", "Increase their distance"}},
    {"Outside",
     counts,
     "counts = [20, 8]",
     {"grain 12 (grains[0])", "lies outside the domain; allowed: [0, 0.08)"}},
    {"InWall",
     "lower = [\"10 mm\"",
     "lower = [\"6 mm\"",
     {"grain 0", "walls[0] \"box\"", "allowed:", "Move"}},
    {"SmallPeriod",
     "upper = [\"80 mm\", \"80 mm\"]",
     "upper = [\"8 mm\", \"80 mm\"]\nperiodic = [\"x\"]",
     {"domain.periodic", "the period of 0.008 m along x is too short", "allowed:", "Enlarge domain.upper"}},
    {"EmptyDomain",
     "upper = [\"80 mm\"",
     "upper = [\"-1 mm\"",
     {"domain: upper = [-0.001, 0.08]", "above lower"}},
    {"InfiniteDomain",
     "lower = [0, 0]\nupper = [\"80 mm\"",
     "lower = [-1.5e308, 0]\nupper = [1.5e308",
     {"domain: upper", "finite distance"}},
    {"LargeTimeStep",
     duration,
     duration + "\ndt = \"1 ms\"",
     {"md.dt = 0.001 s is above the critical time step", "(allowed: 0 to that; recommended:", "Lower md.dt"}},
    {"FastGrains",
     duration,
     duration + "\nmax_speed = \"100 m/s\"\ndt = \"8 us\"",
     {"md.dt", "md.max_speed = 100 m/s", "Lower md.dt below"}},
    {"WallOfOnePoint",
     polyline,
     "kind = \"polyline\"\npoints = [[0.005, 0.005]]",
     {"walls[0].points: has 1 points; kind needs 2 or more"}},
    {"SegmentOfThree",
     polyline,
     "kind = \"segment\"\npoints = [[0, 0], [0, 1], [1, 1]]",
     {"walls[0].points: has 3 points; a segment has 2"}},
    {"PlaneWithoutNormal", polyline, "kind = \"plane\"\npoints = [[0, 0]]", {"walls[0].normal: is missing"}},
    {"UnknownMaterial",
     walls,
     walls + "material = \"steel\"\n",
     {"walls[0].material: \"steel\" is not a material; known: \"glass\""}},
    {"UnknownMotion", walls, walls + "motion = \"shake\"\n", {"walls[0].motion: \"shake\" is not the name"}},
    {"RegionUpsideDown",
     "kind = \"lattice\"",
     "kind = \"random\"",
     {"grains[0].upper: [0, 0] must not lie below lower = [0.01, 0.01]"}},
    {"MissingGrainFile",
     "kind = \"lattice\"",
     "kind = \"file\"\nfile = \"grains.csv\"",
     {"grains[0].file: \"grains.csv\" does not exist"}},
    {"BillionsOfBillions",
     counts,
     "counts = [1000000000, 1000000000]",
     {"grains[0]: 1e+18 grains; allowed: up to 2147483647", "Lower counts"}},
    {"MillionsOfWallGrains",
     polyline,
     "kind = \"grains\"\nradius = 1e-12\npoints = [[0, 0], [1, 1]]",
     {"walls[0].spacing", "wall grains; allowed: up to 1e+07"}},
    {"TooManySteps", duration, "duration = 1e300", {"md.duration", "allowed: up to 4e15 steps"}},
    {"Dust", radii, "1e-200", {"grain 0", "beyond the range of numbers"}},
};

INSTANTIATE_TEST_SUITE_P(All, BadScenes, testing::ValuesIn(bad_scenes),
                         [](const auto& instance) { return instance.param.name; });

class Refusals : public App {
protected:
    Refusals() { write("scene.toml", box_scene); }

    // The program must refuse and leave the folder as it was.
    std::string refusal(Exit code, const Call& call) const {
        const auto before = listing();
        const Outcome o = run(call);
        EXPECT_EQ(o.code, code_of(code)) << o.err;
        EXPECT_EQ(listing(), before);
        return o.err;
    }
    std::string refusal(Exit code, std::vector<std::string> arguments) const {
        return refusal(code, Call{std::move(arguments)});
    }
    std::string refused_run(Exit code, std::vector<std::string> more) const {
        std::vector<std::string> arguments = {"run", "scene.toml", "--out", "new/out"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return refusal(code, std::move(arguments));
    }
    std::string refused_override(const std::string& text) const {
        return refused_run(Exit::invalid_input, {"--set", text});
    }
};

TEST_F(Refusals, Usage) {
    EXPECT_SAYS(refusal(Exit::invalid_input, {"simulate"}), "simulate");
    EXPECT_SAYS(refusal(Exit::invalid_input, {"run"}), "give either a scene file, or a checkpoint");
    EXPECT_SAYS(refusal(Exit::invalid_input, {"check"}), "scene is required");
    EXPECT_SAYS(refused_run(Exit::invalid_input, {"--hurry"}), "--hurry");
    EXPECT_SAYS(refused_run(Exit::invalid_input, {"--resume", "x.checkpoint"}),
                "either a scene file, or a checkpoint");
    EXPECT_SAYS(refused_run(Exit::invalid_input, {"--steps", "-1"}), "--steps: Value -1 not in range");
    EXPECT_SAYS(refused_run(Exit::invalid_input, {"--steps", "ten"}), "--steps");
    EXPECT_SAYS(refused_run(Exit::invalid_input, {"--walltime", "-1"}), "--walltime");
    EXPECT_SAYS(refused_run(Exit::invalid_input, {"--threads", "0"}), "--threads: Value 0 not in range");
    const std::string colour =
        refusal(Exit::invalid_input, {"render", "scene.toml", "a.png", "--colour", "pink"});
    EXPECT_SAYS(colour, "--colour: pink not in {speed,pressure,spin,radius}");
}

TEST_F(Refusals, MissingFiles) {
    fs::create_directory(path("folder"));
    EXPECT_SAYS(refusal(Exit::invalid_input, {"run", "no.toml"}), "no.toml: no such file");
    EXPECT_SAYS(refusal(Exit::invalid_input, {"run", "folder"}), "folder: is a folder, not a file");
    EXPECT_SAYS(refusal(Exit::invalid_input, {"check", "no.toml"}), "no.toml: no such file");
    EXPECT_SAYS(refusal(Exit::invalid_input, {"run", "--resume", "no.checkpoint"}),
                "no.checkpoint: no such file");
    EXPECT_SAYS(refusal(Exit::invalid_input, {"convert", "no.book", "a.toml"}), "no.book: no such file");
}

TEST_F(Refusals, UnreadableFile) {
    fs::permissions(path("scene.toml"), fs::perms::none);
    Call call{{"check", "scene.toml"}};
    call.everywhere = false;
    const Outcome o = run(call);
    EXPECT_EQ(o.code, code_of(Exit::invalid_input));
    EXPECT_SAYS(o.err, "scene.toml: cannot be read: Permission denied");
}

TEST_F(Refusals, Overrides) {
    EXPECT_SAYS(refused_override("md.dtt=1"), "--set md.dtt: md.dtt: unknown key; did you mean \"dt\"?");
    EXPECT_SAYS(refused_override("md.dt=soon"), "--set md.dt: md.dt: \"soon\" is not a quantity in s");
    EXPECT_SAYS(refused_override("grains.5.count=1"), "\"5\" is not an entry of the list; allowed: 0 to 0");
    EXPECT_SAYS(refused_override("title.x=1"), "there is nothing below \"x\"");
    EXPECT_SAYS(refused_override("duration"), "must be path=value");
    EXPECT_SAYS(refused_override("=1"), "must be path=value");
}

TEST_F(Refusals, InstructionSets) {
    EXPECT_SAYS(refused_run(Exit::invalid_input, {"--isa", "mmx"}),
                "--isa=mmx: unknown instruction set; allowed: auto");
    EXPECT_SAYS(refusal(Exit::invalid_input, Call{{"check", "scene.toml"}, {{"SANDLANE_ISA", "x87"}}}),
                "SANDLANE_ISA=x87: unknown instruction set");
    for (const simd::Isa isa : {simd::Isa::sse4_2, simd::Isa::avx2, simd::Isa::avx512}) {
        if (simd::isa_supported(isa)) continue;
        const std::string message =
            refused_run(Exit::unavailable, {"--isa", std::string(simd::isa_name(isa))});
        EXPECT_SAYS(message, "this machine or this build lacks it; best available:");
    }
}

TEST_F(Refusals, Threads) {
    EXPECT_SAYS(refused_run(Exit::unavailable, {"--threads", "4096"}), "--threads asks for 4096 threads");
    const auto with = [&](const char* name, const char* value, Exit code) {
        return refusal(code, Call{{"check", "scene.toml"}, {{name, value}}});
    };
    EXPECT_SAYS(with("OMP_NUM_THREADS", "many", Exit::invalid_input),
                "OMP_NUM_THREADS=many: must be a whole number of at least 1");
    EXPECT_SAYS(with("OMP_NUM_THREADS", "0", Exit::invalid_input), "OMP_NUM_THREADS=0");
    EXPECT_SAYS(with("OMP_NUM_THREADS", "2x", Exit::invalid_input), "OMP_NUM_THREADS=2x");
    EXPECT_SAYS(with("SANDLANE_THREADS", "99999", Exit::unavailable),
                "SANDLANE_THREADS asks for 99999 threads");
    EXPECT_EQ(run(Call{{"check", "scene.toml"}, {{"OMP_NUM_THREADS", "2,1"}}}).code, 0); // nested levels
}

// Coefficients that do not fit the chosen laws, or would do nothing.
TEST_F(Refusals, ContactLaws) {
    const auto refused = [&](const std::vector<std::string>& settings) {
        std::vector<std::string> arguments;
        for (const std::string& setting : settings) arguments.insert(arguments.end(), {"--set", setting});
        std::string message = refused_run(Exit::invalid_input, arguments);
        EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 1) << message;
        return message;
    };
    EXPECT_SAYS(
        refused(
            {"md.normal=walton-braun", "materials.0.stiffness=2e4", "materials.0.unloading_stiffness=1e4"}),
        "materials[0].unloading_stiffness: 10000 is out of range; md.normal = \"walton-braun\" needs 20000");
    EXPECT_SAYS(refused({"md.normal=walton-braun"}), "materials[0].stiffness: 0 is out of range");
    EXPECT_SAYS(refused({"md.tangential=walton-braun"}),
                "materials[0].tangential_stiffness: 0 is out of range");
    EXPECT_SAYS(refused({"materials.0.cohesion=100"}),
                "materials[0].cohesion: 100 Pa has no effect with md.normal = \"viscoelastic\"; choose "
                "\"cohesive-viscoelastic\"");
    EXPECT_SAYS(refused({"materials.0.cohesion=-1"}), "materials[0].cohesion: -1 is out of range");
    EXPECT_SAYS(refused({"materials.0.rolling_friction=0.1"}),
                "needs rolling_friction (0.1) above 0, and rolling_damping (0) or rolling_stiffness (0)");
    EXPECT_SAYS(refused({"md.tangential=haff-werner", "materials.0.rolling_friction=0.1",
                         "materials.0.rolling_stiffness=0.1"}),
                "materials[0].rolling_stiffness: 0.1 needs friction with a spring, too");
    EXPECT_SAYS(refused({"md.tangential=haff-werner",
                         "pairs=[{ first = \"glass\", second = \"glass\", rolling_friction = 0.1, "
                         "rolling_stiffness = 0.1 }]"}),
                "pairs[0].rolling_stiffness: 0.1 needs friction with a spring, too");
    EXPECT_SAYS(refused({"md.tangential=none", "materials.0.rolling_friction=0.1",
                         "materials.0.rolling_damping=1e-6"}),
                "materials[0].rolling_friction: 0.1 has no effect with md.tangential = \"none\"");
    EXPECT_SAYS(refused({"materials.0.rolling_friction=0.1", "materials.0.rolling_damping=1", "md.dt=1e-6"}),
                "md.dt = 1e-06 s is above the critical time step");
    EXPECT_SAYS(
        refused({"md.normal=walton-braun", "materials.0.stiffness=1e4", "materials.0.unloading_stiffness=2e4",
                 "md.neighbours=link-cells"}),
        "md.neighbours = \"link-cells\": the contacts of md.normal = \"walton-braun\" with md.tangential = "
        "\"haff-werner\" remember");
    EXPECT_SAYS(refused({"md.normal=linear-dashpot", "materials.0.stiffness=1e-200"}),
                "has no duration that is a number");
    EXPECT_SAYS(refused({"md.lever_arm=radius"}), "md.lever_arm: \"radius\" is not one of");
}

TEST_F(Refusals, PairsOfMaterials) {
    const auto refused = [&](const std::string& keys, const std::string& md) {
        const std::string pair = "[[pairs]]\nfirst = \"glass\"\nsecond = \"glass\"\n" + keys + "\n[[walls]]";
        const std::string more = "friction = 0.5\nstiffness = 1e4\nunloading_stiffness = 2e4\n"
                                 "tangential_stiffness = 1e4";
        write("scene.toml", replaced(replaced(replaced(box_scene, "[[walls]]", pair), "[md]", "[md]\n" + md),
                                     "friction = 0.5", more));
        return refused_run(Exit::invalid_input, {});
    };
    const std::string walton_braun = "normal = \"walton-braun\"";
    EXPECT_SAYS(refused("stiffness = 5e4", walton_braun), "needs both or neither");
    EXPECT_SAYS(refused("stiffness = 5e4\nunloading_stiffness = 4e4", walton_braun),
                "pairs[0]: stiffness = 50000 and unloading_stiffness = 40000");
    EXPECT_SAYS(refused("unloading_stiffness = 4e4", walton_braun), "needs both or neither");
    EXPECT_SAYS(refused("tangential_stiffness = 0", "tangential = \"cundall-strack\""),
                "pairs[0]: a stiffness of 0 is no contact law");
    EXPECT_SAYS(refused("cohesion = 5", ""), "pairs[0].cohesion: 5 Pa has no effect");
}

TEST_F(Refusals, GrainFiles) {
    write("scene.toml", replaced(box_scene, "kind = \"lattice\"", "kind = \"file\"\nfile = \"grains.txt\""));
    const auto refused = [&](const std::string& content) {
        write("grains.txt", content);
        return refused_run(Exit::invalid_input, {});
    };
    EXPECT_SAYS(refused("x,y,radius\n0.02,0.02,0.002\n0.03,nan,0.002\n"),
                "grains.txt:3: column y: \"nan\" is not a finite");
    EXPECT_SAYS(refused("x,y,radius\n0.02,0.02,0.002\n0.03,0.0"),
                "grains.txt:3: 2 values; the header has 3 columns");
    EXPECT_SAYS(refused("x,y,radius\n0.02,0.02,-1\n"), "column radius: -1 is out of range; allowed: above 0");
    EXPECT_SAYS(refused("x,y,size\n"), "grains.txt:1: \"size\" is not a column; known: x, y, vx");
    EXPECT_SAYS(refused("#gravity: 0 0 0\n0.02 0.02 0 0 0 0 0.002 1e-4 0 1e7"),
                "the file ends inside the record");
    EXPECT_SAYS(refused("#gravity: 0 0 0\n0.02 0.02 0 0 0 inf"), "record 1, column 6 (omega): \"inf\"");
    EXPECT_SAYS(refused(""), "is empty; a header line");
}

TEST_F(Refusals, LatticeBounds) {
    const std::string lattice = replaced(box_scene, "[md]\n", "[md]\nneighbours = \"lattice\"\n");
    write("scene.toml", replaced(lattice, "min = \"2 mm\"", "min = \"0.5 mm\""));
    EXPECT_SAYS(refused_run(Exit::invalid_input, {}), "md.neighbours = \"lattice\": radius ratio");
    write("scene.toml", replaced(lattice, "upper = [\"80 mm\", \"80 mm\"]", "upper = [1e5, 1e5]"));
    EXPECT_SAYS(refused_run(Exit::invalid_input, {}), "would have more than 2.15e+09 sites");
}

TEST_F(Refusals, MoreMemoryThanThereIs) {
    // 128 bytes for each grain, twice.
    const std::string sand = "[[grains]]\nkind = \"random\"\ncount = 1000000000\nradius = 1e-9\n";
    write("scene.toml", replaced(box_scene, "[[walls]]", sand + sand + "[[walls]]"));
    Call call{{"run", "scene.toml", "--out", "new/out"}};
    if (allowed_memory() > 500e9) call.memory = 500'000'000'000;
    EXPECT_SAYS(refusal(Exit::unavailable, std::move(call)),
                "the start state of 2e+09 grains needs about 512 GB of memory; this process may use");
}

} // namespace

} // namespace sandlane::test
