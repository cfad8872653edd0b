#include "app/md_watch.hpp"

#include "app/json.hpp"

#include <fmt/format.h>

namespace sandlane::app {

const std::array<WatchedQuantity, md::watched::count>& watched_quantities() {
    static const std::array<WatchedQuantity, md::watched::count> all = {{
        {"largest_overlap", "overlap_peak", "Largest overlap of the run", "the largest overlap",
         "The material is soft for this load, or the time step too large: raise its stiffness or lower "
         "md.dt.",
         &scene::Watch::overlap},
        {"energy_residual", "energy_residual", "Largest residual of the energy balance",
         "the residual of the energy balance", "Lower md.dt, or give md.accuracy in its place.",
         &scene::Watch::energy},
        {"momentum_error", "momentum_error", "Largest error of the momentum balance",
         "the error of the momentum balance", "Lower md.dt, or give md.accuracy in its place.",
         &scene::Watch::momentum},
        {"step_error", "step_error", "Largest error of a collision by halving the step",
         "the error of a collision by halving the step", "Lower md.dt, or give md.accuracy in its place.",
         &scene::Watch::step},
    }};
    return all;
}

std::string watch_json(const md::Simulation& simulation) {
    std::string members;
    const md::Balance& b = simulation.balance();
    for_watched(simulation.scene(), [&](std::size_t n) {
        members +=
            fmt::format(R"({}"{}": {{"largest": {}, "time": {}}})", members.empty() ? "" : ", ",
                        watched_quantities()[n].key, json_number(b.peak[n]), json_number(b.peak_time[n]));
    });
    return members.empty() ? members : fmt::format(R"("watch": {{{}}}, )", members);
}

} // namespace sandlane::app
