// The grains of one population, before those of other populations are looked at.
#pragma once

#include "scene/initial_state.hpp"
#include "scene/standing_walls.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace sandlane::scene {

// `placed`: the grains of the populations before this one; random ones keep clear of them and of the walls.
// Ids are left 0.
[[nodiscard]] std::vector<GrainState> population(const Scene& scene, std::size_t index,
                                                 const std::vector<GrainState>& placed,
                                                 const StandingWalls& walls);

// How many grains the population asks for, as far as the scene tells (a file: 0); with a packing fraction,
// about.
[[nodiscard]] double expected_grains(const Scene& scene, std::size_t index);

// "grains[2] "beads"" for messages.
[[nodiscard]] std::string population_name(const Scene& scene, std::size_t index);

// Grains of a file: CSV with a header line of column names, or in 2D free grains of the book's 25-column
// format. Columns that the file lacks are left at what `prototype` says. Throws Error(invalid_input)
// "file:line:
// ...".
[[nodiscard]] std::vector<GrainState> parse_grains(const std::string& text, const std::string& file,
                                                   const Scene& scene, const Grains& grains,
                                                   const GrainState& prototype);

// Where a factory's grain may come to be: the place that belongs to this attempt, below 2^63, to insert it.
[[nodiscard]] Vec factory_place(const Scene& scene, std::size_t index, std::int64_t id,
                                std::uint64_t attempt);

} // namespace sandlane::scene
