#include "output/plot.hpp"

#include "output/canvas.hpp"
#include "output/picture_frame.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sandlane::output {

namespace {

// One axis: values to a share of its length, and its ticks.
struct PlotAxis {
    double low, high;
    bool logarithmic;

    PlotAxis(std::vector<double> values, bool logs) : logarithmic(logs) {
        const auto [least, most] = std::minmax_element(values.begin(), values.end());
        low = place(*least);
        high = place(*most);
        if (logs) {
            low = std::floor(low);
            high = std::ceil(high);
        }
        // Ticks need room between numbers: what differs by rounding counts as equal.
        const double size = std::max(std::abs(low), std::abs(high));
        if (!(high - low > 1e-9 * size)) high = low + std::max(1.0, 1e-3 * size);
    }
    [[nodiscard]] double place(double value) const { return logarithmic ? std::log10(value) : value; }
    [[nodiscard]] double share(double value) const { return (place(value) - low) / (high - low); }

    struct Tick {
        double share;
        std::string label;
    };
    [[nodiscard]] std::vector<Tick> ticks() const {
        std::vector<Tick> found;
        if (logarithmic) {
            const double step = std::max(1.0, std::ceil((high - low) / 8));
            for (double decade = low; decade <= high; decade += step)
                found.push_back({(decade - low) / (high - low), fmt::format("1e{:.0f}", decade)});
            return found;
        }
        const double power = std::pow(10, std::floor(std::log10((high - low) / 5)));
        double step = power;
        for (const double factor : {2.0, 5.0, 10.0})
            if ((high - low) / step > 7) step = factor * power;
        for (double at = std::ceil(low / step) * step; at <= high + 1e-9 * step; at += step)
            found.push_back(
                {(at - low) / (high - low), fmt::format("{:.4g}", std::abs(at) < 1e-9 * step ? 0 : at)});
        return found;
    }
};

std::string title(const analysis::LogColumn& column) {
    return column.unit == "1" || column.unit.empty() ? column.name
                                                     : fmt::format("{} ({})", column.name, column.unit);
}

} // namespace

std::string draw_plot(const analysis::Table& table, int width) {
    std::vector<double> xs, ys;
    for (const std::vector<double>& row : table.rows) {
        const double x = row[static_cast<std::size_t>(table.x)], y = row[static_cast<std::size_t>(table.y)];
        if (!std::isfinite(x) || !std::isfinite(y) || (table.logarithmic && !(x > 0 && y > 0))) continue;
        xs.push_back(x);
        ys.push_back(y);
    }
    if (xs.size() < 2) return {};
    const PlotAxis across(xs, table.logarithmic), up(ys, table.logarithmic);
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
