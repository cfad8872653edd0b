#include "automata/model.hpp"

#include "automata/gas.hpp"
#include "automata/heap.hpp"
#include "automata/ripples.hpp"
#include "automata/sandpile.hpp"
#include "core/error.hpp"

namespace sandlane::automata {

double memory_bytes(const scene::Scene& scene) {
    const auto sites = [](std::int64_t columns, std::int64_t rows) {
        return static_cast<double>(columns) * static_cast<double>(rows);
    };
    switch (scene.method) {
    case scene::Engine::sandpile: { // two buffers; avalanches mark their sites
        const scene::Sandpile& s = scene.sandpile;
        return sites(s.columns + 128, s.rows + 2) *
               (2 * (s.height + s.centre > 255 ? 2 : 1) + (s.drive == scene::PileDrive::none ? 0 : 4));
    }
    case scene::Engine::heap:
        return sites(scene.heap.columns, scene.heap.heaps) * 4;
    case scene::Engine::ripples:
        return sites(scene.ripples.columns, scene.ripples.rows) * 16;
    case scene::Engine::lattice_gas:
        return sites((scene.lattice_gas.columns + 511) / 512 * 512, scene.lattice_gas.rows) *
               (simd::gas_planes + (scene.obstacles.empty() ? 0 : 1)) / 8;
    case scene::Engine::pipe_flow: // the lattice, the series of the density and the map
        return sites((scene.pipe_flow.length + 511) / 512 * 512, scene.pipe_flow.width) * simd::gas_planes /
                   8 +
               8 * (static_cast<double>(scene.pipe_flow.steps) +
                    512.0 * static_cast<double>(scene.pipe_flow.length));
    default:
        return 0;
    }
}

std::unique_ptr<Model> make_model(const scene::Scene& scene, const Means& means) {
    switch (scene.method) {
    case scene::Engine::sandpile:
        return std::make_unique<SandpileModel>(scene, means);
    case scene::Engine::heap:
        return make_heap(scene, means);
    case scene::Engine::ripples:
        return std::make_unique<RippleModel>(scene, means);
    case scene::Engine::lattice_gas:
        return make_lattice_gas(scene, means);
    case scene::Engine::pipe_flow:
        return make_pipe_flow(scene, means);
    default:
        fail(Exit::internal, "no cellular automaton of this method");
    }
}

} // namespace sandlane::automata
