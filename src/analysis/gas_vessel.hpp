// The space that a gas is in at one time: a box, round walls that enclose it, round ones that stand in it.
#pragma once

#include <cstddef>
#include <vector>

namespace sandlane::analysis {

// A sphere (a circle in the plane), or a cylinder along an axis.
struct RoundWall {
    double center[3] = {0, 0, 0}, radius = 1; // m
    int axis = -1;                            // of a cylinder; -1: a sphere
    bool container = true;                    // the gas is inside

    friend bool operator==(const RoundWall&, const RoundWall&) = default;
};

struct GasVessel {
    int dimension = 3;
    double lower[3] = {0, 0, 0}, upper[3] = {1, 1, 1}; // m, where the sides are now
    std::vector<RoundWall> round;

    friend bool operator==(const GasVessel&, const GasVessel&) = default;
};

// Equal cells of a box. Those at its sides take all that lies beyond, too.
struct CellGrid {
    double lower[3] = {0, 0, 0}, upper[3] = {1, 1, 1}; // m
    std::size_t cells[3] = {1, 1, 1};

    [[nodiscard]] double edge(int d) const { return (upper[d] - lower[d]) / static_cast<double>(cells[d]); }
};

// How much of the vessel lies in each cell, m^3, m^2 in the plane: x first, then y, then z. Exact for boxes;
// round walls by parallel lines, to about 10^-3 of a cell that they cut.
[[nodiscard]] std::vector<double> contents(const GasVessel& vessel, const CellGrid& grid);

} // namespace sandlane::analysis
