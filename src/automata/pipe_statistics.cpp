#include "automata/pipe_statistics.hpp"

#include "automata/ripples.hpp"
#include "automata/spectrum.hpp"
#include "core/error.hpp"

#include <algorithm>
#include <bit>

namespace sandlane::automata {

namespace {

constexpr std::size_t map_rows = 512; // of the space-time map, the last of the run

} // namespace

// A wave crosses the pipe in a few hundred rows of the map.
PipeStatistics::PipeStatistics(std::int64_t length, std::int64_t width)
    : length_(length), width_(width), map_every_(std::max<std::int64_t>(1, length / 128)),
      row_particles_(static_cast<std::size_t>(width), 0), row_momentum_(row_particles_) {}

void PipeStatistics::add_map_row(const std::vector<double>& columns) {
    if (map_.size() >= map_rows * columns.size())
        map_.erase(map_.begin(), map_.begin() + static_cast<std::ptrdiff_t>(columns.size()));
    map_.insert(map_.end(), columns.begin(), columns.end());
    ++looks_;
}

void PipeStatistics::save(ByteWriter& w) const {
    w.put_array(series_.data(), series_.size());
    w.put_array(map_.data(), map_.size());
    w.put_array(row_particles_.data(), row_particles_.size());
    w.put_array(row_momentum_.data(), row_momentum_.size());
    w.put(looks_);
}

void PipeStatistics::load(ByteReader& r) {
    PipeStatistics read(length_, width_);
    r.get_array(read.series_);
    r.get_array(read.map_);
    r.get_array(read.row_particles_);
    r.get_array(read.row_momentum_);
    read.looks_ = r.get<std::int64_t>();
    const bool fits = read.map_.size() % static_cast<std::size_t>(length_) == 0 &&
                      read.row_particles_.size() == row_particles_.size() &&
                      read.row_momentum_.size() == row_momentum_.size();
    if (!fits || read.series_.empty()) fail(Exit::io, "the state is one of another pipe");
    *this = std::move(read);
}

std::vector<Field> PipeStatistics::fields() const {
    const auto wide = static_cast<std::size_t>(length_);
    if (map_.empty()) return {};
    return {{"space-time", "particles per site", "", wide, map_.size() / wide, map_, false, 0,
             fmt::format("along the pipe; time upwards, {} steps",
                         static_cast<std::size_t>(map_every_) * map_.size() / wide)}};
}

std::vector<Table> PipeStatistics::tables() const {
    constexpr double highest_of_fit = 0.1; // cycles per step
    // Pieces of an eighth of the series, so that several are averaged.
    const Spectrum s = welch(series_, std::bit_floor(std::max<std::size_t>(series_.size() / 8, 1)));
    Table spectrum{"spectrum", {{"frequency", "1/step"}, {"power", "1"}}, {}, 0, 1, true};
    for (std::size_t k = 0; k < s.frequency.size(); ++k)
        spectrum.rows.push_back({s.frequency[k], s.power[k]});
    Table fit{"power-law", {{"exponent", "1"}, {"standard_error", "1"}, {"from", "1/step"}, {"to", "1/step"}},
              {},          -1,
              -1,          true};
    if (!s.power.empty()) {
        const auto peak =
            static_cast<std::size_t>(std::max_element(s.power.begin(), s.power.end()) - s.power.begin());
        const Line line = power_law(s, s.frequency[peak], highest_of_fit);
        fit.rows.push_back({line.slope, line.error, s.frequency[peak], highest_of_fit});
    }
    // S(k) of the particles of each place, averaged over times of the map.
    Table structure{"structure-factor", {{"mode", "1"}, {"wavelength", "1"}, {"S", "1"}}, {}, 1, 2, true};
    constexpr std::size_t looks = 32; // as mode_powers takes
    const std::size_t times = map_.size() / static_cast<std::size_t>(length_);
    double density = 0; // particles of a place, summed over places
    for (const double n : map_) density += n / static_cast<double>(times);
    if (times >= looks && density > 0) {
        const std::vector<double> powers = mode_powers(map_, static_cast<std::int32_t>(length_),
                                                       static_cast<std::int32_t>(times / looks * looks));
        for (std::size_t m = 0; m < powers.size(); ++m)
            structure.rows.push_back(
                {static_cast<double>(m + 1), static_cast<double>(length_) / static_cast<double>(m + 1),
                 powers[m] * static_cast<double>(width_) / (static_cast<double>(looks) * density)});
    }
    Table profile{"profile", {{"row", "1"}, {"density", "1/site"}, {"velocity", "sites/step"}}, {}, 0, 2,
                  false};
    for (std::size_t y = 0; y < row_particles_.size(); ++y)
        profile.rows.push_back(
            {static_cast<double>(y),
             row_particles_[y] / (static_cast<double>(looks_) * static_cast<double>(length_)),
             row_particles_[y] > 0 ? row_momentum_[y] / row_particles_[y] : 0});
    return {spectrum, fit, structure, profile};
}

} // namespace sandlane::automata
