// Averages over time of a gas: profiles across an axis, and the distribution of velocities.
#pragma once

#include "dsmc/simulation.hpp"

#include <string>
#include <vector>

namespace sandlane::dsmc {

class Samples {
public:
    // axis: across the bins.
    Samples(const Setup& setup, int axis, std::size_t bins);

    void add(const std::vector<Particle>& particles);
    [[nodiscard]] std::int64_t frames() const { return frames_; }

    // Tables with a header, as CSV. profile: one row per bin, with density, mean velocity, temperatures.
    // Speeds of the distribution are in units of sqrt(2T/m), T of each frame, without the mean velocity.
    [[nodiscard]] std::string profile() const;
    [[nodiscard]] std::string distribution() const;

    [[nodiscard]] std::string serialise() const;
    void restore(const std::string& bytes);

private:
    struct Sums {
        double count = 0, velocity[3] = {0, 0, 0}, square[3] = {0, 0, 0}, spin2 = 0;
    };
    // One frame, of one bin or of all particles.
    void take(const Particle& p, Sums& sums) const;

    static constexpr std::size_t speed_bins = 120;
    static constexpr double fastest = 6; // in units of sqrt(2T/m)

    const Setup setup_;
    int axis_;
    std::int64_t frames_ = 0;
    std::vector<Sums> bins_;
    std::vector<double> speeds_, components_; // numbers of particles; of |c|, and of c in all directions
    double counted_ = 0;
};

} // namespace sandlane::dsmc
