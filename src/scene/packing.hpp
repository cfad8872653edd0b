// Random positions without overlap: sequential insertion while there is room, else a jittered lattice,
// triangular or face-centred cubic, whose overlaps are pushed apart.
#pragma once

#include "core/rng.hpp"
#include "scene/cell_grid.hpp"
#include "scene/space.hpp"
#include "scene/standing_walls.hpp"

#include <string>
#include <vector>

namespace sandlane::scene {

// A disc or a sphere.
struct Ball {
    Vec centre;
    double radius = 0;
};

struct PackingTask {
    std::string name; // of the population, for messages
    Box box;          // the whole domain
    Vec lower, upper; // region that holds the grains whole, except across a periodic side of the domain
    std::vector<double> radii;
    std::vector<Ball> fixed;    // grains that are there already
    const StandingWalls& walls; // to keep clear of
    Random random;              // attempt a of grain i uses number a 2^32 + i

    [[nodiscard]] std::int64_t dimension() const { return box.dimension; }
    [[nodiscard]] Vec size() const { return upper - lower; }
    // The region reaches from side to side of a periodic axis, so that grains may stick out of it.
    [[nodiscard]] bool wraps(const AxisOfSpace& axis) const {
        const double Vec::*x = axis.component;
        return box.periodic[axis.index] && lower.*x <= box.lower.*x && upper.*x >= box.upper.*x;
    }
    [[nodiscard]] double fraction() const; // area or volume of the grains over that of the region
};

// Sites of a lattice that fills the region, one for each grain; surplus sites stay empty at equal intervals.
// Each centre is displaced uniformly by up to `jitter` spacings.
[[nodiscard]] std::vector<Vec> jittered_lattice(const PackingTask& task, double jitter);

// One centre for each radius. Throws Error(invalid_input) that says which packing fraction was reached.
[[nodiscard]] std::vector<Vec> pack(const PackingTask& task);

} // namespace sandlane::scene
