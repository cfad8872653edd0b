// replay.bin: the frames that report.html plays, quantised to nine bytes per grain, ten in space. It grows
// with the run like a trajectory, so that a resumed run keeps the frames before its checkpoint.
#pragma once

#include "output/single_file.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace sandlane::output {

struct ReplayFrame {
    double time = 0;          // s
    std::uint32_t grains = 0; // in the run
    std::uint32_t every = 1;  // about one of so many is in this frame, a power of two
    int dimension = 2;
    // Per grain in the frame. Position: 0 to 65535 between the edges of the domain, z in 3D; angle: a turn in
    // 256 steps, in 2D.
    std::vector<std::uint16_t> x, y, z;
    std::vector<std::uint8_t> angle;
    // Indexed by scene::Colour: value = scale (level/255)^2, which is finer where most values are.
    std::array<std::vector<std::uint8_t>, 4> level;
    std::array<float, 4> scale{};
    // wall_numbers() per wall: kind, then the ends of a segment | centre, radius, first and last angle of an
    // arc | centre, radius, angle of a disc | corners of a triangle, index of its wall | ends of an edge of
    // triangles.
    std::vector<float> walls;

    [[nodiscard]] std::size_t size() const { return x.size(); }
};

[[nodiscard]] constexpr std::size_t wall_numbers(int dimension) {
    return dimension == 3 ? 11 : 6;
}
inline constexpr std::size_t most_replayed = 10000; // grains in a frame; of more, a fixed sample is kept
// 3D. Walls of more triangles are replayed as their sharp edges; of more edges, the longest are kept.
inline constexpr std::size_t most_triangles = 2000;

// Grains without a finite position are left out; a value that is not finite counts as 0.
[[nodiscard]] ReplayFrame make_replay_frame(const analysis::Snapshot& snapshot);

// FOLDER/replay.bin. Throws Error(io) naming the file.
class ReplayWriter final : public SingleFileWriter {
public:
    explicit ReplayWriter(const std::filesystem::path& folder, const std::string& bookmark = {});

protected:
    void format(const analysis::Snapshot& snapshot, std::string& bytes) override;
};
[[nodiscard]] std::vector<ReplayFrame> read_replay(const std::filesystem::path& path);
[[nodiscard]] std::vector<ReplayFrame> parse_replay(std::string_view bytes,
                                                    const std::filesystem::path& path);

// Frames for the page: only what changed since the frame before, deflated.
struct PackedReplay {
    std::string bytes;
    std::size_t frames = 0;
    std::size_t stride = 1; // every stride-th frame is in
};
// Doubles the stride until the bytes are at most `budget` or one frame is left.
[[nodiscard]] PackedReplay pack_replay(const std::vector<ReplayFrame>& frames, std::size_t budget);

} // namespace sandlane::output
