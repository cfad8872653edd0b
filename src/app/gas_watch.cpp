#include "app/gas_watch.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace sandlane::app {

analysis::Watched watch_gas(const GasTotals& start, const GasTotals& now, double time) {
    namespace watched = analysis::watched;
    const double energy = std::max(start.energy, now.energy);
    double square = 0;
    for (std::size_t d = 0; d < 3; ++d) square += std::pow(now.velocity[d] - start.velocity[d], 2);
    analysis::Watched w;
    w.value[watched::overlap] = now.overlap;
    if (energy > 0) {
        w.value[watched::energy] =
            std::abs(now.energy - start.energy - now.given) / (energy + std::abs(now.given));
        w.value[watched::momentum] = std::sqrt(square * now.mass / (2 * energy));
    }
    std::fill(std::begin(w.time), std::end(w.time), time);
    return w;
}

} // namespace sandlane::app
