// One axis of a plot: what is shown of it, and where its ticks are.
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace sandlane::output {

class PlotAxis {
public:
    explicit PlotAxis(bool logarithmic) : logarithmic_(logarithmic) {}

    // Finite, and positive on a logarithmic axis.
    [[nodiscard]] bool shows(double value) const;
    void include(double value); // that it shows
    [[nodiscard]] bool empty() const { return !(low_ <= high_); }
    // After the last value: whole decades of a logarithmic axis, and room between equal numbers.
    void finish();

    // Place of a value, 0 at the lower end of the axis and 1 at the upper one.
    [[nodiscard]] double share(double value) const;
    struct Tick {
        double share;
        std::string label;
    };
    [[nodiscard]] std::vector<Tick> ticks() const;

private:
    [[nodiscard]] double measure(double value) const;

    bool logarithmic_;
    double low_ = std::numeric_limits<double>::infinity(), high_ = -low_;
};

} // namespace sandlane::output
