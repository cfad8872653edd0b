#include "output/plot_axis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sandlane::output {

bool PlotAxis::shows(double value) const {
    return std::isfinite(value) && (!logarithmic_ || value > 0);
}

double PlotAxis::measure(double value) const {
    return logarithmic_ ? std::log10(value) : value;
}

void PlotAxis::include(double value) {
    low_ = std::min(low_, measure(value));
    high_ = std::max(high_, measure(value));
}

void PlotAxis::finish() {
    if (logarithmic_) {
        low_ = std::floor(low_);
        high_ = std::ceil(high_);
    }
    // What differs by rounding counts as equal.
    const double size = std::max(std::abs(low_), std::abs(high_));
    if (!(high_ - low_ > 1e-9 * size)) high_ = low_ + std::max(1.0, 1e-3 * size);
}

double PlotAxis::share(double value) const {
    return (measure(value) - low_) / (high_ - low_);
}

std::vector<PlotAxis::Tick> PlotAxis::ticks() const {
    const double range = high_ - low_;
    std::vector<Tick> found;
    if (logarithmic_) {
        const double step = std::max(1.0, std::ceil(range / 8));
        for (double decade = low_; decade <= high_; decade += step)
            found.push_back({(decade - low_) / range, fmt::format("1e{:.0f}", decade)});
        return found;
    }
    const double power = std::pow(10, std::floor(std::log10(range / 5)));
    double step = power;
    for (const double factor : {2.0, 5.0, 10.0})
        if (range / step > 7) step = factor * power;
    for (double at = std::ceil(low_ / step) * step; at <= high_ + 1e-9 * step; at += step)
        found.push_back({(at - low_) / range, fmt::format("{:.4g}", std::abs(at) < 1e-9 * step ? 0 : at)});
    return found;
}

} // namespace sandlane::output
