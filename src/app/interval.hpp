// Times between outputs, in steps.
#pragma once

#include <cstdint>
#include <limits>

namespace sandlane::app {

inline constexpr std::int64_t never = std::numeric_limits<std::int64_t>::max();

// Every `seconds`, by default duration/parts; negative, or parts = 0: never. A multiple of `stride` steps.
[[nodiscard]] std::int64_t interval(double seconds, double duration, double parts, double dt,
                                    std::int64_t stride = 1);

// all: whatever the step, at the start of a run.
[[nodiscard]] inline bool is_due(std::int64_t step, std::int64_t every, bool all) {
    return every != never && (all || step % every == 0);
}

// The first multiple of `every` above `step`.
[[nodiscard]] std::int64_t next_multiple(std::int64_t step, std::int64_t every);

} // namespace sandlane::app
