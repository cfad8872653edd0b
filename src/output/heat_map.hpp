// PNG of values on a grid over the plane, with the walls; bins with nothing in them stay empty.
#pragma once

#include "analysis/analysis.hpp"

#include <filesystem>

namespace sandlane::output {

struct HeatMapStyle {
    int width = 800;      // pixels
    double scale_max = 0; // upper end of the colour scale; 0: the largest value, rounded up
};

void write_heat_map(const std::filesystem::path& path, const analysis::Grid& grid,
                    const std::vector<analysis::WallShape>& walls, const HeatMapStyle& style);

} // namespace sandlane::output
