// Density inhomogeneities of a pipe (spec 3.5): density of a window at every step and its power spectrum, the
// last places and times as a map, profiles across the pipe.
#pragma once

#include "automata/model.hpp"
#include "core/bytes.hpp"

#include <cstdint>
#include <vector>

namespace sandlane::automata {

class PipeStatistics {
public:
    PipeStatistics(std::int64_t length, std::int64_t width);

    void add_window(double density) { series_.push_back(density); }
    [[nodiscard]] double window() const { return series_.back(); }
    // The map gets a row at steps that are multiples of it.
    [[nodiscard]] std::int64_t map_every() const { return map_every_; }
    // particles(x, y) and momentum(x, y) along x of each site.
    template <class Particles, class Momentum>
    void add_to_maps(const Particles& particles, const Momentum& momentum) {
        std::vector<double> columns(static_cast<std::size_t>(length_), 0);
        for (std::int32_t y = 0; y < width_; ++y)
            for (std::int32_t x = 0; x < length_; ++x) {
                const double n = particles(x, y);
                columns[static_cast<std::size_t>(x)] += n / static_cast<double>(width_);
                row_particles_[static_cast<std::size_t>(y)] += n;
                row_momentum_[static_cast<std::size_t>(y)] += momentum(x, y);
            }
        add_map_row(columns);
    }

    void save(ByteWriter& bytes) const;
    void load(ByteReader& bytes);
    [[nodiscard]] std::vector<Field> fields() const; // places along x, times upwards
    [[nodiscard]] std::vector<Table> tables() const; // spectrum, power law, profile

private:
    void add_map_row(const std::vector<double>& columns);

    std::int64_t length_, width_, map_every_, looks_ = 0;
    std::vector<double> series_; // of the window, every step
    std::vector<double> map_;    // [times][places]
    std::vector<double> row_particles_, row_momentum_;
};

} // namespace sandlane::automata
