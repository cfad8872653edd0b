// The scenes in data/scenes, as they are or smaller, and how they are run.
#pragma once

#include "md/simulation.hpp"
#include "scene/initial_state.hpp"
#include "scene/reader.hpp"

#include <string>

namespace sandlane {

// One thread: tests run beside each other.
inline md::Simulation shipped(const std::string& name, const scene::Overrides& overrides = {}) {
    const scene::Scene s =
        scene::read_scene(std::string(SANDLANE_SOURCE_DIR "/data/scenes/") + name, overrides);
    const auto grains = scene::initial_grains(s);
    const md::Needs needs = md::analyse(s, grains);
    return {s, grains, needs,
            md::make_plan(s, needs, md::derive(s, needs), simd::choose_isa("auto"), choose_threads(1))};
}

// Runs to the end and calls look(simulation) at equal intervals, at the start and at the end too.
template <class Look> void run_to_the_end(md::Simulation& sim, int intervals, const Look& look) {
    look(sim);
    for (int n = 1; n <= intervals; ++n) {
        sim.run(sim.plan().steps * n / intervals - sim.step());
        look(sim);
    }
}

} // namespace sandlane
