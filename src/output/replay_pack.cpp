// Frames as the page reads them (page/replay.js). Little-endian: time (float64), grains, grains in the frame
// (uint32), four scales (float32), walls (uint32; unchanged: same as in the frame before) and their numbers
// (float32); then planes of one byte per grain: x low, x high, y low, y high, in 2D angle, in 3D z low, z
// high, four levels. Planes hold differences to the frame before: grains at rest become zeros, which deflate
// to nothing.
#include "core/error.hpp"
#include "output/replay.hpp"

#include <zlib.h>

#include <algorithm>
#include <cstring>

namespace sandlane::output {

namespace {

constexpr std::uint32_t unchanged = 0xFFFFFFFF;

template <class Number> void put(std::string& bytes, Number value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

// Difference modulo the range of the type; where the frame before has fewer grains, to 0.
template <class Number>
std::vector<Number> differences(const std::vector<Number>& now, const std::vector<Number>& before) {
    std::vector<Number> out = now;
    for (std::size_t i = 0; i < std::min(now.size(), before.size()); ++i)
        out[i] = static_cast<Number>(now[i] - before[i]);
    return out;
}

void put_plane(std::string& bytes, const std::vector<std::uint8_t>& plane) {
    bytes.append(plane.begin(), plane.end());
}

void put_planes(std::string& bytes, const std::vector<std::uint16_t>& values) {
    for (const int shift : {0, 8})
        for (const std::uint16_t value : values) bytes.push_back(static_cast<char>(value >> shift & 0xFF));
}

void put_frame(std::string& bytes, const ReplayFrame& f, const ReplayFrame& before, bool first) {
    put(bytes, f.time);
    put(bytes, f.grains);
    put(bytes, static_cast<std::uint32_t>(f.size()));
    for (const float scale : f.scale) put(bytes, scale);
    if (!first && f.walls == before.walls) {
        put(bytes, unchanged);
    } else {
        put(bytes, static_cast<std::uint32_t>(f.walls.size() / wall_numbers(f.dimension)));
        for (const float number : f.walls) put(bytes, number);
    }
    put_planes(bytes, differences(f.x, before.x));
    put_planes(bytes, differences(f.y, before.y));
    put_planes(bytes, differences(f.z, before.z));
    put_plane(bytes, differences(f.angle, before.angle)); // z or angle is empty
    for (std::size_t k = 0; k < f.level.size(); ++k)
        put_plane(bytes, differences(f.level[k], before.level[k]));
}

std::string deflated(const std::string& bytes) {
    uLongf size = ::compressBound(bytes.size());
    std::string out(size, '\0');
    if (::compress2(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                    bytes.size(), Z_DEFAULT_COMPRESSION) != Z_OK)
        fail(Exit::internal, "replay: {} bytes cannot be compressed", bytes.size());
    out.resize(size);
    return out;
}

PackedReplay pack_every(const std::vector<ReplayFrame>& frames, std::size_t stride) {
    static const ReplayFrame nothing;
    PackedReplay packed;
    packed.stride = stride;
    const ReplayFrame* before = &nothing;
    std::string bytes;
    for (std::size_t at = 0; at < frames.size(); at += stride) {
        put_frame(bytes, frames[at], *before, at == 0);
        before = &frames[at];
        ++packed.frames;
    }
    packed.bytes = deflated(bytes);
    return packed;
}

} // namespace

PackedReplay pack_replay(const std::vector<ReplayFrame>& frames, std::size_t budget) {
    PackedReplay packed = pack_every(frames, 1);
    while (packed.bytes.size() > budget && packed.frames > 1) packed = pack_every(frames, 2 * packed.stride);
    return packed;
}

} // namespace sandlane::output
