// The errors that a run watches of itself, for engines and for what is written of them.
#pragma once

#include <cstddef>
#include <string>

namespace sandlane::analysis {

namespace watched {
enum : std::size_t { overlap, energy, momentum, step, count };
} // namespace watched

// One look at a run. What the scene does not watch stays 0.
struct Watched {
    double value[watched::count] = {};
    double time[watched::count] = {};  // s, of the value
    std::string where[watched::count]; // grain and partner, or the like, for messages
};

} // namespace sandlane::analysis
