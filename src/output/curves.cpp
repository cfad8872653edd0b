#include "output/curves.hpp"

#include "output/escape.hpp"
#include "output/plot_axis.hpp"

#include <fmt/format.h>

#include <iterator>

namespace sandlane::output {

namespace {

constexpr double width = 460, height = 300, left = 62, right = 12, top = 12, bottom = 42;
constexpr const char* colours[] = {"#1f77b4", "#d1495b", "#2c8a4b", "#8051a8", "#b8860b"};

} // namespace

std::string svg_of(const CurvePlot& plot) {
    PlotAxis x(plot.log_x), y(plot.log_y);
    for (const Curve& c : plot.curves)
        for (std::size_t n = 0; n < c.x.size(); ++n)
            if (x.shows(c.x[n]) && y.shows(c.y[n])) {
                x.include(c.x[n]);
                y.include(c.y[n]);
            }
    if (x.empty() || y.empty()) return {};
    x.finish();
    y.finish();
    const auto across = [](double share) { return left + share * (width - right - left); };
    const auto up = [](double share) { return height - bottom - share * (height - bottom - top); };
    std::string svg =
        fmt::format(R"(<svg viewBox="0 0 {} {}" width="{}" font-size="11" fill="currentColor" role="img">)",
                    width, height, width);
    for (const PlotAxis::Tick& t : x.ticks())
        svg += fmt::format(R"(<path d="M{0:.1f} {1}V{2}" stroke="currentColor" opacity="0.15"/>)"
                           R"(<text x="{0:.1f}" y="{3}" text-anchor="middle">{4}</text>)",
                           across(t.share), top, height - bottom, height - bottom + 15, t.label);
    for (const PlotAxis::Tick& t : y.ticks())
        svg += fmt::format(R"(<path d="M{0} {1:.1f}H{2}" stroke="currentColor" opacity="0.15"/>)"
                           R"(<text x="{3}" y="{4:.1f}" text-anchor="end">{5}</text>)",
                           left, up(t.share), width - right, left - 6, up(t.share) + 4, t.label);
    svg += fmt::format(R"(<text x="{}" y="{}" text-anchor="middle">{}</text>)", (left + width) / 2,
                       height - 8, html_text(plot.x_label));
    svg += fmt::format(
        R"svg(<text x="14" y="{0}" text-anchor="middle" transform="rotate(-90 14 {0})">{1}</text>)svg",
        (top + height - bottom) / 2, html_text(plot.y_label));
    for (std::size_t k = 0; k < plot.curves.size(); ++k) {
        const Curve& c = plot.curves[k];
        const char* colour = colours[k % std::size(colours)];
        std::string line;
        for (std::size_t n = 0; n < c.x.size(); ++n) {
            if (!x.shows(c.x[n]) || !y.shows(c.y[n])) continue;
            const double px = across(x.share(c.x[n])), py = up(y.share(c.y[n]));
            if (c.points)
                svg += fmt::format(R"(<circle cx="{:.1f}" cy="{:.1f}" r="2.2" fill="{}"/>)", px, py, colour);
            else
                line += fmt::format("{}{:.1f} {:.1f}", line.empty() ? "M" : "L", px, py);
        }
        if (!line.empty())
            svg += fmt::format(R"(<path d="{}" fill="none" stroke="{}" stroke-width="1.5"/>)", line, colour);
        svg += fmt::format(R"(<text x="{}" y="{}" text-anchor="end" fill="{}">{}</text>)", width - right - 6,
                           top + 16 + 15 * static_cast<double>(k), colour, html_text(c.name));
    }
    return svg + "</svg>";
}

} // namespace sandlane::output
