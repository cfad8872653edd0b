// PNG of two columns of a table: points, axes, decades.
#pragma once

#include "analysis/field.hpp"

#include <string>

namespace sandlane::output {

// Columns table.x and table.y; points that a logarithmic axis has no place for are left out. Returns the
// bytes of the PNG; empty if there are fewer than two points.
[[nodiscard]] std::string draw_plot(const analysis::Table& table, int width);

} // namespace sandlane::output
