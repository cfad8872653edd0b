// What `sandlane run` writes to log.csv.
#pragma once

#include "analysis/snapshot.hpp"
#include "md/simulation.hpp"

#include <vector>

namespace sandlane::app {

[[nodiscard]] std::vector<analysis::LogColumn> log_columns();
// One number per column.
[[nodiscard]] std::vector<double> log_row(const md::Simulation& simulation, const md::Observables& observed);

} // namespace sandlane::app
