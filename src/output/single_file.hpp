// Common part of the formats that keep all frames in one growing text file: a subclass formats one frame.
#pragma once

#include "core/file.hpp"
#include "output/text.hpp"
#include "output/writers.hpp"

namespace sandlane::output {

// How a grain turns: spin and angle in the plane, the angular velocity in space.
inline void append_spin(const analysis::Snapshot& s, std::size_t i, std::string& text) {
    if (s.dimension == 2)
        append_numbers(text, s.omega[i], s.angle[i]);
    else
        append_numbers(text, s.omega_x[i], s.omega_y[i], s.omega[i]);
}

class SingleFileWriter : public TrajectoryWriter {
public:
    void write(const analysis::Snapshot& snapshot) final;
    std::string bookmark() final; // the length of the file

protected:
    SingleFileWriter(const std::filesystem::path& path, const std::string& bookmark);
    virtual void format(const analysis::Snapshot& snapshot, std::string& text) = 0;
    // Between two lines of a frame: writes what there is if it is much, so that no frame is whole in memory.
    void pass_on(std::string& text);

private:
    OutputFile file_;
    std::string text_; // kept between frames, if it is small, so that its memory is reused
};

// -1 for an empty bookmark, else the length it holds. Throws Error(io) naming the path.
[[nodiscard]] std::int64_t length_in(const std::string& bookmark, const std::filesystem::path& path);

// Wall discs stand beside the grains in some formats; their ids start here, above any grain's.
inline constexpr std::int64_t first_wall_id = 1'000'000'000;

// Extent along z, m. Formats that know only boxes give a plane the depth of its largest grain.
struct DepthRange {
    double bottom, top;
};
[[nodiscard]] DepthRange depth_range(const analysis::Snapshot& snapshot);

} // namespace sandlane::output
