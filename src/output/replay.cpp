#include "output/replay.hpp"

#include "core/bytes.hpp"
#include "core/hash.hpp"
#include "output/colours.hpp"
#include "output/wall_edges.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace sandlane::output {

using analysis::Snapshot;
using analysis::WallShape;

namespace {

// The bits of a hash choose the sample: the same grains in every frame, and no pattern of a lattice shows.
bool sampled(std::int64_t id, std::uint32_t every) {
    return (hash_bytes(&id, sizeof id).low & (every - 1)) == 0;
}

std::uint16_t place(double value, double lower, double upper) {
    const double unit = upper > lower ? (value - lower) / (upper - lower) : 0;
    return static_cast<std::uint16_t>(std::lround(std::clamp(unit, 0.0, 1.0) * 65535));
}

std::uint8_t turn(double angle) {
    if (!std::isfinite(angle)) return 0;
    const double turns = angle / (2 * std::numbers::pi);
    return static_cast<std::uint8_t>(std::lround((turns - std::floor(turns)) * 256) % 256);
}

// Rounded up, so that the scale and with it the levels of grains at rest stay as they are for many frames.
float scale_of(const std::vector<double>& values) {
    const double largest = largest_finite(values);
    return largest > 0 ? static_cast<float>(round_up(largest)) : 0;
}

std::uint8_t level_of(double value, float scale) {
    if (!(value > 0) || !std::isfinite(value) || scale <= 0) return 0;
    return static_cast<std::uint8_t>(std::lround(255 * std::sqrt(std::min(1.0, value / double{scale}))));
}

void append_wall(const WallShape& wall, std::vector<float>& numbers) {
    const auto add = [&](std::initializer_list<double> values) {
        for (const double value : values) numbers.push_back(static_cast<float>(value));
    };
    switch (wall.kind) {
    case WallShape::Kind::segment:
        add({0, wall.a.x, wall.a.y, wall.b.x, wall.b.y, 0});
        break;
    case WallShape::Kind::arc:
        add({1, wall.centre.x, wall.centre.y, wall.radius, wall.angle_from, wall.angle_to});
        break;
    case WallShape::Kind::disc:
        add({2, wall.centre.x, wall.centre.y, wall.radius, wall.angle, 0});
        break;
    case WallShape::Kind::triangle:
        add({3, wall.a.x, wall.a.y, wall.a.z, wall.b.x, wall.b.y, wall.b.z, wall.c.x, wall.c.y, wall.c.z,
             static_cast<double>(wall.wall)});
        break;
    }
}

void append_edge(const WallEdge& e, std::vector<float>& numbers) {
    for (const double value : {4.0, e.a.x, e.a.y, e.a.z, e.b.x, e.b.y, e.b.z, 0.0, 0.0, 0.0, 0.0})
        numbers.push_back(static_cast<float>(value));
}

// Borders and bends; of many the longest.
std::vector<WallEdge> replayed_edges(const std::vector<WallShape>& walls) {
    std::vector<WallEdge> edges = wall_edges(walls);
    std::erase_if(edges, [](const WallEdge& e) { return !e.is_sharp(); });
    if (edges.size() <= most_triangles) return edges;
    std::stable_sort(edges.begin(), edges.end(),
                     [](const WallEdge& a, const WallEdge& b) { return norm(a.b - a.a) > norm(b.b - b.a); });
    edges.resize(most_triangles);
    return edges;
}

void append_walls(const Snapshot& s, std::vector<float>& numbers) {
    if (s.dimension == 2 || s.walls.size() <= most_triangles)
        for (const WallShape& wall : s.walls) append_wall(wall, numbers);
    if (s.dimension == 3)
        for (const WallEdge& edge : replayed_edges(s.walls)) append_edge(edge, numbers);
}

template <class Vector> void put_vector(ByteWriter& writer, const Vector& values) {
    writer.put_array(values.data(), values.size());
}

ReplayFrame parse_frame(const std::string& bytes) {
    ByteReader reader(bytes);
    ReplayFrame f;
    f.time = reader.get<double>();
    f.grains = reader.get<std::uint32_t>();
    f.every = reader.get<std::uint32_t>();
    for (float& scale : f.scale) scale = reader.get<float>();
    reader.get_array(f.x);
    reader.get_array(f.y);
    reader.get_array(f.angle);
    for (auto& level : f.level) reader.get_array(level);
    reader.get_array(f.walls);
    if (!reader.at_end()) {
        f.dimension = 3;
        reader.get_array(f.z);
    }
    const bool space = f.dimension == 3;
    bool whole = reader.at_end() && f.y.size() == f.size() && f.z.size() == (space ? f.size() : 0) &&
                 f.angle.size() == (space ? 0 : f.size());
    for (const auto& level : f.level) whole = whole && level.size() == f.size();
    if (!whole || f.walls.size() % wall_numbers(f.dimension) != 0)
        fail(Exit::io, "arrays of different lengths");
    return f;
}

bool is_finite(Vec p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

} // namespace

ReplayFrame make_replay_frame(const Snapshot& s) {
    ReplayFrame f;
    f.time = s.time;
    f.dimension = s.dimension;
    f.grains = static_cast<std::uint32_t>(s.size());
    f.every = std::bit_ceil(static_cast<std::uint32_t>((s.size() + most_replayed - 1) / most_replayed));
    std::array<std::vector<double>, 4> values;
    for (std::size_t k = 0; k < values.size(); ++k) {
        values[k] = colour_values(s, static_cast<scene::Colour>(k));
        f.scale[k] = scale_of(values[k]);
    }
    for (std::size_t i = 0; i < s.size(); ++i) {
        if (!is_finite(s.position(i)) || !sampled(s.id[i], f.every)) continue;
        f.x.push_back(place(s.x[i], s.lower.x, s.upper.x));
        f.y.push_back(place(s.y[i], s.lower.y, s.upper.y));
        if (s.dimension == 3)
            f.z.push_back(place(s.z[i], s.lower.z, s.upper.z));
        else
            f.angle.push_back(turn(s.angle[i]));
        for (std::size_t k = 0; k < values.size(); ++k)
            f.level[k].push_back(level_of(values[k][i], f.scale[k]));
    }
    append_walls(s, f.walls);
    return f;
}

ReplayWriter::ReplayWriter(const std::filesystem::path& folder, const std::string& bookmark)
    : SingleFileWriter(folder / "replay.bin", bookmark) {}

void ReplayWriter::format(const Snapshot& snapshot, std::string& bytes) {
    const ReplayFrame f = make_replay_frame(snapshot);
    ByteWriter frame;
    frame.put(f.time);
    frame.put(f.grains);
    frame.put(f.every);
    for (const float scale : f.scale) frame.put(scale);
    put_vector(frame, f.x);
    put_vector(frame, f.y);
    put_vector(frame, f.angle);
    for (const auto& level : f.level) put_vector(frame, level);
    put_vector(frame, f.walls);
    if (f.dimension == 3) put_vector(frame, f.z);
    ByteWriter record;
    record.put_text(frame.bytes());
    bytes += record.bytes();
}

std::vector<ReplayFrame> read_replay(const std::filesystem::path& path) {
    return parse_replay(read_file(path), path);
}

std::vector<ReplayFrame> parse_replay(std::string_view bytes, const std::filesystem::path& path) {
    ByteReader reader(bytes);
    std::vector<ReplayFrame> frames;
    try {
        while (!reader.at_end()) frames.push_back(parse_frame(reader.get_text()));
    } catch (const Error&) {
        fail(Exit::io,
             "{}: frame {} is damaged. Run the scene again, or without a report (output.report=false).",
             path.string(), frames.size());
    }
    return frames;
}

} // namespace sandlane::output
