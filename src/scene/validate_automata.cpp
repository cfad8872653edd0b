// What one key of a cellular automaton cannot know alone.
#include "core/error.hpp"
#include "scene/schema.hpp"

#include <cmath>

#include <algorithm>

namespace sandlane::scene {

namespace {

void check_size(std::int64_t columns, std::int64_t rows, const std::string& file, const char* table) {
    constexpr double most = 1e10;
    const double all = static_cast<double>(columns) * static_cast<double>(rows);
    if (all > most)
        fail(Exit::invalid_input, "{}: {}: {} x {} = {:.3g} sites; allowed: up to {:.0e}", file, table,
             columns, rows, all, most);
}

} // namespace

void validate_lattice_gas(const Scene& scene, const std::string& file) {
    const LatticeGas& g = scene.lattice_gas;
    check_size(g.columns, g.rows, file, "lattice_gas");
    if (g.rule != GasRule::hpp && g.sides == GasSides::periodic && g.rows % 2 != 0)
        fail(Exit::invalid_input,
             "{}: lattice_gas.rows: {} is odd; a periodic triangular lattice needs an even number of rows",
             file, g.rows);
    if (g.rule == GasRule::hpp && g.drive > 0)
        fail(Exit::invalid_input, "{}: lattice_gas.drive: {} does not go with rule = \"hpp\"; use \"fhp-1\"",
             file, g.drive);
    if (g.chirality == GasChirality::alternating &&
        (g.rule != GasRule::fhp1 || g.drive > 0 || !scene.obstacles.empty()))
        fail(Exit::invalid_input,
             "{}: lattice_gas.chirality: \"alternating\" goes with rule = \"fhp-1\" without drive and "
             "obstacles",
             file);
    if (!(std::hypot(g.velocity.x, g.velocity.y) < 0.5))
        fail(Exit::invalid_input,
             "{}: lattice_gas.velocity: [{}, {}] is out of range; allowed: a size below 0.5 sites per step",
             file, g.velocity.x, g.velocity.y);
    for (std::size_t n = 0; n < scene.obstacles.size(); ++n) {
        const Obstacle& o = scene.obstacles[n];
        if (o.kind == ObstacleKind::disc ? !(o.radius > 0) : !(o.size.x > 0 && o.size.y > 0))
            fail(Exit::invalid_input, "{}: obstacles[{}].{}: must be above 0 sites", file, n,
                 o.kind == ObstacleKind::disc ? "radius" : "size");
    }
}

void validate_pipe_flow(const Scene& scene, const std::string& file) {
    const PipeFlow& p = scene.pipe_flow;
    check_size(p.length, p.width, file, "pipe_flow");
    if (p.variant == PipeVariant::counted_rest && p.density > 6)
        fail(Exit::invalid_input,
             "{}: pipe_flow.density: {} is out of range; allowed with variant = \"counted-rest\": 0 to 6",
             file, p.density);
    if (p.window > p.length)
        fail(Exit::invalid_input, "{}: pipe_flow.window: {} columns are more than the pipe has, {}", file,
             p.window, p.length);
}

void validate_sandpile(const Scene& scene, const std::string& file) {
    const Sandpile& s = scene.sandpile;
    check_size(s.columns, s.rows, file, "sandpile");
    if (s.height + s.centre > 65535)
        fail(Exit::invalid_input,
             "{}: sandpile.centre: {} grains on {} are more than a site can hold; allowed: 65535 together",
             file, s.centre, s.height);
    if (s.start != PileStart::uniform && (s.height != 0 || s.centre != 0 || s.drive != PileDrive::none))
        fail(Exit::invalid_input,
             "{}: sandpile.start: an identity knows its heights; leave out height, centre and drive", file);
    // The topplings of a site, 0.168 times the square of the side, are counted by 32 bits.
    if (s.start != PileStart::uniform && std::max(s.columns, s.rows) > 100000)
        fail(Exit::invalid_input,
             "{}: sandpile.columns, rows: an identity has at most 100000 sites on a side", file);
    if (s.drive != PileDrive::none && s.height + s.centre > 255)
        fail(Exit::invalid_input,
             "{}: sandpile.centre: {} grains on {}; allowed on a driven pile: 255 together", file, s.centre,
             s.height);
    if (s.drive != PileDrive::none && s.steps == 0)
        fail(Exit::invalid_input, "{}: sandpile.steps: is missing; a driven pile needs a number of grains",
             file);
    if (s.drive != PileDrive::none && static_cast<double>(s.columns) * static_cast<double>(s.rows) > 1e9)
        fail(Exit::invalid_input, "{}: sandpile: a driven pile has at most 1e9 sites", file);
}

void validate_heap(const Scene& scene, const std::string& file) {
    if (scene.heap.columns < 2)
        fail(Exit::invalid_input, "{}: heap.columns: {} is out of range; allowed: 2 or more", file,
             scene.heap.columns);
    check_size(scene.heap.columns, scene.heap.heaps, file, "heap");
    if (scene.heap.steps > 1900000000)
        fail(Exit::invalid_input, "{}: heap.steps: {} is out of range; allowed: up to 1.9e9", file,
             scene.heap.steps);
}

void validate_ripples(const Scene& scene, const std::string& file) {
    const Ripples& r = scene.ripples;
    check_size(r.columns, r.rows, file, "ripples");
    // All sand of a row on one site must stay within the numbers of the kernels.
    if (r.transport * static_cast<double>(r.columns) > 262144)
        fail(Exit::invalid_input,
             "{}: ripples.transport: {} on {} columns; allowed: up to 262144 together, {:.4g} on so many",
             file, r.transport, r.columns, 262144 / static_cast<double>(r.columns));
}

} // namespace sandlane::scene
