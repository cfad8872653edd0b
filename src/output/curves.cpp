#include "output/curves.hpp"

#include "output/escape.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace sandlane::output {

namespace {

constexpr double width = 460, height = 300, left = 62, right = 12, top = 12, bottom = 42;
constexpr const char* colours[] = {"#1f77b4", "#d1495b", "#2c8a4b", "#8051a8", "#b8860b"};

// One axis: what is shown of it, and where its marks are.
class Axis {
public:
    Axis(bool log, double from, double to) : log_(log), from_(from), to_(to) {}

    [[nodiscard]] double measure(double v) const { return log_ ? std::log10(v) : v; }
    [[nodiscard]] bool shows(double v) const { return std::isfinite(v) && (!log_ || v > 0); }
    void include(double v) {
        if (!shows(v)) return;
        low_ = std::min(low_, measure(v));
        high_ = std::max(high_, measure(v));
    }
    [[nodiscard]] bool empty() const { return !(low_ <= high_); }
    void finish() {
        if (high_ == low_) low_ -= 0.5, high_ += 0.5;
        double step = std::pow(10.0, std::floor(std::log10((high_ - low_) / 4)));
        while ((high_ - low_) / step > 6) step *= (high_ - low_) / step > 12 ? 5 : 2;
        if (log_) step = std::max(1.0, std::ceil(step));
        for (double v = std::ceil(low_ / step - 1e-9) * step; v <= high_ + 1e-9 * step; v += step)
            marks_.push_back(std::abs(v) < 1e-9 * step ? 0 : v);
    }
    [[nodiscard]] double place(double measured) const {
        return from_ + (measured - low_) / (high_ - low_) * (to_ - from_);
    }
    [[nodiscard]] const std::vector<double>& marks() const { return marks_; }
    [[nodiscard]] std::string text(double mark) const {
        return log_ ? fmt::format("1e{:.0f}", mark) : fmt::format("{:.4g}", mark);
    }

private:
    bool log_;
    double from_, to_;
    double low_ = std::numeric_limits<double>::infinity(), high_ = -low_;
    std::vector<double> marks_;
};

} // namespace

std::string svg_of(const CurvePlot& plot) {
    Axis x(plot.log_x, left, width - right), y(plot.log_y, height - bottom, top);
    for (const Curve& c : plot.curves)
        for (std::size_t n = 0; n < c.x.size(); ++n)
            if (x.shows(c.x[n]) && y.shows(c.y[n])) {
                x.include(c.x[n]);
                y.include(c.y[n]);
            }
    if (x.empty() || y.empty()) return {};
    x.finish();
    y.finish();
    std::string svg =
        fmt::format(R"(<svg viewBox="0 0 {} {}" width="{}" font-size="11" fill="currentColor" role="img">)",
                    width, height, width);
    for (const double v : x.marks())
        svg += fmt::format(R"(<path d="M{0:.1f} {1}V{2}" stroke="currentColor" opacity="0.15"/>)"
                           R"(<text x="{0:.1f}" y="{3}" text-anchor="middle">{4}</text>)",
                           x.place(v), top, height - bottom, height - bottom + 15, x.text(v));
    for (const double v : y.marks())
        svg += fmt::format(R"(<path d="M{0} {1:.1f}H{2}" stroke="currentColor" opacity="0.15"/>)"
                           R"(<text x="{3}" y="{4:.1f}" text-anchor="end">{5}</text>)",
                           left, y.place(v), width - right, left - 6, y.place(v) + 4, y.text(v));
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
            const double px = x.place(x.measure(c.x[n])), py = y.place(y.measure(c.y[n]));
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
