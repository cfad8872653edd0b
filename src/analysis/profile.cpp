// Averages over strips across an axis: density, velocity, granular temperature, pressure. A grain counts to
// the strip of its centre.
#include "analysis/analysis.hpp"
#include "analysis/region.hpp"

#include <algorithm>
#include <array>

namespace sandlane::analysis {

namespace {

class Profile : public Average {
public:
    Profile(Region region, scene::Axis axis, std::size_t bins)
        : Average(bins * fields), region_(region), along_x_(axis == scene::Axis::x), bins_(bins) {}

    [[nodiscard]] std::vector<LogColumn> columns() const override {
        return {{along_x_ ? "x" : "y", "m"}, {"grains", "1"},       {"density", "kg/m^2"},
                {"velocity_x", "m/s"},       {"velocity_y", "m/s"}, {"temperature", "m^2/s^2"},
                {"pressure", "N/m"}};
    }

    void add(const Frame& frame) override {
        const Snapshot& s = frame.grains;
        ++frames_;
        for (std::size_t i = 0; i < s.size(); ++i) {
            const Vec p{s.x[i], s.y[i], 0};
            if (!region_.contains(p)) continue;
            const double at = (along_x_ ? p.x : p.y) - start();
            const auto bin = std::min(bins_ - 1, static_cast<std::size_t>(at / width()));
            const double m = s.mass[i];
            const std::array<double, fields> values{
                1, m, m * s.vx[i], m * s.vy[i], m * (s.vx[i] * s.vx[i] + s.vy[i] * s.vy[i]), s.pressure[i]};
            for (std::size_t f = 0; f < fields; ++f) sums_[bin * fields + f] += values[f];
        }
    }

    [[nodiscard]] Rows rows() const override {
        const double area = region_.area() / static_cast<double>(bins_);
        Rows rows;
        for (std::size_t b = 0; b < bins_; ++b) {
            const double* sum = sums_.data() + b * fields;
            const double count = sum[0], mass = sum[1];
            const double vx = mass > 0 ? sum[2] / mass : 0, vy = mass > 0 ? sum[3] / mass : 0;
            // Half the mean square of the velocity relative to the mean of the strip.
            const double temperature = mass > 0 ? 0.5 * (sum[4] / mass - vx * vx - vy * vy) : 0;
            rows.push_back({start() + (static_cast<double>(b) + 0.5) * width(), per_frame(count),
                            per_frame(mass) / area, vx, vy, std::max(0.0, temperature),
                            count > 0 ? sum[5] / count : 0});
        }
        return rows;
    }

private:
    static constexpr std::size_t fields = 6; // count, m, m vx, m vy, m v^2, pressure

    [[nodiscard]] double start() const { return along_x_ ? region_.lower.x : region_.lower.y; }
    [[nodiscard]] double width() const {
        return (along_x_ ? region_.size().x : region_.size().y) / static_cast<double>(bins_);
    }

    Region region_;
    bool along_x_;
    std::size_t bins_;
};

} // namespace

std::unique_ptr<Analysis> make_profile(const scene::Scene& scene, const scene::AnalysisSpec& spec) {
    const std::size_t bins = spec.bins > 0 ? static_cast<std::size_t>(spec.bins) : 50;
    return std::make_unique<Profile>(region_of(scene, spec), spec.axis, bins);
}

} // namespace sandlane::analysis
