// Averages over strips (in 3D: layers) across an axis: density, velocity, granular temperature, pressure. A
// grain counts to the strip of its centre; in 3D its volume is shared out to the layers that cut it.
#include "analysis/analysis.hpp"
#include "analysis/region.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace sandlane::analysis {

namespace {

class Strips : public Average {
protected:
    Strips(Region region, scene::Axis axis, std::size_t bins, std::size_t fields)
        : Average(bins * fields), region_(region), axis_(axis), bins_(bins), fields_(fields) {}

    [[nodiscard]] double start() const { return component(region_.lower, axis_); }
    [[nodiscard]] double width() const {
        return component(region_.size(), axis_) / static_cast<double>(bins_);
    }
    [[nodiscard]] double middle(std::size_t bin) const {
        return start() + (static_cast<double>(bin) + 0.5) * width();
    }
    [[nodiscard]] double measure() const { return region_.measure() / static_cast<double>(bins_); }
    [[nodiscard]] std::size_t bin_of(Vec p) const {
        return std::min(bins_ - 1, static_cast<std::size_t>((component(p, axis_) - start()) / width()));
    }
    [[nodiscard]] const double* sums(std::size_t bin) const { return sums_.data() + bin * fields_; }
    template <std::size_t n> void add_to(std::size_t bin, const std::array<double, n>& values) {
        for (std::size_t f = 0; f < n; ++f) sums_[bin * fields_ + f] += values[f];
    }

    Region region_;
    scene::Axis axis_;
    std::size_t bins_, fields_;
};

class PlaneProfile final : public Strips {
public:
    PlaneProfile(Region region, scene::Axis axis, std::size_t bins) : Strips(region, axis, bins, fields) {}

    [[nodiscard]] std::vector<LogColumn> columns() const override {
        return {{axis_name(axis_), "m"}, {"grains", "1"},       {"density", "kg/m^2"},
                {"velocity_x", "m/s"},   {"velocity_y", "m/s"}, {"temperature", "m^2/s^2"},
                {"pressure", "N/m"}};
    }

    void add(const Frame& frame) override {
        const Snapshot& s = frame.grains;
        ++frames_;
        for (std::size_t i = 0; i < s.size(); ++i) {
            const Vec p = s.position(i);
            if (!region_.contains(p)) continue;
            const double m = s.mass[i];
            add_to(bin_of(p), std::array{1.0, m, m * s.vx[i], m * s.vy[i],
                                         m * (s.vx[i] * s.vx[i] + s.vy[i] * s.vy[i]), s.pressure[i]});
        }
    }

    [[nodiscard]] Rows rows() const override {
        Rows rows;
        for (std::size_t b = 0; b < bins_; ++b) {
            const double* sum = sums(b);
            const double count = sum[0], mass = sum[1];
            const double vx = mass > 0 ? sum[2] / mass : 0, vy = mass > 0 ? sum[3] / mass : 0;
            // Half the mean square of the velocity relative to the mean of the strip.
            const double temperature = mass > 0 ? 0.5 * (sum[4] / mass - vx * vx - vy * vy) : 0;
            rows.push_back({middle(b), per_frame(count), per_frame(mass) / measure(), vx, vy,
                            std::max(0.0, temperature), count > 0 ? sum[5] / count : 0});
        }
        return rows;
    }

private:
    static constexpr std::size_t fields = 6; // count, m, m vx, m vy, m v^2, pressure
};

// Part of the unit sphere's volume that lies below a height.
double share_below(double height) {
    const double h = std::clamp(height, -1.0, 1.0);
    return 0.25 * (2 + h * (3 - h * h));
}

class SpaceProfile final : public Strips {
public:
    // periodic: the first layer follows the last.
    SpaceProfile(Region region, scene::Axis axis, std::size_t bins, bool periodic)
        : Strips(region, axis, bins, fields), periodic_(periodic) {}

