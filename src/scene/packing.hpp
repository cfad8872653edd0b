// Random positions without overlap: sequential insertion while there is room, else a jittered triangular
// lattice whose overlaps are pushed apart.
#pragma once

#include "core/rng.hpp"
#include "scene/cell_grid.hpp"
#include "scene/wall_geometry.hpp"

#include <string>
#include <vector>

namespace sandlane::scene {

struct Disc {
    Vec centre;
    double radius = 0;
};

struct PackingTask {
    std::string name; // of the population, for messages
    Box box;          // the whole domain
    Vec lower, upper; // region that holds the grains whole, except across a periodic side of the domain
    std::vector<double> radii;
    std::vector<Disc> fixed;      // grains that are there already
    std::vector<WallPiece> walls; // to keep clear of
    Random random;                // attempt a of grain i uses number a 2^32 + i

    // The region reaches from side to side of a periodic axis, so that grains may stick out of it.
    [[nodiscard]] std::array<bool, 2> wraps() const {
        return {box.periodic[0] && lower.x <= box.lower.x && upper.x >= box.upper.x,
                box.periodic[1] && lower.y <= box.lower.y && upper.y >= box.upper.y};
    }
    [[nodiscard]] double fraction() const; // area of the grains over area of the region
};

// One centre for each radius. Throws Error(invalid_input) that says which packing fraction was reached.
[[nodiscard]] std::vector<Vec> pack(const PackingTask& task);

} // namespace sandlane::scene
