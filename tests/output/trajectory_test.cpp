// The text formats, read back by the rules of each format: every number has the bits that were written. What
// other programs read in them, and the vtp files: tests/output/readers.
#include "output/writers.hpp"

#include "output/sample.hpp"
#include "output/support.hpp"

#include <gtest/gtest.h>

using namespace sandlane;
using namespace sandlane::output;
using scene::Trajectory;

namespace {

std::vector<std::string> written(const sample::Folder& folder, Trajectory kind, const char* name,
                                 const std::vector<analysis::Snapshot>& frames) {
    const auto writer = make_trajectory_writer(kind, folder.path(), sample::scene());
    for (const analysis::Snapshot& frame : frames) writer->write(frame);
    return lines_of(folder / name);
}

// Text after the first `prefix` of a line.
std::string after(const std::string& line, const std::string& prefix) {
    const std::size_t at = line.find(prefix);
    EXPECT_NE(at, std::string::npos) << prefix << " is missing in: " << line;
    return at == std::string::npos ? "" : line.substr(at + prefix.size());
}

} // namespace

TEST(Dump, EveryNumberReadsBack) {
    const sample::Folder folder("dump");
    const auto frames = sample::frames(sample::periodic_row, 3);
    const auto lines = written(folder, Trajectory::dump, "trajectory.dump", frames);
    std::size_t at = 0;
    for (const analysis::Snapshot& s : frames) {
        ASSERT_LE(at + 11 + s.size(), lines.size());
        EXPECT_EQ(lines[at], "ITEM: TIME");
        EXPECT_EQ(numbers_of(lines[at + 1])[0], s.time);
        EXPECT_EQ(lines[at + 2], "ITEM: TIMESTEP");
        EXPECT_EQ(lines[at + 3], std::to_string(s.step));
        EXPECT_EQ(lines[at + 4], "ITEM: NUMBER OF ATOMS");
        EXPECT_EQ(lines[at + 5], std::to_string(s.size()));
        EXPECT_EQ(lines[at + 6], "ITEM: BOX BOUNDS pp ff ff");
        EXPECT_EQ(numbers_of(lines[at + 7]), (std::vector<double>{s.lower.x, s.upper.x}));
        EXPECT_EQ(numbers_of(lines[at + 8]), (std::vector<double>{s.lower.y, s.upper.y}));
        EXPECT_EQ(lines[at + 10],
                  "ITEM: ATOMS id type x y z vx vy vz radius mass omegaz angle pressure ix iy iz");
        at += 11;
        for (std::size_t i = 0; i < s.size(); ++i)
            EXPECT_EQ(
                numbers_of(lines[at++]),
                (std::vector<double>{static_cast<double>(s.id[i]), s.material[i] + 1.0, s.x[i], s.y[i], 0,
                                     s.vx[i], s.vy[i], 0, s.radius[i], s.mass[i], s.omega[i], s.angle[i],
                                     s.pressure[i], static_cast<double>(s.image_x[i]), 0, 0}));
    }
    EXPECT_EQ(at, lines.size());
}

TEST(Dump, WallDiscsAreAtomsOfTheirOwnTypes) {
    const sample::Folder folder("dump-walls");
    const analysis::Snapshot s = sample::walled_row(1);
    const auto lines = written(folder, Trajectory::dump, "trajectory.dump", {s});
    EXPECT_EQ(lines[5], "8");
    EXPECT_EQ(lines[6], "ITEM: BOX BOUNDS ff ff ff");
    const auto disc = numbers_of(lines.back());
    EXPECT_EQ(disc[1], 101); // 100 + wall
    EXPECT_EQ(std::vector<double>(disc.begin() + 2, disc.begin() + 9),
              (std::vector<double>{0.1, 0.08, 0, 0.5, 0.25, 0, 0.01}));
}

TEST(Xyz, EveryNumberReadsBack) {
    const sample::Folder folder("xyz");
    const auto frames = sample::frames(sample::periodic_row, 3);
    const auto lines = written(folder, Trajectory::xyz, "trajectory.xyz", frames);
    const std::vector<std::string> elements{"H", "He"}; // of materials 0 and 1
    std::size_t at = 0;
    for (const analysis::Snapshot& s : frames) {
        ASSERT_LE(at + 2 + s.size(), lines.size());
        EXPECT_EQ(lines[at], std::to_string(s.size()));
        const std::string& comment = lines[at + 1];
        EXPECT_EQ(numbers_of(after(comment, "Lattice=\""))[0], s.upper.x - s.lower.x);
        EXPECT_EQ(numbers_of(after(comment, " Time="))[0], s.time);
        EXPECT_EQ(numbers_of(after(comment, " Step="))[0], static_cast<double>(s.step));
        EXPECT_EQ(after(comment, " pbc=").substr(0, 7), "\"T F F\"");
        EXPECT_TRUE(has(comment, "materials=\"glass,steel\""));
        at += 2;
        for (std::size_t i = 0; i < s.size(); ++i, ++at) {
            EXPECT_EQ(words_of(lines[at])[0], elements[static_cast<std::size_t>(s.material[i])]);
            EXPECT_EQ(numbers_of(after(lines[at], " ")),
                      (std::vector<double>{s.x[i], s.y[i], 0, s.vx[i], s.vy[i], 0,
                                           static_cast<double>(s.id[i]), static_cast<double>(s.material[i]),
                                           s.radius[i], s.mass[i], s.omega[i], s.angle[i], s.pressure[i]}));
        }
    }
    EXPECT_EQ(at, lines.size());
}

