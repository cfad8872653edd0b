// Scenes of cellular automata (docs/automata.md): one struct for each table. Lengths in sites, times in
// steps.
#pragma once

#include "core/vec.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace sandlane::scene {

// Where the grains of a sandpile are at the start: the same height everywhere, or the first half of what
// makes the identity of the group of recurrent states, e = (6 - (6)^)^.
enum class PileStart { uniform, identity, doubled };
// What a step is: one sweep over all sites, or one grain dropped on a random site, on one after the other, or
// on the centre, and the whole avalanche after it.
enum class PileDrive { none, random, ordered, centre };
// Topplings of a site in one sweep: as many as its height allows, or one.
enum class PileSweep { full, unit };

// Bak, Tang and Wiesenfeld: a site of four grains or more gives one to each neighbour; sides are open.
struct Sandpile {
    std::int64_t columns = 0, rows = 0;
    PileStart start = PileStart::uniform;
    std::int64_t height = 0; // of each site at the start
    std::int64_t centre = 0; // more grains on the site (rows/2, columns/2)
    PileDrive drive = PileDrive::none;
    PileSweep sweep = PileSweep::full;
    std::int64_t burn_in = 0; // grains before avalanches are counted
    bool active_tiles = true; // quiet tiles are passed over
    std::int64_t steps = 0;   // 0: until no site topples; grains if driven
};

enum class HeapSides { one, two };

// Alonso and Herrmann: grains with energy roll down a heap and stick; energies in weight times height of a
// grain.
struct Heap {
    std::int64_t columns = 0;
    HeapSides sides = HeapSides::one;
    double retained = 0.5;     // r: share of the energy that a step down leaves
    double sticking = 1.5;     // U: a grain with no more energy stays
    double start_energy = 0;   // E_0
    double roughness = 0;      // delta: U is drawn from U (1 - delta) to U (1 + delta) at each visit
    std::int64_t steepest = 0; // s_max: a steeper column lets its top grain go; 0: never
    std::int64_t heaps = 1;    // independent ones, of seeds seed, seed + 1, ...
    std::int64_t steps = 0;    // grains dropped on each
};

enum class RippleLanding { interpolated, whole, stochastic };
enum class RippleArithmetic { fixed, floating };

// Nishimori and Ouchi: saltation along x over L = L_0 + b h, then creep to the neighbours; periodic.
struct Ripples {
    std::int64_t columns = 0, rows = 1; // one row: the model of one dimension
    double transport = 0.1;             // q: height that leaves a site in a step
    double wind = 1;                    // b
    double length = 10.5;               // L_0
    double creep = 0.4;                 // D
    RippleLanding landing = RippleLanding::interpolated;
    RippleArithmetic arithmetic = RippleArithmetic::fixed;
    double noise = 0.01; // heights at the start: uniform in +- noise/2
    std::int64_t steps = 0;
};

enum class GasRule { hpp, fhp1, fhp2, fhp3 };
enum class GasChirality { random, alternating };
enum class GasSides { periodic, no_slip, free_slip };
enum class ObstacleKind { disc, rectangle };

// Lattice gas: bits that move and collide.
struct LatticeGas {
    GasRule rule = GasRule::fhp1;
    std::int64_t columns = 0, rows = 0;
    double density = 0.2;                // d: mean occupation of a bit
    Vec velocity;                        // mean velocity at the start, sites per step
    double drive = 0;                    // probability that a site turns one particle towards +x in a step
    GasSides sides = GasSides::periodic; // lower and upper
    GasChirality chirality = GasChirality::random;
    bool active_tiles = false; // empty tiles are passed over
    std::int64_t steps = 0;
};

// Solid sites of a lattice gas; particles bounce back.
struct Obstacle {
    ObstacleKind kind = ObstacleKind::disc;
    Vec centre;        // x along the row, y in rows
    double radius = 0; // disc, sites
    Vec size;          // rectangle, sites
};

enum class PipeVariant { one_rest, counted_rest };

// Peng and Herrmann: granular flow in a pipe, particles that stop each other.
struct PipeFlow {
    PipeVariant variant = PipeVariant::one_rest;
    std::int64_t length = 0, width = 0;
    double density = 1;       // particles per site
    double dissipation = 0;   // p
    double gravity = 0;       // g, along +x
    double roughness = 0;     // b: share of reflections at the walls that go straight back
    std::int64_t window = 10; // columns of the time series of the density
    std::int64_t steps = 0;
};

} // namespace sandlane::scene
