// What a run says at its end.
#pragma once

#include "app/engine.hpp"

#include <cstdint>
#include <string>

namespace sandlane::app {

enum class Status { finished, interrupted, walltime };
[[nodiscard]] const char* status_name(Status status);

struct LoopTiming {
    double seconds = 0, work = 0; // work: things times steps
    std::int64_t steps = 0;
    [[nodiscard]] double rate() const { return seconds > 0 ? work / seconds : 0; } // per second
};

struct Summary {
    const Engine& engine;
    Status status;
    LoopTiming loop;
    double wall_seconds = 0; // of this process so far
    double wall_before = 0;  // of the runs that it continued

    [[nodiscard]] std::string json() const;
    // The schema that Google Benchmark writes, so that its compare.py reads production runs.
    [[nodiscard]] std::string benchmark_json() const;
};

} // namespace sandlane::app