TEST(Dump, OfSpace) {
    const sample::Folder folder("dump-space");
    const auto lines = written(folder, Trajectory::dump, "trajectory.dump",
                               {sample::periodic_space_row(2), sample::space_row(1)});
    const analysis::Snapshot s = sample::periodic_space_row(2), turned = sample::space_row(1);
    ASSERT_EQ(lines.size(), 2 * (11 + s.size()));
    EXPECT_EQ(lines[6], "ITEM: BOX BOUNDS pp ff pp");
    EXPECT_EQ(numbers_of(lines[9]), (std::vector<double>{s.lower.z, s.upper.z}));
    EXPECT_EQ(lines[10],
              "ITEM: ATOMS id type x y z vx vy vz radius mass omegax omegay omegaz pressure ix iy iz");
    EXPECT_EQ(numbers_of(lines[13]),
              (std::vector<double>{2, s.material[2] + 1.0, s.x[2], s.y[2], s.z[2], s.vx[2], s.vy[2], s.vz[2],
                                   s.radius[2], s.mass[2], s.omega_x[2], s.omega_y[2], s.omega[2],
                                   s.pressure[2], 0, 0, -1}));
    const std::size_t second = 11 + s.size();
    EXPECT_EQ(lines[second + 10], "ITEM: ATOMS id type x y z vx vy vz radius mass omegax omegay omegaz quatw "
                                  "quati quatj quatk pressure");
    const auto grain = numbers_of(lines[second + 11 + 3]);
    const Quaternion q = turned.orientation[3];
    EXPECT_EQ(std::vector<double>(grain.begin() + 13, grain.end()),
              (std::vector<double>{q.w, q.x, q.y, q.z, turned.pressure[3]}));
}

TEST(Vtp, TheIndexIsNearlyCompleteAndAtLastWhole) {
    const sample::Folder folder("vtp-index");
    const auto listed = [&] {
        std::size_t found = 0;
        for (const std::string& line : lines_of(folder / "trajectory.pvd"))
            found += has(line, "part=\"0\"") ? 1 : 0;
        return found;
    };
    std::size_t rewritten = 0, before = 0;
    {
        const auto writer = make_trajectory_writer(Trajectory::vtp, folder.path(), sample::scene());
        for (std::size_t n = 1; n <= 50; ++n) {
            writer->write(sample::row(static_cast<int>(n)));
            const std::size_t now = listed();
            EXPECT_GE(9 * now, 8 * n);
            rewritten += now != before ? 1 : 0;
            before = now;
        }
        EXPECT_LT(listed(), 50U);
        (void)writer->bookmark();
        EXPECT_EQ(listed(), 50U);
        writer->write(sample::row(51));
        EXPECT_EQ(listed(), 50U);
    }
    EXPECT_EQ(listed(), 51U); // a run that ends with an error leaves it so
    EXPECT_LT(rewritten, 30U);
}

TEST(Book, EveryNumberReadsBack) {
    const sample::Folder folder("book");
    const auto frames = sample::frames(sample::walled_row, 2);
    const auto lines = written(folder, Trajectory::book, "trajectory.book", frames);
    const scene::Scene scene = sample::scene();
    std::size_t at = 0;
    for (const analysis::Snapshot& s : frames) {
        ASSERT_LE(at + 9 + s.size(), lines.size());
        EXPECT_EQ(lines[at], "#NewFrame");
        EXPECT_EQ(lines[at + 1], "#no_of_particles: 8"); // seven grains and the wall's disc
        EXPECT_EQ(lines[at + 3], "#type: SphereXYPhiVxVyOmegaRMFixed25");
        EXPECT_EQ(numbers_of(after(lines[at + 4], "#gravity: ")), (std::vector<double>{0, -9.81, 0}));
        EXPECT_EQ(numbers_of(after(lines[at + 5], "#Time: "))[0], s.time);
        EXPECT_EQ(numbers_of(after(lines[at + 6], "#timestep: "))[0], scene.md.dt);
        EXPECT_EQ(lines[at + 7], "#EndOfHeader");
        at += 8;
        for (std::size_t i = 0; i < s.size(); ++i) {
            const scene::Material& m = scene.materials[static_cast<std::size_t>(s.material[i])];
            const auto record = numbers_of(lines[at++]);
            ASSERT_EQ(record.size(), 25U);
            EXPECT_EQ(std::vector<double>(record.begin(), record.begin() + 9),
                      (std::vector<double>{s.x[i], s.y[i], s.angle[i], s.vx[i], s.vy[i], s.omega[i],
                                           s.radius[i], s.mass[i], 0}));
            // 4Y/(3(1 - nu^2)) in another order of operations: a few ulps.
            EXPECT_DOUBLE_EQ(record[9], m.young / (1 - m.poisson * m.poisson) * 4 / 3);
            EXPECT_EQ(record[10], m.dissipation);
            EXPECT_EQ(record[11], m.friction);
        }
        EXPECT_EQ(numbers_of(lines[at++])[8], 1); // a wall grain
    }
    EXPECT_EQ(at, lines.size());
}
