// PNG of a field of values, one colour per site or per block of sites, with colour bar and caption.
#pragma once

#include "analysis/field.hpp"

#include <cstdint>
#include <filesystem>
#include <string>

namespace sandlane::output {

// Where the colour scale of a field may end: its own `high`, else the value that one in a hundred exceeds,
// rounded up.
[[nodiscard]] double scale_of(const analysis::Field& field);

// high: end of the colour scale, of a signed field at both ends. Returns the bytes of the PNG.
[[nodiscard]] std::string draw_field(const analysis::Field& field, const std::string& caption, double high,
                                     int width);

// pictures/000000.png, 000001.png, ... of one run.
class FieldSeries {
public:
    // bookmark: empty for a new series, else what bookmark() returned before; pictures after it are removed.
    FieldSeries(std::filesystem::path folder, int width, const std::string& bookmark = {});

    void write(const analysis::Field& field, const std::string& caption);
    [[nodiscard]] std::int64_t count() const { return count_; }
    [[nodiscard]] std::string bookmark() const;

private:
    [[nodiscard]] std::filesystem::path file(std::int64_t number) const;

    std::filesystem::path folder_;
    int width_;
    double high_ = 0; // the largest scale so far: the colours do not flicker
    std::int64_t count_ = 0;
};

} // namespace sandlane::output
