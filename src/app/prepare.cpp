#include "app/prepare.hpp"

#include "core/error.hpp"
#include "core/memory.hpp"

namespace sandlane::app {

Prepared prepare(scene::Scene scene, const Common& common) {
    Prepared p;
    p.scene = std::move(scene);
    const simd::Isa isa = simd::choose_isa(common.isa);
    const ThreadChoice threads = choose_threads(common.threads);
    p.grains = scene::initial_grains(p.scene);
    p.needs = md::analyse(p.scene, p.grains);
    p.derived = md::derive(p.scene, p.needs);
    p.plan = md::make_plan(p.scene, p.needs, p.derived, isa, threads);
    require_memory(md::memory_bytes(p.needs, p.plan), "the scene");
    return p;
}

Prepared prepare(const Common& common) {
    return prepare(scene::read_scene(common.scene, common.overrides), common);
}

namespace {

// Files of grains may have changed since; positions may not tell, radii and masses do.
bool same_grains(const md::State& state, const std::vector<scene::GrainState>& grains) {
    for (std::size_t i = 0; i < state.size(); ++i) {
        const auto id = static_cast<std::size_t>(state.id[i]);
        if (id >= grains.size() || grains[id].radius != state.radius(i) || grains[id].mass != state.mass[i])
            return false;
    }
    return true;
}

} // namespace

md::Simulation Restorable::simulation() const {
    md::Simulation simulation = prepared.simulation();
    try {
        simulation.restore(checkpoint.engine_state);
    } catch (const Error& e) {
        fail(e.code(), "{}: {}. Overrides by --set must keep grains, domain, walls, laws and time step.",
             path.string(), e.what());
    }
    if (!same_grains(simulation.state(), prepared.grains))
        fail(Exit::io,
             "{}: its grains are not those that its scene describes now; a file of grains has changed",
             path.string());
    return simulation;
}

Restorable prepare_checkpoint(const std::filesystem::path& path, const Common& common) {
    output::Checkpoint checkpoint = output::read_checkpoint(path);
    Prepared prepared =
        prepare(scene::parse_scene(checkpoint.scene, path.string(), common.overrides), common);
    return {path, std::move(prepared), std::move(checkpoint)};
}

} // namespace sandlane::app
