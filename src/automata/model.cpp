#include "automata/model.hpp"

#include "automata/gas.hpp"
#include "automata/heap.hpp"
#include "automata/ripples.hpp"
#include "automata/sandpile.hpp"
#include "core/error.hpp"

#include <algorithm>

namespace sandlane::automata {

// Lattices; the numbers of a picture of them, three of a site; checkpoints, text that grows by doubling.
double memory_bytes(const scene::Scene& scene) {
    constexpr double picture = 24, checkpoint = 3; // a site; times the state
    const auto sites = [](std::int64_t columns, std::int64_t rows) {
        return static_cast<double>(columns) * static_cast<double>(rows);
    };
    const auto bits = [&](std::int64_t columns, std::int64_t rows, int planes) {
        return sites((columns + 511) / 512 * 512, rows) * planes / 8;
    };
    switch (scene.method) {
    case scene::Engine::sandpile: { // two buffers; avalanches mark their sites; the search for an identity
        const scene::Sandpile& s = scene.sandpile;
        return sites(s.columns + 128, s.rows + 2) *
               (2 * (s.height + s.centre > 255 ? 2 : 1) + (s.drive == scene::PileDrive::none ? 0 : 4) +
                (s.start == scene::PileStart::doubled ? 20 : 0) + picture);
    }
    case scene::Engine::heap:
        return sites(scene.heap.columns, scene.heap.heaps) * (4 + picture);
    case scene::Engine::ripples:
        return sites(scene.ripples.columns, scene.ripples.rows) * (24 + picture);
    case scene::Engine::lattice_gas: {
        const scene::LatticeGas& s = scene.lattice_gas;
        // Pictures show means of blocks.
        return bits(s.columns, s.rows, simd::gas_planes + (scene.obstacles.empty() ? 0 : 1)) *
               (1 + checkpoint);
    }
    case scene::Engine::pipe_flow: { // and the series of the density and the map
        const scene::PipeFlow& s = scene.pipe_flow;
        const double lattice = s.variant == scene::PipeVariant::counted_rest
                                   ? sites(s.length, s.width) * (6 + picture)
                                   : bits(s.length, s.width, simd::gas_planes) * (1 + checkpoint);
        const double rows =
            std::min(512.0, 1 + 128 * static_cast<double>(s.steps) / static_cast<double>(s.length));
        return lattice +
               8 * (1 + checkpoint) * (static_cast<double>(s.steps) + rows * static_cast<double>(s.length));
    }
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
