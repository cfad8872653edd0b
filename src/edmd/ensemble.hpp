// Independent runs of one gas that differ by their seeds and go on together, a thread for each.
#pragma once

#include "edmd/algorithm.hpp"

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace sandlane::edmd {

class Ensemble {
public:
    // One run or more, of as many particles each.
    Ensemble(std::vector<std::unique_ptr<Algorithm>> runs, int threads)
        : runs_(std::move(runs)), threads_(threads) {}

    // The first takes so many events, none later than `until` on the clock; the others come to its time.
    // Returns the events of the first. The same for any number of threads, and in one call or several.
    std::int64_t run(std::int64_t events, double until = std::numeric_limits<double>::infinity());

    [[nodiscard]] std::size_t size() const { return runs_.size(); }
    [[nodiscard]] const Algorithm& first() const { return *runs_.front(); }
    [[nodiscard]] const Algorithm& operator[](std::size_t n) const { return *runs_[n]; }
    [[nodiscard]] Algorithm& operator[](std::size_t n) { return *runs_[n]; }

    [[nodiscard]] Hash128 state_hash() const;
    [[nodiscard]] std::uint64_t log_hash() const; // of the events of all
    [[nodiscard]] std::string serialise() const;
    void restore(const std::string& bytes); // throws Error(io) for a state of something else

private:
    std::vector<std::unique_ptr<Algorithm>> runs_;
    int threads_;
};

// Mean of numbers from independent runs, and its standard error; NaN: of one run.
struct MeanError {
    double mean, error;
};
[[nodiscard]] MeanError mean_of(const std::vector<double>& values);

} // namespace sandlane::edmd
