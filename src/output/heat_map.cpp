#include "output/heat_map.hpp"

#include "core/file.hpp"
#include "output/picture_frame.hpp"

#include <fmt/format.h>

#include <cmath>

namespace sandlane::output {

void write_heat_map(const std::filesystem::path& path, const analysis::Grid& grid,
                    const std::vector<analysis::WallShape>& walls, const HeatMapStyle& style) {
    const View v = make_view(grid.lower, grid.upper, style.width);
    Canvas canvas(v.width, v.height, paper);
    draw_ground(canvas, v);
    const double largest = largest_finite(grid.values);
    const double high = style.scale_max > 0 ? style.scale_max : largest > 0 ? round_up(largest) : 1;
    const double wide = (v.right - v.left) / static_cast<double>(grid.columns);
    const double tall = (v.bottom - v.top) / static_cast<double>(grid.rows);
    for (std::size_t n = 0; n < grid.values.size(); ++n) {
        if (!(grid.values[n] > 0)) continue;
        const std::size_t at_column = n % grid.columns, at_row = n / grid.columns;
        const auto column = static_cast<double>(at_column), row = static_cast<double>(at_row);
        // On whole pixels: blended edges of neighbouring bins would show the ground between them.
        canvas.rectangle(std::round(v.left + column * wide), std::round(v.bottom - (row + 1) * tall),
                         std::round(v.left + (column + 1) * wide), std::round(v.bottom - row * tall),
                         map_colour(grid.values[n] / high));
    }
    clip_to_view(canvas, v);
    for (const analysis::WallShape& wall : walls) draw_wall(canvas, v, wall);
    canvas.clip_nothing();
    draw_scale_bar(canvas, v);
    const std::string unit = grid.unit.empty() ? "" : " (" + grid.unit + ")";
    draw_colour_bar(canvas, v, "0", fmt::format("{:.3g}", high), grid.label + unit);
    write_file_atomically(path, canvas.png());
}

} // namespace sandlane::output
