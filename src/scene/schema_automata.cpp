// The keys of cellular automata.
#include "scene/fields.hpp"

namespace sandlane::scene {

namespace {

constexpr Range sites = between(1, 1 << 24);
constexpr Range probability = between(0, 1);
constexpr Range steps = between(0, 4294967295.0); // random numbers are counted by 32-bit steps

} // namespace

const Table<LatticeGas>& lattice_gas_table() {
    static const Table<LatticeGas> table =
        Table<LatticeGas>(
            "Lattice gas: particles of unit speed on a square (hpp) or triangular lattice, at most "
            "one per site and direction, that collide at the sites. Rows are periodic.")
            .choice("rule", &LatticeGas::rule, {"hpp", "fhp-1", "fhp-2", "fhp-3"},
                    "Hardy, Pomeau and de Pazzis; Frisch, Hasslacher and Pomeau without and with a rest "
                    "particle, and with all collisions")
            .integer("columns", &LatticeGas::columns, sites, "sites of a row")
            .required()
            .integer("rows", &LatticeGas::rows, sites, "rows, sqrt(3)/2 apart (hpp: 1); even where periodic")
            .required()
            .number("density", &LatticeGas::density, Unit::none, probability, "mean occupation of a bit")
            .vector("velocity", &LatticeGas::velocity, Unit::none,
                    "mean velocity at the start, sites per step")
            .number("drive", &LatticeGas::drive, Unit::none, probability,
                    "probability that a site turns one particle towards +x in a step; not for hpp")
            .choice("sides", &LatticeGas::sides, {"periodic", "no-slip", "free-slip"},
                    "what is below the first and above the last row: each other, or walls that reflect "
                    "particles straight back, or like a mirror")
            .choice(
                "chirality", &LatticeGas::chirality, {"random", "alternating"},
                "which way head-on pairs turn: by a random bit, or by (x + y + step) mod 2, which is faster "
                "and no good statistics; fhp-1 only")
            .flag("active_tiles", &LatticeGas::active_tiles,
                  "pass over segments of 512 sites without particles; the same bits, faster for a dilute gas")
            .integer("steps", &LatticeGas::steps, steps, "steps of the run")
            .required();
    return table;
}

const Table<Obstacle>& obstacle_table() {
    static const Table<Obstacle> table =
        Table<Obstacle>("Solid parts of a lattice gas, from which particles bounce back.")
            .choice("kind", &Obstacle::kind, {"disc", "rectangle"}, "shape")
            .vector("centre", &Obstacle::centre, Unit::none, "site along the row, and row")
            .required()
            .number("radius", &Obstacle::radius, Unit::none, not_negative(), "disc: in sites")
            .vector("size", &Obstacle::size, Unit::none, "rectangle: width and height in sites");
    return table;
}

const Table<PipeFlow>& pipe_flow_table() {
    static const Table<PipeFlow> table =
        Table<PipeFlow>(
            "Granular flow through a pipe (Peng and Herrmann): a lattice gas of particles that stop "
            "each other, pulled along the pipe, between rough walls. The pipe is periodic along x.")
            .choice("variant", &PipeFlow::variant, {"one-rest", "counted-rest"},
                    "at most one rest particle per site; or any number, which hop apart")
            .integer("length", &PipeFlow::length, sites, "sites along the pipe")
            .required()
            .integer("width", &PipeFlow::width, sites, "rows across it")
            .required()
            .number("density", &PipeFlow::density, Unit::none, between(0, 7),
                    "particles per site; counted-rest: at most 6")
            .number("dissipation", &PipeFlow::dissipation, Unit::none, probability,
                    "probability p that a collision stops particles")
            .number("gravity", &PipeFlow::gravity, Unit::none, probability,
                    "probability g that a site turns one particle towards +x in a step")
            .number("roughness", &PipeFlow::roughness, Unit::none, probability,
                    "probability b that a wall sends a particle straight back, not like a mirror")
            .integer("window", &PipeFlow::window, between(1, 1 << 24),
                     "columns whose mean density is followed at every step, for the power spectrum")
            .integer("steps", &PipeFlow::steps, steps, "steps of the run")
            .required();
    return table;
}

const Table<Sandpile>& sandpile_table() {
    static const Table<Sandpile> table =
        Table<Sandpile>(
            "Sandpile of Bak, Tang and Wiesenfeld: a site of four grains or more gives one to each of "
            "its neighbours; what leaves over a side is lost.")
            .integer("columns", &Sandpile::columns, sites, "sites of a row")
            .required()
            .integer("rows", &Sandpile::rows, sites, "rows")
            .required()
            .choice("start", &Sandpile::start, {"uniform", "identity", "identity-doubled"},
                    "all sites of one height; or the construction of the identity of the group of recurrent "
                    "states: relax 6 grains everywhere, relax again what is missing from them; or that "
                    "identity from those of lattices of half the size, which is much faster")
            .integer("height", &Sandpile::height, between(0, 65535), "uniform: grains of each site")
            .integer("centre", &Sandpile::centre, between(0, 65535),
                     "uniform: more grains on the site in the middle")
            .choice(
                "drive", &Sandpile::drive, {"none", "random", "ordered", "centre"},
                "what a step is: a sweep over the lattice; or one grain on a random site, on one after the "
                "other (row 7 k mod rows, column (11 k + k div columns) mod columns), or in the middle, and "
                "the avalanche after it")
            .choice("sweep", &Sandpile::sweep, {"full", "unit"},
                    "topplings of a site in a sweep: as many as its height allows, or one; avalanches are "
                    "always counted in unit sweeps")
            .integer("burn_in", &Sandpile::burn_in, steps, "grains before avalanches are counted")
            .flag("active_tiles", &Sandpile::active_tiles,
                  "pass over tiles where nothing has changed; the same bits, faster where the pile is quiet")
            .integer("steps", &Sandpile::steps, steps, "sweeps (0: until no site topples), or grains");
    return table;
}

const Table<Heap>& heap_table() {
    static const Table<Heap> table =
        Table<Heap>("Heap of Alonso and Herrmann: grains roll down from the top, lose energy, and stick. "
                    "Energies are in units of weight times height of a grain.")
            .integer("columns", &Heap::columns, sites,
                     "columns of the table; grains that reach the last are lost")
            .required()
            .choice("sides", &Heap::sides, {"one", "two"}, "from a wall at the left, or from the middle")
            .number("retained", &Heap::retained, Unit::none, {0, 0.999, true},
                    "share r of the energy that a step down leaves")
            .number("sticking", &Heap::sticking, Unit::none, positive(),
                    "energy U that a grain needs to go on")
            .number("start_energy", &Heap::start_energy, Unit::none, not_negative(),
                    "energy E_0 of a new grain")
            .number("roughness", &Heap::roughness, Unit::none, probability,
                    "delta: U is drawn anew at each visit, from U (1 - delta) to U (1 + delta)")
            .integer("steepest", &Heap::steepest, between(0, 1 << 20),
                     "avalanches: a column that is steeper lets its top grain go; 0: none")
            .integer("heaps", &Heap::heaps, between(1, 65536),
                     "independent heaps, of seeds seed, seed + 1, ...")
            .integer("steps", &Heap::steps, steps, "grains dropped on each heap")
            .required();
    return table;
}

const Table<Ripples>& ripples_table() {
    static const Table<Ripples> table =
        Table<Ripples>(
            "Ripples of sand in the wind (Nishimori and Ouchi): in a step each site sends sand along x "
            "over L = L_0 + b h, then sand creeps to the neighbours. Periodic on all sides.")
            .integer("columns", &Ripples::columns, sites, "sites along the wind")
            .required()
            .integer("rows", &Ripples::rows, sites, "rows; 1: the model of one dimension")
            .number("transport", &Ripples::transport, Unit::none, between(0, 100),
                    "height q that leaves a site in a step")
            .number("wind", &Ripples::wind, Unit::none, between(0, 100),
                    "b: higher sand flies so much farther")
            .number("length", &Ripples::length, Unit::none, between(0, 1e6), "L_0")
            .number("creep", &Ripples::creep, Unit::none, probability, "D")
            .choice("landing", &Ripples::landing, {"interpolated", "whole", "stochastic"},
                    "sand lands on two sites in proportion, on the nearest, or on one of two at random")
            .choice("arithmetic", &Ripples::arithmetic, {"fixed", "floating"},
                    "numbers of 2^-32, which conserve the sand exactly, or double precision")
            .number("noise", &Ripples::noise, Unit::none, between(0, 1000),
                    "heights at the start: uniform within +- noise/2")
            .integer("steps", &Ripples::steps, steps, "steps of the run")
            .required();
    return table;
}

} // namespace sandlane::scene
