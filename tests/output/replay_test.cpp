#include "output/replay.hpp"

#include "core/bytes.hpp"
#include "core/rng.hpp"
#include "output/colours.hpp"
#include "output/sample.hpp"
#include "output/support.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

using namespace sandlane;
using namespace sandlane::output;

namespace {

// Grains anywhere, everything random: nothing to gain by compression.
analysis::Snapshot noise(int frame, int grains) {
    analysis::Snapshot s = sample::empty(frame);
    const Random random(5, Stream::position, static_cast<std::uint32_t>(frame));
    const auto number = [&](int i, int k) { return random.uniform(static_cast<std::uint64_t>(10 * i + k)); };
    for (int i = 0; i < grains; ++i)
        sample::add_grain(s, 0.2 * number(i, 0), 0.1 * number(i, 1), 0.001 + 0.001 * number(i, 2),
                          number(i, 3), number(i, 4), 9 * number(i, 5), 99 * number(i, 6),
                          500 * number(i, 7));
    return s;
}

analysis::Snapshot noise_in_space(int frame, int grains) {
    const analysis::Snapshot plane = noise(frame, grains);
    analysis::Snapshot s = sample::empty_space(frame);
    const Random random(7, Stream::position, static_cast<std::uint32_t>(frame));
    for (std::size_t i = 0; i < plane.size(); ++i)
        sample::add_sphere(s, {plane.x[i], plane.y[i], -0.05 + 0.2 * random.uniform(i)}, plane.radius[i],
                           {plane.vx[i], plane.vy[i], 1}, {0, plane.omega[i], 2}, plane.pressure[i]);
    return s;
}

// Strips of a folded sheet.
std::vector<analysis::WallShape> sheet(int strips) {
    std::vector<analysis::WallShape> walls;
    for (int n = 0; n < strips; ++n) {
        const double x = 0.1 * n, next = 0.1 * (n + 1), low = 0.1 * (n % 2), high = 0.1 * ((n + 1) % 2);
        walls.push_back(sample::triangle({x, 0, low}, {next, 0, high}, {next, 1, high}));
        walls.push_back(sample::triangle({x, 0, low}, {next, 1, high}, {x, 1, low}));
    }
    return walls;
}

std::string inflated(const std::string& bytes, std::size_t room) {
    std::string out(room, '\0');
    uLongf size = room;
    EXPECT_EQ(::uncompress(reinterpret_cast<Bytef*>(out.data()), &size,
                           reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()),
              Z_OK);
    out.resize(size);
    return out;
}

template <class Number>
std::vector<Number> read_planes(ByteReader& reader, std::size_t count, const std::vector<Number>& before) {
    std::vector<Number> values(count);
    for (std::size_t byte = 0; byte < sizeof(Number); ++byte)
        for (Number& value : values)
            value = static_cast<Number>(value | reader.get<std::uint8_t>() << 8 * byte);
    for (std::size_t i = 0; i < std::min(count, before.size()); ++i)
        values[i] = static_cast<Number>(values[i] + before[i]);
    return values;
}

// As page/replay-data.js does it.
ReplayFrame read_frame(ByteReader& reader, const ReplayFrame& before, int dimension) {
    ReplayFrame f;
    f.dimension = dimension;
    f.time = reader.get<double>();
    f.grains = reader.get<std::uint32_t>();
    const std::size_t count = reader.get<std::uint32_t>();
    for (float& scale : f.scale) scale = reader.get<float>();
    const auto walls = reader.get<std::uint32_t>();
    if (walls == 0xFFFFFFFF)
        f.walls = before.walls;
    else
        for (std::size_t n = 0; n < walls * wall_numbers(dimension); ++n)
            f.walls.push_back(reader.get<float>());
    f.x = read_planes(reader, count, before.x);
    f.y = read_planes(reader, count, before.y);
    if (dimension == 3)
        f.z = read_planes(reader, count, before.z);
    else
        f.angle = read_planes(reader, count, before.angle);
    for (std::size_t k = 0; k < 4; ++k) f.level[k] = read_planes(reader, count, before.level[k]);
    return f;
}

void expect_same(const ReplayFrame& a, const ReplayFrame& b) {
    EXPECT_EQ(a.time, b.time);
    EXPECT_EQ(a.grains, b.grains);
    EXPECT_EQ(a.x, b.x);
    EXPECT_EQ(a.y, b.y);
    EXPECT_EQ(a.dimension, b.dimension);
    EXPECT_EQ(a.z, b.z);
    EXPECT_EQ(a.angle, b.angle);
    EXPECT_EQ(a.level, b.level);
    EXPECT_EQ(a.scale, b.scale);
    EXPECT_EQ(a.walls, b.walls);
}

void expect_unpacked(const std::vector<ReplayFrame>& frames) {
    const PackedReplay packed = pack_replay(frames, 1'000'000);
    EXPECT_EQ(packed.stride, 1U);
    ASSERT_EQ(packed.frames, frames.size());
    const std::string bytes = inflated(packed.bytes, 100'000);
    ByteReader reader(bytes);
    ReplayFrame before;
    for (const ReplayFrame& frame : frames) {
        before = read_frame(reader, before, frame.dimension);
        expect_same(before, frame);
    }
    EXPECT_TRUE(reader.at_end());
}

} // namespace

TEST(Replay, RoundingIsHalfAStep) {
    const analysis::Snapshot s = noise(0, 500);
    const ReplayFrame f = make_replay_frame(s);
    ASSERT_EQ(f.size(), s.size());
    EXPECT_EQ(f.every, 1U);
    const double slack = 1 + 1e-9; // of the computations here
    for (std::size_t i = 0; i < s.size(); ++i) {
        EXPECT_NEAR(f.x[i] / 65535.0 * 0.2, s.x[i], 0.2 / 65535 / 2 * slack);
        EXPECT_NEAR(f.y[i] / 65535.0 * 0.1, s.y[i], 0.1 / 65535 / 2 * slack);
        EXPECT_GT(std::cos(f.angle[i] * M_PI / 128 - s.angle[i]), std::cos(M_PI / 256 * (1 + 1e-6)));
    }
    for (std::size_t k = 0; k < 4; ++k) {
        const auto values = colour_values(s, static_cast<scene::Colour>(k));
        for (std::size_t i = 0; i < s.size(); ++i)
            EXPECT_NEAR(f.level[k][i] / 255.0, std::sqrt(values[i] / f.scale[k]),
                        0.5 / 255 * (1 + 1e-5)); // float scale
    }
}

TEST(Replay, BrokenNumbersAreLeftOut) {
    analysis::Snapshot s = sample::row(1);
    s.x[0] = NAN;
    s.y[1] = INFINITY;
    s.vx[2] = NAN;
    s.angle[3] = NAN;
    s.pressure[4] = INFINITY;
    const ReplayFrame f = make_replay_frame(s);
    EXPECT_EQ(f.size(), s.size() - 2);
    EXPECT_EQ(f.grains, s.size());
    EXPECT_EQ(f.level[0][0], 0);
    EXPECT_EQ(f.angle[1], 0);
    EXPECT_EQ(f.level[1][2], 0);
}

TEST(Replay, OfManyGrainsTheSameSampleIsKept) {
    analysis::Snapshot s = noise(0, 100'000);
    const ReplayFrame first = make_replay_frame(s);
    EXPECT_EQ(first.every, 16U);
    EXPECT_EQ(first.grains, 100'000U);
    // Binomial: 6250 with a standard deviation of 77.
    EXPECT_NEAR(static_cast<double>(first.size()), 6250, 5 * 77);
    const double shift = 0.01;
    for (double& y : s.y) y = std::fmod(y + shift, 0.1);
    const ReplayFrame second = make_replay_frame(s);
    EXPECT_EQ(second.x, first.x); // the same grains in the same order
    EXPECT_NE(second.y, first.y);
}

TEST(Replay, FileReadsBack) {
    const sample::Folder folder("replay");
    const auto frames = sample::frames(sample::walled_row, 4);
    ReplayWriter writer(folder.path());
    for (const auto& frame : frames) writer.write(frame);
    writer.write(sample::empty(9));
    const auto read = read_replay(folder / "replay.bin");
    ASSERT_EQ(read.size(), 5U);
    for (std::size_t n = 0; n < 4; ++n) expect_same(read[n], make_replay_frame(frames[n]));
    EXPECT_EQ(read[4].size(), 0U);
}

TEST(Replay, EveryTruncationInsideAFrameIsRefused) {
    const sample::Folder folder("replay-truncated");
    std::size_t first = 0;
    {
        ReplayWriter writer(folder.path());
        writer.write(sample::walled_row(0));
        first = std::stoul(writer.bookmark());
        writer.write(sample::walled_row(1));
    }
    const std::filesystem::path file = folder / "replay.bin";
    for (std::size_t length = std::filesystem::file_size(file) - 1; length > 0; --length) {
        std::filesystem::resize_file(file, length);
        if (length == first) continue;
        EXPECT_TRUE(has(refusal(Exit::io, [&] { (void)read_replay(file); }), "replay.bin: frame"));
    }
}

TEST(Replay, PackedFramesUnpack) {
    auto frames = sample::frames([](int n) { return make_replay_frame(sample::walled_row(n)); }, 5);
    frames.push_back(frames.back()); // walls that stand still
    frames.push_back(make_replay_frame(noise(6, 3)));
    frames.push_back(make_replay_frame(noise(7, 50)));
    frames.push_back(make_replay_frame(sample::empty(8)));
    expect_unpacked(frames);
}

TEST(Replay, FramesAreThinnedToTheBudget) {
    const auto frames = sample::frames([](int n) { return make_replay_frame(noise(n, 200)); }, 33);
    const std::size_t whole = pack_replay(frames, 1 << 30).bytes.size();
    const PackedReplay packed = pack_replay(frames, whole / 3);
    EXPECT_LE(packed.bytes.size(), whole / 3);
    EXPECT_EQ(packed.stride, 4U);
    EXPECT_EQ(packed.frames, 9U); // 0, 4, ..., 32
    EXPECT_EQ(pack_replay(frames, 0).frames, 1U);
    EXPECT_EQ(pack_replay({}, 1000).frames, 0U);
}

TEST(Replay, GrainsAtRestCostNothing) {
    const std::vector<ReplayFrame> frames(100, make_replay_frame(noise(0, 1000)));
    // One frame of noise is 9000 bytes that do not shrink, and headers; the other 99 together less than that.
    EXPECT_LT(pack_replay(frames, 1 << 30).bytes.size(), 18'000U);
}

// ---- in space

TEST(ReplayInSpace, RoundingIsHalfAStep) {
    const analysis::Snapshot s = noise_in_space(0, 500);
    const ReplayFrame f = make_replay_frame(s);
    ASSERT_EQ(f.size(), s.size());
    ASSERT_EQ(f.z.size(), s.size());
    EXPECT_TRUE(f.angle.empty());
    const double slack = 1 + 1e-9; // of the computations here
    for (std::size_t i = 0; i < s.size(); ++i)
        EXPECT_NEAR(-0.05 + f.z[i] / 65535.0 * 0.2, s.z[i], 0.2 / 65535 / 2 * slack);
}

TEST(ReplayInSpace, SpeedAndSpinHaveThreeComponents) {
    analysis::Snapshot s = sample::empty_space();
    sample::add_sphere(s, {0.1, 0.05, 0}, 0.01, {2, 3, 6}, {1, 4, 8});
    const ReplayFrame f = make_replay_frame(s);
    EXPECT_EQ(f.level[0][0], std::lround(255 * std::sqrt(7.0 / f.scale[0])));
    EXPECT_EQ(f.level[2][0], std::lround(255 * std::sqrt(9.0 / f.scale[2])));
}

TEST(ReplayInSpace, FileReadsBack) {
    const sample::Folder folder("replay-space");
    const auto frames = sample::frames(sample::space_row, 4);
    ReplayWriter writer(folder.path());
    for (const auto& frame : frames) writer.write(frame);
    writer.write(sample::empty_space(9));
    const auto read = read_replay(folder / "replay.bin");
    ASSERT_EQ(read.size(), 5U);
    for (std::size_t n = 0; n < 4; ++n) expect_same(read[n], make_replay_frame(frames[n]));
    EXPECT_EQ(read[4].dimension, 3);
}

TEST(ReplayInSpace, PackedFramesUnpack) {
    auto frames = sample::frames([](int n) { return make_replay_frame(sample::space_row(n)); }, 5);
    frames.push_back(frames.back()); // walls that stand still
    frames.push_back(make_replay_frame(noise_in_space(6, 50)));
    frames.push_back(make_replay_frame(sample::empty_space(8)));
    expect_unpacked(frames);
}

TEST(ReplayInSpace, BrokenNumbersAreLeftOut) {
    analysis::Snapshot s = sample::space_row(1);
    s.z[0] = NAN;
    s.vz[1] = NAN;
    const ReplayFrame f = make_replay_frame(s);
    EXPECT_EQ(f.size(), s.size() - 1);
    EXPECT_EQ(f.level[0][0], 0);
}

// Kinds 3 and 4 are triangles and edges.
TEST(ReplayInSpace, WallsAreTrianglesAndEdgesOrOnlyEdges) {
    const auto kinds = [](int strips) {
        analysis::Snapshot s = sample::empty_space();
        s.walls = sheet(strips);
        const ReplayFrame f = make_replay_frame(s);
        std::array<std::size_t, 5> count{};
        for (std::size_t n = 0; n < f.walls.size(); n += wall_numbers(3))
            ++count[static_cast<std::size_t>(f.walls[n])];
        return count;
    };
    // Of each strip two triangles; two rims and the folds between, but no diagonals.
    EXPECT_EQ(kinds(10), (std::array<std::size_t, 5>{0, 0, 0, 20, 31}));
    EXPECT_EQ(kinds(1000), (std::array<std::size_t, 5>{0, 0, 0, 2000, 2000}));
    EXPECT_EQ(kinds(1001), (std::array<std::size_t, 5>{0, 0, 0, 0, 2000}));
}
