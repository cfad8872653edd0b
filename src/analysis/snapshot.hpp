// A snapshot: the state of a run at one time in the order of ids, for outputs and analyses. Const to its
// readers.
#pragma once

#include "core/quaternion.hpp"
#include "core/vec.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace sandlane::analysis {

// A wall as it stands at the time of the snapshot, for pictures and files.
struct WallShape {
    enum class Kind { segment, arc, disc, triangle }; // triangle: 3D, curved walls as many
    Kind kind = Kind::segment;
    Vec a, b, c;                         // segment: end points; triangle: corners
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
    int dimension = 2;
    Vec lower, upper;
    bool periodic_x = false, periodic_y = false, periodic_z = false;

    // Free grains, one entry each, ordered by id. SI units; angle in rad; pressure: trace of the contact
    // stress over the dimension (docs/physics.md 11), compression positive, N/m in 2D and Pa in 3D.
    std::vector<std::int64_t> id;
    std::vector<double> x, y, angle, vx, vy, omega, radius, mass, pressure;
    std::vector<int> material;
    std::vector<int> image_x, image_y; // periodic images crossed
    // 3D, else empty: omega is the z component of the angular velocity, angle stays 0.
    std::vector<double> z, vz, omega_x, omega_y;
    std::vector<int> image_z;
    std::vector<Quaternion> orientation; // empty unless the run follows it

    std::vector<WallShape> walls;

    [[nodiscard]] std::size_t size() const { return id.size(); }
    [[nodiscard]] Vec position(std::size_t i) const { return {x[i], y[i], dimension == 3 ? z[i] : 0.0}; }
    [[nodiscard]] Vec velocity(std::size_t i) const { return {vx[i], vy[i], dimension == 3 ? vz[i] : 0.0}; }
    [[nodiscard]] Vec angular_velocity(std::size_t i) const {
        return dimension == 3 ? Vec{omega_x[i], omega_y[i], omega[i]} : Vec{0, 0, omega[i]};
    }
};

// Of a pressure or stress: in the plane a force per length.
[[nodiscard]] constexpr const char* pressure_unit(std::int64_t dimension) {
    return dimension == 3 ? "Pa" : "N/m";
}

// One column of the log; the header of log.csv reads "name[unit]".
struct LogColumn {
    std::string name, unit;
};

struct Log {
    std::vector<LogColumn> columns;
    std::vector<std::vector<double>> rows;
};

} // namespace sandlane::analysis
