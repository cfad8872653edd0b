// Scene file -> ready simulation, the same way for every command.
#pragma once

#include "app/commands.hpp"
#include "core/parallel.hpp"
#include "md/simulation.hpp"
#include "scene/initial_state.hpp"

namespace sandlane::app {

struct Prepared {
    scene::Scene scene;
    std::vector<scene::GrainState> grains;
    md::Needs needs;
    md::Derived derived;
    md::Plan plan;

    [[nodiscard]] md::Simulation simulation() const { return {scene, grains, needs, plan}; }
};

[[nodiscard]] inline Prepared prepare(scene::Scene scene, const Common& common) {
    Prepared p;
    p.scene = std::move(scene);
    const simd::Isa isa = simd::choose_isa(common.isa);
    const ThreadChoice threads = choose_threads(common.threads);
    p.grains = scene::initial_grains(p.scene);
    p.needs = md::analyse(p.scene, p.grains);
    p.derived = md::derive(p.scene, p.needs);
    p.plan = md::make_plan(p.scene, p.needs, p.derived, isa, threads);
    return p;
}

[[nodiscard]] inline Prepared prepare(const Common& common) {
    return prepare(scene::read_scene(common.scene, common.overrides), common);
}

} // namespace sandlane::app
