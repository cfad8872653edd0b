// Curves over a pair of axes as a picture of vectors, for the report.
#pragma once

#include <string>
#include <vector>

namespace sandlane::output {

struct Curve {
    std::string name;
    std::vector<double> x,
        y;               // values that are not finite, or not positive on an axis of logarithms, are left out
    bool points = false; // dots instead of a line
};

struct CurvePlot {
    std::string x_label, y_label;
    bool log_x = false, log_y = false;
    std::vector<Curve> curves;
};

// SVG that stands in a page; empty if there is nothing to show.
[[nodiscard]] std::string svg_of(const CurvePlot& plot);

} // namespace sandlane::output
