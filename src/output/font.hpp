// A font of our own, drawn as dots on a grid of 5 x 7 (with two rows below the baseline). Dots that are
// neighbours are joined by lines, which the canvas draws with round ends at any size.
#pragma once

#include <string_view>
#include <vector>

namespace sandlane::output {

inline constexpr int glyph_height = 7; // rows from the top of a capital to the baseline
inline constexpr double glyph_gap = 1.9;

struct GlyphLine {
    double x0, y0, x1, y1; // in cells, from the top left dot; a dot alone is a line of length 0
};
struct Glyph {
    std::vector<GlyphLine> lines;
    double width = 0; // distance between the first and the last column of dots
};

[[nodiscard]] const Glyph& glyph(char c);                // an unknown character looks like a box
[[nodiscard]] double text_width(std::string_view words); // in cells

} // namespace sandlane::output
