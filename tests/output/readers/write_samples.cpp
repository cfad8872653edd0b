// Writes trajectories and reports of made-up snapshots, and beside them what is in them (expected.json), for
// the tests that read them with other programs. usage: write_samples FOLDER
#include "core/error.hpp"
#include "core/file.hpp"
#include "output/field_picture.hpp"
#include "output/npy.hpp"
#include "output/report.hpp"
#include "output/sample.hpp"
#include "output/writers.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <limits>
#include <string>
#include <vector>

using namespace sandlane;
namespace fs = std::filesystem;

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

template <class Values> std::string array(const Values& values) {
    return fmt::format("[{}]", fmt::join(values, ", "));
}

std::string discs(const analysis::Snapshot& s) {
    std::vector<std::string> found;
    for (const analysis::WallShape& w : s.walls)
        if (w.kind == analysis::WallShape::Kind::disc)
            found.push_back(fmt::format("{{\"x\": {}, \"y\": {}, \"radius\": {}, \"vx\": {}, \"vy\": {}}}",
                                        w.centre.x, w.centre.y, w.radius, w.velocity.x, w.velocity.y));
    return array(found);
}

std::string expected(const analysis::Snapshot& s) {
    std::string text =
        fmt::format("{{\"time\": {}, \"step\": {}, \"dimension\": {}, \"lower\": [{}, {}, {}], "
                    "\"upper\": [{}, {}, {}], \"periodic\": [{}, {}, {}], \"discs\": {}, \"walls\": {}",
                    s.time, s.step, s.dimension, s.lower.x, s.lower.y, s.lower.z, s.upper.x, s.upper.y,
                    s.upper.z, s.periodic_x, s.periodic_y, s.periodic_z, discs(s), s.walls.size());
    const auto add = [&](const char* name, const auto& values) {
        text += fmt::format(", \"{}\": {}", name, array(values));
    };
    add("id", s.id);
    add("x", s.x);
    add("y", s.y);
    add("vx", s.vx);
    add("vy", s.vy);
    add("omega", s.omega);
    add("angle", s.angle);
    add("radius", s.radius);
    add("mass", s.mass);
    add("pressure", s.pressure);
    add("material", s.material);
    if (s.dimension == 2) return text + "}";
    add("z", s.z);
    add("vz", s.vz);
    add("omega_x", s.omega_x);
    add("omega_y", s.omega_y);
    std::vector<std::string> turned, triangles;
    for (const Quaternion& q : s.orientation)
        turned.push_back(fmt::format("[{}, {}, {}, {}]", q.w, q.x, q.y, q.z));
    const auto corner = [](Vec p) { return fmt::format("[{}, {}, {}]", p.x, p.y, p.z); };
    for (const analysis::WallShape& w : s.walls)
        triangles.push_back(fmt::format("[{}, {}, {}]", corner(w.a), corner(w.b), corner(w.c)));
    add("orientation", turned);
    add("triangles", triangles);
    return text + "}";
}

void write_trajectories(const fs::path& folder, const std::vector<analysis::Snapshot>& frames) {
    fs::create_directories(folder);
    for (const auto kind : {scene::Trajectory::dump, scene::Trajectory::xyz, scene::Trajectory::vtp}) {
        scene::Scene scene = sample::scene();
        scene.domain.dimension = frames.at(0).dimension;
        scene.walls.resize(1);
        if (frames.at(0).dimension == 3) scene.walls[0].motion = "lift";
        const auto writer = output::make_trajectory_writer(kind, folder, scene);
        for (const analysis::Snapshot& frame : frames) writer->write(frame);
    }
    std::vector<std::string> all(frames.size());
    std::transform(frames.begin(), frames.end(), all.begin(), expected);
    write_file_atomically(folder / "expected.json", array(all));
}

analysis::Log log_of(int rows) {
    analysis::Log log;
    log.columns = {
        {"time", "s"},   {"step", "1"},          {"kinetic_energy", "J"}, {"potential_energy", "J"},
        {"grains", "1"}, {"wall_contacts", "1"}, {"contacts", "1"},       {"largest_speed", "m/s"}};
    for (int n = 0; n < rows; ++n)
        log.rows.push_back({0.1 * n, 10.0 * n, 1e-4 / (n + 1), 3e-4 * n, 7, 1.0 * (n % 3), 5.0 * n, 0.2 * n});
    return log;
}

