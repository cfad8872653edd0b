// What a run of grains says of the errors that it watches.
#pragma once

#include "md/simulation.hpp"
#include "scene/scene.hpp"

#include <array>
#include <string>

namespace sandlane::app {

struct WatchedQuantity {
    const char *key, *column, *title, *what, *advice;
    scene::WatchLimit scene::Watch::*member;

    [[nodiscard]] const scene::WatchLimit& limit(const scene::Watch& watch) const { return watch.*member; }
};

// In the order of md::watched.
[[nodiscard]] const std::array<WatchedQuantity, md::watched::count>& watched_quantities();

// Calls body(number) for those that the scene asks for.
template <class Body> void for_watched(const scene::Scene& scene, const Body& body) {
    for (std::size_t n = 0; n < md::watched::count; ++n)
        if (watched_quantities()[n].limit(scene.watch).asked) body(n);
}

// Member "watch" of summary.json: the largest values of the run, and when; nothing if the scene watches
// nothing.
[[nodiscard]] std::string watch_json(const md::Simulation& simulation);

} // namespace sandlane::app
