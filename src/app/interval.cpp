#include "app/interval.hpp"

#include <algorithm>
#include <cmath>

namespace sandlane::app {

std::int64_t interval(double seconds, double duration, double parts, double dt, std::int64_t stride) {
    if (seconds < 0) return never;
    if (seconds == 0) seconds = parts > 0 ? duration / parts : -1;
    if (seconds <= 0) return never;
    const double strides = seconds / (dt * static_cast<double>(stride));
    return strides < 1e14 ? stride * std::max<std::int64_t>(1, std::llround(strides)) : never;
}

std::int64_t next_multiple(std::int64_t step, std::int64_t every) {
    return every == never ? never : (step / every + 1) * every;
}

} // namespace sandlane::app
