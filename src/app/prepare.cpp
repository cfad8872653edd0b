#include "app/prepare.hpp"

#include "core/memory.hpp"
#include "scene/reader.hpp"

#include <fmt/format.h>

namespace sandlane::app {

std::unique_ptr<Setup> prepare(scene::Scene scene, const Common& common) {
    std::unique_ptr<Setup> setup =
        make_setup(std::move(scene), {simd::choose_isa(common.isa), choose_threads(common.threads)});
    require_memory(setup->memory_bytes(), "the scene");
    return setup;
}

std::unique_ptr<Setup> prepare(const Common& common) {
    return prepare(scene::read_scene(common.scene, common.overrides), common);
}

std::unique_ptr<Engine> Restorable::engine() const {
    std::unique_ptr<Engine> engine = setup->start();
    engine->restore(checkpoint.engine_state, path.string());
    return engine;
}

Restorable prepare_checkpoint(const std::filesystem::path& path, const Common& common) {
    output::Checkpoint checkpoint = output::read_checkpoint(path);
    std::unique_ptr<Setup> setup =
        prepare(scene::parse_scene(checkpoint.scene, path.string(), common.overrides), common);
    return {path, std::move(setup), std::move(checkpoint)};
}

void print_plan(const Setup& setup, bool json) {
    fmt::print("{}{}", json ? setup.json() : setup.description(), json ? "\n" : "");
}

} // namespace sandlane::app
