// Scene file or checkpoint -> setup of its engine, the same way for every command.
#pragma once

#include "app/commands.hpp"
#include "app/engine.hpp"

#include <filesystem>
#include <memory>

namespace sandlane::app {

// Throws Error(unavailable) for a scene that the memory cannot hold.
[[nodiscard]] std::unique_ptr<Setup> prepare(scene::Scene scene, const Common& common);
[[nodiscard]] std::unique_ptr<Setup> prepare(const Common& common); // its scene file

// A checkpoint with the scene it carries, overrides applied.
struct Restorable {
    std::filesystem::path path;
    std::unique_ptr<Setup> setup;
    output::Checkpoint checkpoint;

    // As it stood. Throws Error(io) if the state does not belong to the scene, for example after an override
    // of what it depends on.
    [[nodiscard]] std::unique_ptr<Engine> engine() const;
};
[[nodiscard]] Restorable prepare_checkpoint(const std::filesystem::path& path, const Common& common);

// Derived quantities and the plan on standard output.
void print_plan(const Setup& setup, bool json);

} // namespace sandlane::app
