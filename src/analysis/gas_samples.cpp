#include "analysis/gas_samples.hpp"

#include "core/bytes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sandlane::analysis {

namespace {

double maxwell_speed_density(int dimension, double c) {
    const double fall = std::exp(-c * c);
    return dimension == 3 ? 4 / std::sqrt(std::numbers::pi) * c * c * fall : 2 * c * fall;
}

} // namespace

GasSamples::GasSamples(const GasFrame& gas, int axis, std::size_t bins)
    : gas_(gas), axis_(axis), bins_(bins), speeds_(speed_bins), components_(2 * speed_bins) {}

GasVessel GasFrame::box() const {
    GasVessel v;
    v.dimension = dimension;
    std::copy_n(lower, 3, v.lower);
    std::copy_n(upper, 3, v.upper);
    return v;
}

// Those of round walls cost more than a frame, and hardly ever change.
void GasSamples::add_volumes(const GasVessel& vessel) {
    if (volumes_.empty() || !(vessel == vessel_)) {
        CellGrid grid;
        std::copy_n(gas_.lower, 3, grid.lower);
        std::copy_n(gas_.upper, 3, grid.upper);
        grid.cells[axis_] = bins_.size();
        volumes_ = contents(vessel, grid);
        vessel_ = vessel;
    }
    for (std::size_t n = 0; n < bins_.size(); ++n) bins_[n].volume += volumes_[n];
}

double GasSamples::density(const Sums& bin) const {
    return bin.volume > 0 ? bin.count * gas_.weight / bin.volume : 0;
}

std::string GasSamples::profile() const {
    const char axis = "xyz"[axis_];
    const auto d = static_cast<std::size_t>(gas_.dimension);
    std::string text = fmt::format("{}[m],density[1/m^{}],packing_fraction[1]", axis, gas_.dimension);
    for (std::size_t c = 0; c < d; ++c) text += fmt::format(",velocity_{}[m/s]", "xyz"[c]);
    text += ",temperature[J]";
    for (std::size_t c = 0; c < d; ++c) text += fmt::format(",temperature_{}[J]", "xyz"[c]);
    text += gas_.rough ? ",spin_temperature[J]\n" : "\n";
    for (const ProfileRow& row : profile_rows()) {
        text +=
            fmt::format("{:.9g},{:.9g},{:.9g}", row.place, row.density, row.density * gas_.particle_volume);
        for (std::size_t c = 0; c < d; ++c) text += fmt::format(",{:.9g}", row.velocity[c]);
        text += fmt::format(",{:.9g}", row.temperature);
        for (std::size_t c = 0; c < d; ++c) text += fmt::format(",{:.9g}", row.of_component[c]);
        if (gas_.rough) text += fmt::format(",{:.9g}", row.of_spins);
        text += '\n';
    }
    return text;
}

std::vector<GasSamples::ProfileRow> GasSamples::profile_rows() const {
    std::vector<ProfileRow> rows;
    const auto a = static_cast<std::size_t>(axis_), d = static_cast<std::size_t>(gas_.dimension);
    const double width = (gas_.upper[a] - gas_.lower[a]) / static_cast<double>(bins_.size());
    for (std::size_t n = 0; n < bins_.size(); ++n) {
        const Sums& b = bins_[n];
        const double count = std::max(b.count, 1.0), mass = b.mass > 0 ? b.mass : 1;
        ProfileRow row;
        row.place = gas_.lower[a] + (static_cast<double>(n) + 0.5) * width;
        row.density = density(b);
        for (std::size_t c = 0; c < d; ++c) {
            const double u = row.velocity[c] = b.velocity[c] / mass;
            row.of_component[c] = gas_.mass * std::max(0.0, b.square[c] / count - mass / count * (u * u));
            row.temperature += row.of_component[c] / static_cast<double>(d);
        }
        row.of_spins = gas_.moment * b.spin2 / count / (d == 3 ? 3 : 1);
        rows.push_back(row);
    }
    return rows;
}

std::vector<GasSamples::SpeedRow> GasSamples::speed_rows() const {
    std::vector<SpeedRow> rows;
    constexpr double width = fastest / speed_bins;
    const double n = std::max(counted_, 1.0);
    for (std::size_t b = 0; b < speed_bins; ++b) {
        const double c = (static_cast<double>(b) + 0.5) * width;
        const double component = (components_[speed_bins + b] + components_[speed_bins - 1 - b]) /
                                 (2 * n * gas_.dimension * width);
        rows.push_back({c, speeds_[b] / (n * width), maxwell_speed_density(gas_.dimension, c), component,
                        std::exp(-c * c) / std::sqrt(std::numbers::pi)});
    }
    return rows;
}

std::string GasSamples::distribution() const {
    std::string text = "c[1],speed_density[1],maxwell_speed_density[1],component_density[1],"
                       "maxwell_component_density[1]\n";
    for (const SpeedRow& row : speed_rows())
        text += fmt::format("{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n", row.c, row.density, row.maxwell,
                            row.component_density, row.maxwell_of_component);
    return text;
}

std::string GasSamples::serialise() const {
    ByteWriter out;
    out.put(frames_);
    out.put(counted_);
    out.put_array(bins_.data(), bins_.size());
    out.put_array(speeds_.data(), speeds_.size());
    out.put_array(components_.data(), components_.size());
    return out.bytes();
}

void GasSamples::restore(const std::string& bytes) {
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

} // namespace sandlane::analysis
