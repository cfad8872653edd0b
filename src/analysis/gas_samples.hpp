// Averages over time of a gas: profiles across an axis, and the distribution of velocities.
#pragma once

#include "analysis/gas_vessel.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace sandlane::analysis {

// The gas that frames are taken of.
struct GasFrame {
    int dimension = 3;
    double lower[3] = {0, 0, 0}, upper[3] = {1, 1, 1}; // m, wherever the sides may get to
    double particle_volume = 1;                        // m^3, m^2 in the plane; a mean of several kinds
    double weight = 1;                                 // real particles that one stands for
    double mass = 1;                                   // kg, of the first kind
    bool rough = false;
    double moment = 0; // rough: moment of inertia of the first kind, kg m^2

    [[nodiscard]] GasVessel box() const; // the gas in a box of these sides
};

// A particle over those of the first kind.
struct GasRatio {
    double mass = 1, moment = 1;
};

class GasSamples {
public:
    // axis: across the bins.
    GasSamples(const GasFrame& gas, int axis, std::size_t bins);

    // Particle: has place, velocity and spin, arrays of three numbers. vessel: where they are now.
    // ratio_of(particle): its GasRatio.
    template <class Particle, class RatioOf>
    void add(const std::vector<Particle>& particles, const GasVessel& vessel, const RatioOf& ratio_of);
    template <class Particle> void add(const std::vector<Particle>& particles) {
        add(particles, gas_.box(), [](const Particle&) { return GasRatio{}; });
    }
    [[nodiscard]] std::int64_t frames() const { return frames_; }

    // Tables with a header, as CSV. profile: one row per bin, with density, mean velocity, temperatures.
    // Speeds of the distribution are in units of sqrt(2T/m), T of each frame, without the mean velocity.
    [[nodiscard]] std::string profile() const;
    [[nodiscard]] std::string distribution() const;

    // The same as numbers.
    struct ProfileRow {
        double place = 0, density = 0, velocity[3] = {0, 0, 0};
        double temperature = 0, of_component[3] = {0, 0, 0}, of_spins = 0; // J
    };
    struct SpeedRow {
        double c, density, maxwell;                     // of the speed
        double component_density, maxwell_of_component; // of each component, both signs together
    };
    [[nodiscard]] std::vector<ProfileRow> profile_rows() const;
    [[nodiscard]] std::vector<SpeedRow> speed_rows() const;
    [[nodiscard]] char axis_name() const { return "xyz"[axis_]; }

    [[nodiscard]] std::string serialise() const;
    void restore(const std::string& bytes);

private:
    struct Sums { // mass, and the rest weighted by it, or by the moment of inertia
        double count = 0, mass = 0, velocity[3] = {0, 0, 0}, square[3] = {0, 0, 0}, spin2 = 0;
        double volume = 0; // of the bin, of all frames
    };
    // One frame, of one bin or of all particles.
    template <class Particle> void take(const Particle& p, const GasRatio& ratio, Sums& sums) const;
    void add_volumes(const GasVessel& vessel);
    [[nodiscard]] double density(const Sums& bin) const;

    static constexpr std::size_t speed_bins = 120;
    static constexpr double fastest = 6; // in units of sqrt(2T/m)

    const GasFrame gas_;
    int axis_;
    std::int64_t frames_ = 0;
    std::vector<Sums> bins_;
    std::vector<double> speeds_, components_; // numbers of particles; of |c|, and of c in all directions
    double counted_ = 0;
    GasVessel vessel_;            // of the last frame
    std::vector<double> volumes_; // of the bins in it
};

template <class Particle> void GasSamples::take(const Particle& p, const GasRatio& ratio, Sums& sums) const {
    sums.count += 1;
    sums.mass += ratio.mass;
    for (std::size_t d = 0; d < static_cast<std::size_t>(gas_.dimension); ++d) {
        sums.velocity[d] += ratio.mass * p.velocity[d];
        sums.square[d] += ratio.mass * (p.velocity[d] * p.velocity[d]);
    }
    for (const double w : p.spin) sums.spin2 += ratio.moment * (w * w);
}

template <class Particle, class RatioOf>
void GasSamples::add(const std::vector<Particle>& particles, const GasVessel& vessel,
                     const RatioOf& ratio_of) {
    if (particles.empty()) return;
    ++frames_;
    add_volumes(vessel);
    Sums all;
    const auto axis = static_cast<std::size_t>(axis_);
    const double lower = gas_.lower[axis], length = gas_.upper[axis] - lower;
    const auto last = static_cast<double>(bins_.size() - 1);
    for (const Particle& p : particles) {
        const double at = std::floor((p.place[axis] - lower) / length * static_cast<double>(bins_.size()));
        const GasRatio ratio = ratio_of(p);
        take(p, ratio, bins_[static_cast<std::size_t>(std::clamp(at, 0.0, last))]);
        take(p, ratio, all);
    }
    const auto d = static_cast<std::size_t>(gas_.dimension);
    double mean[3] = {}, variance = 0;
    for (std::size_t c = 0; c < d; ++c) {
        mean[c] = all.velocity[c] / all.mass;
        variance += (all.square[c] - all.mass * mean[c] * mean[c]) / all.count / static_cast<double>(d);
    }
    if (!(variance > 0)) return;
    constexpr double per_unit = speed_bins / fastest;
    for (const Particle& p : particles) {
        const double scale = std::sqrt(ratio_of(p).mass) / std::sqrt(2 * variance);
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

} // namespace sandlane::analysis
