#include "dsmc/samples.hpp"

#include "core/bytes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sandlane::dsmc {

Samples::Samples(const Setup& setup, int axis, std::size_t bins)
    : setup_(setup), axis_(axis), bins_(bins), speeds_(speed_bins), components_(2 * speed_bins) {}

void Samples::take(const Particle& p, Sums& sums) const {
    sums.count += 1;
    for (std::size_t d = 0; d < static_cast<std::size_t>(setup_.dimension); ++d) {
        sums.velocity[d] += p.velocity[d];
        sums.square[d] += p.velocity[d] * p.velocity[d];
    }
    for (const double w : p.spin) sums.spin2 += w * w;
}

void Samples::add(const std::vector<Particle>& particles) {
    if (particles.empty()) return;
    ++frames_;
    Sums all;
    const auto axis = static_cast<std::size_t>(axis_);
    const double lower = setup_.lower[axis], length = setup_.upper[axis] - lower;
    const auto last = static_cast<double>(bins_.size() - 1);
    for (const Particle& p : particles) {
        const double at = std::floor((p.place[axis] - lower) / length * static_cast<double>(bins_.size()));
        take(p, bins_[static_cast<std::size_t>(std::clamp(at, 0.0, last))]);
        take(p, all);
    }
    const auto d = static_cast<std::size_t>(setup_.dimension);
    double mean[3] = {}, variance = 0;
    for (std::size_t c = 0; c < d; ++c) {
        mean[c] = all.velocity[c] / all.count;
        variance += (all.square[c] / all.count - mean[c] * mean[c]) / static_cast<double>(d);
    }
    if (!(variance > 0)) return;
    const double scale = 1 / std::sqrt(2 * variance);
    constexpr double per_unit = speed_bins / fastest;
    for (const Particle& p : particles) {
        double square = 0;
        for (std::size_t c = 0; c < d; ++c) {
            const double v = (p.velocity[c] - mean[c]) * scale;
            square += v * v;
            const double at = std::floor((v + fastest) * per_unit);
            if (at >= 0 && at < 2.0 * speed_bins) components_[static_cast<std::size_t>(at)] += 1;
        }
        const double at = std::floor(std::sqrt(square) * per_unit);
        if (at < speed_bins) speeds_[static_cast<std::size_t>(at)] += 1;
    }
    counted_ += static_cast<double>(particles.size());
}

std::string Samples::profile() const {
    const char axis = "xyz"[axis_];
    const auto d = static_cast<std::size_t>(setup_.dimension);
    std::string text = fmt::format("{}[m],density[1/m^{}],packing_fraction[1]", axis, setup_.dimension);
    for (std::size_t c = 0; c < d; ++c) text += fmt::format(",velocity_{}[m/s]", "xyz"[c]);
    text += ",temperature[J]";
    for (std::size_t c = 0; c < d; ++c) text += fmt::format(",temperature_{}[J]", "xyz"[c]);
    text += setup_.rough ? ",spin_temperature[J]\n" : "\n";
    const auto a = static_cast<std::size_t>(axis_);
    const double width = (setup_.upper[a] - setup_.lower[a]) / static_cast<double>(bins_.size());
    const double volume = setup_.volume() / static_cast<double>(bins_.size());
    const double inertia = setup_.inertia * setup_.mass * 0.25 * setup_.diameter * setup_.diameter;
    for (std::size_t n = 0; n < bins_.size(); ++n) {
        const Sums& b = bins_[n];
        const double density =
            frames_ > 0 ? b.count * setup_.weight / volume / static_cast<double>(frames_) : 0;
        const double count = std::max(b.count, 1.0);
        text += fmt::format("{:.9g},{:.9g},{:.9g}", setup_.lower[a] + (static_cast<double>(n) + 0.5) * width,
                            density, density * setup_.particle_volume());
        double mean = 0, of[3] = {};
        for (std::size_t c = 0; c < d; ++c) {
            const double u = b.velocity[c] / count;
            of[c] = setup_.mass * std::max(0.0, b.square[c] / count - u * u);
            mean += of[c] / static_cast<double>(d);
            text += fmt::format(",{:.9g}", u);
        }
        text += fmt::format(",{:.9g}", mean);
        for (std::size_t c = 0; c < d; ++c) text += fmt::format(",{:.9g}", of[c]);
        if (setup_.rough) text += fmt::format(",{:.9g}", inertia * b.spin2 / count / (d == 3 ? 3 : 1));
        text += '\n';
    }
    return text;
}

std::string Samples::distribution() const {
    std::string text = "c[1],speed_density[1],maxwell_speed_density[1],component_density[1],"
                       "maxwell_component_density[1]\n";
    constexpr double width = fastest / speed_bins;
    const double n = std::max(counted_, 1.0), pi = std::numbers::pi;
    for (std::size_t b = 0; b < speed_bins; ++b) {
        const double c = (static_cast<double>(b) + 0.5) * width;
        // Both signs of a component together.
        const double component = (components_[speed_bins + b] + components_[speed_bins - 1 - b]) /
                                 (2 * n * setup_.dimension * width);
        const double maxwell =
            setup_.dimension == 3 ? 4 / std::sqrt(pi) * c * c * std::exp(-c * c) : 2 * c * std::exp(-c * c);
        text += fmt::format("{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n", c, speeds_[b] / (n * width), maxwell,
                            component, std::exp(-c * c) / std::sqrt(pi));
    }
    return text;
}

std::string Samples::serialise() const {
    ByteWriter out;
    out.put(frames_);
    out.put(counted_);
    out.put_array(bins_.data(), bins_.size());
    out.put_array(speeds_.data(), speeds_.size());
    out.put_array(components_.data(), components_.size());
    return out.bytes();
}

void Samples::restore(const std::string& bytes) {
    ByteReader in(bytes);
    const std::size_t sizes[] = {bins_.size(), speeds_.size(), components_.size()};
    frames_ = in.get<std::int64_t>();
    counted_ = in.get<double>();
    in.get_array(bins_);
    in.get_array(speeds_);
    in.get_array(components_);
    if (bins_.size() != sizes[0] || speeds_.size() != sizes[1] || components_.size() != sizes[2] ||
        !in.at_end())
        fail(Exit::io, "averages of the gas: damaged, or of another scene");
}

} // namespace sandlane::dsmc