    [[nodiscard]] std::vector<LogColumn> columns() const override {
        return {{axis_name(axis_), "m"},      {"grains", "1"},
                {"packing_fraction", "1"},    {"density", "kg/m^3"},
                {"velocity_x", "m/s"},        {"velocity_y", "m/s"},
                {"velocity_z", "m/s"},        {"temperature_x", "m^2/s^2"},
                {"temperature_y", "m^2/s^2"}, {"temperature_z", "m^2/s^2"},
                {"temperature", "m^2/s^2"},   {"pressure", "Pa"}};
    }

    void add(const Frame& frame) override {
        const Snapshot& s = frame.grains;
        ++frames_;
        for (std::size_t i = 0; i < s.size(); ++i) {
            const Vec p = s.position(i), v = s.velocity(i);
            if (!contains_across(p)) continue;
            share_volume(component(p, axis_), s.radius[i]);
            if (!region_.contains(p)) continue;
            const double m = s.mass[i];
            add_to(bin_of(p), std::array{1.0, m, m * v.x, m * v.y, m * v.z, m * v.x * v.x, m * v.y * v.y,
                                         m * v.z * v.z, s.pressure[i]});
        }
    }

    [[nodiscard]] Rows rows() const override {
        Rows rows;
        for (std::size_t b = 0; b < bins_; ++b) {
            const double* sum = sums(b);
            const double count = sum[0], mass = sum[1];
            std::array<double, 3> flow{}, temperature{};
            for (std::size_t k = 0; k < 3 && mass > 0; ++k) {
                flow[k] = sum[2 + k] / mass;
                temperature[k] = std::max(0.0, sum[5 + k] / mass - flow[k] * flow[k]);
            }
            rows.push_back(
                {middle(b), per_frame(count), per_frame(sum[volume]) / measure(), per_frame(mass) / measure(),
                 flow[0], flow[1], flow[2], temperature[0], temperature[1], temperature[2],
                 (temperature[0] + temperature[1] + temperature[2]) / 3, count > 0 ? sum[8] / count : 0});
        }
        return rows;
    }

private:
    // count, m, m v (3), m v_a^2 (3), pressure, volume
    static constexpr std::size_t fields = 10, volume = 9;

    [[nodiscard]] bool contains_across(Vec p) const {
        const Vec centre = 0.5 * (region_.lower + region_.upper);
        if (axis_ == scene::Axis::x) p.x = centre.x;
        if (axis_ == scene::Axis::y) p.y = centre.y;
        if (axis_ == scene::Axis::z) p.z = centre.z;
        return region_.contains(p);
    }

    void share_volume(double at, double radius) {
        const double whole = 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
        const auto layer_at = [&](double x) { return std::floor((x - start()) / width()); };
        const auto last = static_cast<std::int64_t>(layer_at(at + radius));
        const auto count = static_cast<std::int64_t>(bins_);
        for (auto layer = static_cast<std::int64_t>(layer_at(at - radius)); layer <= last; ++layer) {
            const double below = start() + static_cast<double>(layer) * width() - at;
            const double share = share_below((below + width()) / radius) - share_below(below / radius);
            const std::int64_t bin = periodic_ ? (layer % count + count) % count : layer;
            if (bin >= 0 && bin < count)
                sums_[static_cast<std::size_t>(bin) * fields + volume] += share * whole;
        }
    }

    bool periodic_;
};

} // namespace

std::unique_ptr<Analysis> make_profile(const scene::Scene& scene, const scene::AnalysisSpec& spec) {
    const std::size_t bins = spec.bins > 0 ? static_cast<std::size_t>(spec.bins) : 50;
    const Region region = region_of(scene, spec);
    if (region.dimension == 2) return std::make_unique<PlaneProfile>(region, spec.axis, bins);
    const bool periodic =
        is_whole_domain(spec) && scene.domain.periodic.at(static_cast<std::size_t>(spec.axis));
    return std::make_unique<SpaceProfile>(region, spec.axis, bins, periodic);
}

} // namespace sandlane::analysis
