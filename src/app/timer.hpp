// When an output of a run is due: after so many steps, or at times of the simulation where steps have no
// length of their own.
#pragma once

#include "app/engine.hpp"
#include "app/interval.hpp"

#include <cstdint>
#include <limits>

namespace sandlane::app {

// How the times of an output follow each other.
enum class Spacing {
    even,  // as the engine counts intervals, at equal distances
    paced, // or at the growing distances that it may ask for
};

class Timer {
public:
    Timer() = default; // never
    // Every `seconds`, by default duration/parts; negative, or parts = 0: never, as for interval(). After
    // what the engine has done already.
    Timer(double seconds, double parts, const Engine& engine, Spacing spacing);

    // The first step after `step`, and the first time after the last output, at which it is due; `never` and
    // infinity where the other one decides.
    [[nodiscard]] std::int64_t next_step(std::int64_t step) const;
    [[nodiscard]] double next_time() const;
    // Whether it is due now; by time, once. all: whatever the step, at the start of a run.
    [[nodiscard]] bool is_due(const Engine& engine, bool all);
    [[nodiscard]] bool is_on() const { return steps_ != never || every_ > 0; }

private:
    // Times at which it was due, up to and with a time: the last of them is mark(marks(time)).
    [[nodiscard]] std::int64_t marks(double time) const;
    [[nodiscard]] double mark(std::int64_t n) const;

    std::int64_t steps_ = never;
    double every_ = 0;  // s; 0: by steps
    double growth_ = 1; // of the times one after the other
    double end_ = 0;    // of the run, s
    std::int64_t done_ = 0;
};

} // namespace sandlane::app
