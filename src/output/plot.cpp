#include "output/plot.hpp"

#include "output/canvas.hpp"
#include "output/picture_frame.hpp"
#include "output/plot_axis.hpp"

#include <fmt/format.h>

#include <vector>

namespace sandlane::output {

namespace {

std::string title(const analysis::LogColumn& column) {
    return column.unit == "1" || column.unit.empty() ? column.name
                                                     : fmt::format("{} ({})", column.name, column.unit);
}

} // namespace

std::string draw_plot(const analysis::Table& table, int width) {
    std::vector<double> xs, ys;
    PlotAxis across(table.logarithmic), up(table.logarithmic);
    for (const std::vector<double>& row : table.rows) {
        const double x = row[static_cast<std::size_t>(table.x)], y = row[static_cast<std::size_t>(table.y)];
        if (!across.shows(x) || !up.shows(y)) continue;
        across.include(x);
        up.include(y);
        xs.push_back(x);
        ys.push_back(y);
    }
    if (xs.size() < 2) return {};
    across.finish();
    up.finish();
    const double unit = width / 800.0;
    const int height = static_cast<int>(0.7 * width);
    const double left = 90 * unit, right = width - 20 * unit, top = 40 * unit, bottom = height - 60 * unit;
    constexpr Rgb grid{0.88F, 0.89F, 0.91F}, dot{0.15F, 0.35F, 0.65F};
    Canvas canvas(width, height, paper);
    for (const PlotAxis::Tick& t : across.ticks()) {
        const double x = left + t.share * (right - left);
        canvas.stroke(x, top, x, bottom, unit, grid);
        canvas.text(x, bottom + 20 * unit, 11 * unit, t.label, ink, Canvas::Anchor::middle);
    }
    for (const PlotAxis::Tick& t : up.ticks()) {
        const double y = bottom - t.share * (bottom - top);
        canvas.stroke(left, y, right, y, unit, grid);
        canvas.text(left - 8 * unit, y + 5 * unit, 11 * unit, t.label, ink, Canvas::Anchor::end);
    }
    canvas.stroke(left, bottom, right, bottom, 1.5 * unit, ink);
    canvas.stroke(left, top, left, bottom, 1.5 * unit, ink);
    const double radius = (xs.size() > 200 ? 1.2 : 3) * unit;
    for (std::size_t i = 0; i < xs.size(); ++i)
        canvas.disc(left + across.share(xs[i]) * (right - left), bottom - up.share(ys[i]) * (bottom - top),
                    radius, dot, dot, 0);
    canvas.text(right, bottom + 44 * unit, 13 * unit, title(table.columns[static_cast<std::size_t>(table.x)]),
                ink, Canvas::Anchor::end);
    canvas.text(left - 60 * unit, top - 16 * unit, 13 * unit,
                title(table.columns[static_cast<std::size_t>(table.y)]), ink);
    return canvas.png();
}

} // namespace sandlane::output
