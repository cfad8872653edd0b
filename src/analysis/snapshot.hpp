// A snapshot: the state of a run at one time in the order of ids, for outputs and analyses. Const to its
// readers.
#pragma once

#include "core/vec.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace sandlane::analysis {

// A wall as it stands at the time of the snapshot, for pictures and files.
struct WallShape {
    enum class Kind { segment, arc, disc };
    Kind kind = Kind::segment;
    Vec a, b;                            // segment: end points
    Vec centre;                          // arc, disc
    double radius = 0;                   // arc, disc
    double angle_from = 0, angle_to = 0; // arc, counter-clockwise
    double angle = 0;                    // disc: orientation
    Vec velocity;                        // disc
    double omega = 0;                    // disc
    int material = 0;
    int wall = 0; // index of the wall in the scene
};

struct Snapshot {
    std::int64_t step = 0;
    double time = 0; // s
    Vec lower, upper;
    bool periodic_x = false, periodic_y = false;

    // Free grains, one entry each, ordered by id. SI units; angle in rad; pressure in Pa (N/m for body =
    // disc): trace of the contact stress over two (md-spheres 8.1), compression positive.
    std::vector<std::int64_t> id;
    std::vector<double> x, y, angle, vx, vy, omega, radius, mass, pressure;
    std::vector<int> material;
    std::vector<int> image_x, image_y; // periodic images crossed

    std::vector<WallShape> walls;

    [[nodiscard]] std::size_t size() const { return id.size(); }
};

// One column of the log; the header of log.csv reads "name[unit]".
struct LogColumn {
    std::string name, unit;
};

struct Log {
    std::vector<LogColumn> columns;
    std::vector<std::vector<double>> rows;
};

} // namespace sandlane::analysis
