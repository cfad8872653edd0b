// What a run of grains writes to log.csv.
#pragma once

#include "analysis/snapshot.hpp"
#include "app/watcher.hpp"
#include "md/simulation.hpp"

#include <vector>

namespace sandlane::app {

// Four columns per wall come last: force, torque and power, named after the wall or its number.
[[nodiscard]] std::vector<analysis::LogColumn> log_columns(const scene::Scene& scene, const Watcher& watcher);
// One number per column.
[[nodiscard]] std::vector<double> log_row(const md::Simulation& simulation, const md::Observables& observed,
                                          const Watcher& watcher);

} // namespace sandlane::app
