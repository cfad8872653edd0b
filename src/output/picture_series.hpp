// pictures/000000.png, 000001.png, ... of one run, with a colour scale that does not flicker.
#pragma once

#include "output/picture.hpp"

#include <cstdint>
#include <filesystem>
#include <string>

namespace sandlane::output {

class PictureSeries {
public:
    // folder: the one of the pictures, created with the first. bookmark: empty for a new series, else what
    // bookmark() returned before; pictures after it are removed.
    // Throws Error(io) naming the folder.
    PictureSeries(std::filesystem::path folder, const scene::Scene& scene, const std::string& bookmark = {});

    void write(const analysis::Snapshot& snapshot);
    [[nodiscard]] std::int64_t count() const { return count_; }
    [[nodiscard]] std::string bookmark() const; // number of pictures and end of the scale

private:
    [[nodiscard]] std::filesystem::path file(std::int64_t number) const;
    void restore(const std::string& bookmark);

    std::filesystem::path folder_;
    PictureStyle style_; // scale_max: the largest usual_high() so far, rounded up
    std::int64_t count_ = 0;
};

} // namespace sandlane::output