output::ReportInput report(const std::vector<analysis::Snapshot>& frames, int rows) {
    output::ReportInput input;
    input.scene = sample::scene();
    input.scene.title = "A title";
    if (!frames.empty()) {
        scene::Domain& domain = input.scene.domain;
        domain.dimension = frames[0].dimension;
        domain.lower = frames[0].lower;
        domain.upper = frames[0].upper;
        domain.periodic = {frames[0].periodic_x, frames[0].periodic_y, frames[0].periodic_z};
    }
    input.summary = {{"Grains", "7"}};
    input.plan = "engine md\n";
    input.scene_text = "title = \"A title\"\n";
    input.log = log_of(rows);
    for (const analysis::Snapshot& frame : frames) input.replay.push_back(output::make_replay_frame(frame));
    return input;
}

output::ReportInput hostile_report() {
    const std::string attack = "</script></title></pre><script>document.body.dataset.hacked = 1</script>"
                               "<img src=x onerror=\"document.body.dataset.hacked = 1\">{{plan}} \" ' & \\";
    output::ReportInput input = report(sample::frames(sample::walled_row, 3), 3);
    input.scene.title = input.scene.description = input.plan = input.scene_text = attack;
    input.summary = {{attack, attack}};
    input.log.columns[2] = {attack, attack};
    return input;
}

output::ReportInput broken_numbers_report() {
    std::vector<analysis::Snapshot> frames = sample::frames(sample::periodic_row, 4);
    frames[1].x[0] = frames[2].vx[1] = frames[3].angle[2] = nan;
    frames[2].pressure[3] = std::numeric_limits<double>::infinity();
    output::ReportInput input = report(frames, 20);
    input.log.rows[3][2] = input.log.rows[4][6] = nan;
    for (auto& row : input.log.rows) row[7] = nan;
    return input;
}

// 400 x 400 grains: more than a frame holds.
analysis::Snapshot crowd(int frame) {
    analysis::Snapshot s = sample::empty(0.1 * frame);
    s.upper = {4, 4, 0};
    for (int row = 0; row < 400; ++row)
        for (int column = 0; column < 400; ++column)
            sample::add_grain(s, 0.01 * column + 0.005, 0.01 * row + 0.005 + 1e-4 * frame, 0.004,
                              0.01 * (column % 7), frame);
    return s;
}

void write_reports(const fs::path& folder) {
    fs::create_directories(folder);
    const auto write = [&](const char* name, const output::ReportInput& input) {
        output::write_report(folder / name, input);
    };
    write("walls.html", report(sample::frames(sample::walled_row, 12), 40));
    write("periodic.html", report(sample::frames(sample::periodic_row, 12), 40));
    write("space.html", report(sample::frames(sample::space_row, 12), 40));
    write("no-grains.html", report({sample::empty(0), sample::empty(1)}, 2));
    write("no-frames.html", report({}, 40));
    write("one-frame.html", report(sample::frames(sample::row, 1), 1));
    write("empty-log.html", report(sample::frames(sample::row, 3), 0));
    write("hostile.html", hostile_report());
    write("broken-numbers.html", broken_numbers_report());
    write("crowd.html", report(sample::frames(crowd, 3), 5000));
}

// values[y][x] = 10 y + x.
analysis::Field numbered_field() {
    analysis::Field field{"field", "number", "", 7, 5, {}, false, 0};
    for (int y = 0; y < 5; ++y)
        for (int x = 0; x < 7; ++x) field.values.push_back(10 * y + x);
    return field;
}

void write_fields(const fs::path& folder) {
    fs::create_directories(folder);
    output::write_npy(folder / "field.npy", numbered_field());
    write_file_atomically(folder / "field.png", output::draw_field(numbered_field(), "step 7", 60, 200));
}

} // namespace

int main(int argc, char** argv) {
    if (argc != 2) return static_cast<int>(Exit::invalid_input);
    try {
        const fs::path folder = argv[1];
        fs::remove_all(folder);
        write_trajectories(folder / "walled", sample::frames(sample::walled_row, 3));
        write_trajectories(folder / "periodic", sample::frames(sample::periodic_row, 3));
        write_trajectories(folder / "space", sample::frames(sample::space_row, 3));
        write_trajectories(folder / "periodic-space", sample::frames(sample::periodic_space_row, 3));
        write_reports(folder / "reports");
        write_fields(folder / "fields");
    } catch (const std::exception& e) {
        fmt::print(stderr, "write_samples: {}\n", e.what());
        return static_cast<int>(Exit::internal);
    }
    return 0;
}
