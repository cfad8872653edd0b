// Scene file or checkpoint -> ready simulation, the same way for every command.
#pragma once

#include "app/commands.hpp"
#include "core/parallel.hpp"
#include "md/simulation.hpp"
#include "output/checkpoint.hpp"
#include "scene/initial_state.hpp"

#include <filesystem>

namespace sandlane::app {

struct Prepared {
    scene::Scene scene;
    std::vector<scene::GrainState> grains;
    md::Needs needs;
    md::Derived derived;
    md::Plan plan;

    [[nodiscard]] md::Simulation simulation() const { return {scene, grains, needs, plan}; }
    // The text of `sandlane check`.
    [[nodiscard]] std::string description() const { return md::describe(scene, needs, derived, plan); }
};

[[nodiscard]] Prepared prepare(scene::Scene scene, const Common& common);
[[nodiscard]] Prepared prepare(const Common& common); // its scene file

// Derived quantities and the plan on standard output.
void print_plan(const Prepared& prepared, bool json);

// A checkpoint with the scene it carries, overrides applied.
struct Restorable {
    std::filesystem::path path;
    Prepared prepared;
    output::Checkpoint checkpoint;

    // As it stood. Throws Error(io) if the state does not belong to the scene, for example after an override
    // of what it depends on.
    [[nodiscard]] md::Simulation simulation() const;
};
[[nodiscard]] Restorable prepare_checkpoint(const std::filesystem::path& path, const Common& common);

} // namespace sandlane::app
