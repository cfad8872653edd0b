// Snapshots made up for the tests of the outputs.
#pragma once

#include "analysis/snapshot.hpp"
#include "scene/scene.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>
#include <system_error>
#include <vector>

#include <unistd.h>

namespace sample {

using sandlane::Vec;
using sandlane::analysis::Snapshot;
using sandlane::analysis::WallShape;

inline void add_grain(Snapshot& s, double x, double y, double radius, double vx, double vy, double omega = 0,
                      double angle = 0, double pressure = 0, int material = 0) {
    s.id.push_back(static_cast<std::int64_t>(s.id.size()));
    s.x.push_back(x);
    s.y.push_back(y);
    s.radius.push_back(radius);
    s.vx.push_back(vx);
    s.vy.push_back(vy);
    s.omega.push_back(omega);
    s.angle.push_back(angle);
    s.pressure.push_back(pressure);
    s.mass.push_back(1000 * radius * radius);
    s.material.push_back(material);
    s.image_x.push_back(0);
    s.image_y.push_back(0);
}

inline WallShape segment(Vec a, Vec b) {
    WallShape wall;
    wall.a = a;
    wall.b = b;
    return wall;
}

inline WallShape disc(Vec centre, double radius, int index = 0) {
    WallShape wall;
    wall.kind = WallShape::Kind::disc;
    wall.centre = centre;
    wall.radius = radius;
    wall.velocity = {0.5, 0.25, 0};
    wall.omega = 2;
    wall.angle = 1;
    wall.wall = index;
    return wall;
}

inline Snapshot empty(double time = 0) {
    Snapshot s;
    s.time = time;
    s.upper = {0.2, 0.1, 0};
    return s;
}

// A few grains of two materials on a row, moving with the frame's number.
inline Snapshot row(int frame) {
    const int grains = 7;
    Snapshot s = empty(0.1 * frame);
    s.step = 10 * frame;
    for (int i = 0; i < grains; ++i)
        add_grain(s, 0.02 * (i + 1) + 1e-3 / (frame + 1), 0.03 + 0.001 * i, 0.004 + 0.0005 * i, 0.1 * frame,
                  -1.0 / 3, -2.5 * i, 0.3 * i + frame, 100.0 * i, i % 2);
    return s;
}

inline Snapshot periodic_row(int frame) {
    Snapshot s = row(frame);
    s.periodic_x = true;
    s.image_x[2] = -1;
    return s;
}

inline Snapshot walled_row(int frame) {
    Snapshot s = row(frame);
    s.walls = {segment({0, 0, 0}, {0.2, 0.01 * frame, 0}), disc({0.1, 0.08, 0}, 0.01, 1)};
    WallShape arc;
    arc.kind = WallShape::Kind::arc;
    arc.centre = {0.1, 0.05, 0};
    arc.radius = 0.04;
    arc.angle_from = std::numbers::pi;
    arc.angle_to = 2 * std::numbers::pi;
    arc.wall = 2;
    s.walls.push_back(arc);
    return s;
}

inline WallShape triangle(Vec a, Vec b, Vec c, int index = 0) {
    WallShape wall;
    wall.kind = WallShape::Kind::triangle;
    wall.a = a;
    wall.b = b;
    wall.c = c;
    wall.wall = index;
    return wall;
}

inline Snapshot empty_space(double time = 0) {
    Snapshot s = empty(time);
    s.dimension = 3;
    s.lower = {0, 0, -0.05};
    s.upper = {0.2, 0.1, 0.15};
    return s;
}

inline void add_sphere(Snapshot& s, Vec at, double radius, Vec velocity = {}, Vec spin = {},
                       double pressure = 0, int material = 0) {
    add_grain(s, at.x, at.y, radius, velocity.x, velocity.y, spin.z, 0, pressure, material);
    s.z.push_back(at.z);
    s.vz.push_back(velocity.z);
    s.omega_x.push_back(spin.x);
    s.omega_y.push_back(spin.y);
    s.image_z.push_back(0);
}

// The row in space: one diagonal, orientations, and a floor that moves.
inline Snapshot space_row(int frame) {
    const Snapshot plane = row(frame);
    Snapshot s = empty_space(plane.time);
    s.step = plane.step;
    for (std::size_t i = 0; i < plane.size(); ++i) {
        const double n = static_cast<double>(i);
        add_sphere(s, {plane.x[i], plane.y[i], 0.01 * n + 1e-3 * frame}, plane.radius[i],
                   {plane.vx[i], plane.vy[i], 0.7 - 0.1 * n}, {1 + n, -0.5 * frame, plane.omega[i]},
                   plane.pressure[i], plane.material[i]);
        s.orientation.push_back(sandlane::rotation_by({0.1 * n, 0.2 * frame, -0.3}));
    }
    const double z = -0.04 + 0.001 * frame;
    s.walls = {triangle({0, 0, z}, {0.2, 0, z}, {0.2, 0.1, z}),
               triangle({0, 0, z}, {0.2, 0.1, z}, {0, 0.1, z})};
    return s;
}

inline Snapshot periodic_space_row(int frame) {
    Snapshot s = space_row(frame);
    s.walls.clear();
    s.orientation.clear();
    s.periodic_x = s.periodic_z = true;
    s.image_z[2] = -1;
    return s;
}

// make(0), make(1), ...
template <class Make> auto frames(const Make& make, int count) {
    std::vector<decltype(make(0))> made;
    made.reserve(static_cast<std::size_t>(count));
    for (int n = 0; n < count; ++n) made.push_back(make(n));
    return made;
}

// An hourglass: grains above the neck, some falling, a heap below. `fill` in (0, 1] scales the number of
// grains.
inline Snapshot hourglass(double radius, double phase = 0) {
    Snapshot s = empty(phase);
    s.upper = {0.2, 0.3, 0};
    const std::vector<Vec> outline{{0.02, 0.29, 0}, {0.02, 0.22, 0}, {0.09, 0.15, 0}, {0.02, 0.08, 0},
                                   {0.02, 0.01, 0}, {0.18, 0.01, 0}, {0.18, 0.08, 0}, {0.11, 0.15, 0},
                                   {0.18, 0.22, 0}, {0.18, 0.29, 0}};
    for (std::size_t k = 0; k + 1 < outline.size(); ++k)
        s.walls.push_back(segment(outline[k], outline[k + 1]));
    const double step = 2.05 * radius;
    int row_index = 0;
    for (double y = 0.01 + radius; y < 0.285; y += 0.866 * step, ++row_index) {
        const bool below = y < 0.135;
        const double half = below ? std::min(0.08, std::max(0.0, 0.09 - 1.1 * (y - 0.01)))
                                  : std::min(0.08, 0.0105 + std::max(0.0, y - 0.151));
        for (double x = 0.1 - half + 1.1 * radius + (row_index % 2) * radius; x < 0.1 + half - radius;
             x += step) {
            const double near = std::hypot(x - 0.1, y - 0.15);
            const double speed =
                below ? 0.05 * std::exp(-std::abs(x - 0.1) * 30) : 0.4 * std::exp(-near * 18);
            const double size = radius * (0.8 + 0.2 * std::abs(std::sin(37 * x + 91 * y)));
            add_grain(s, x, y - 0.002 * phase, size, 0, -speed, 20 * std::sin(50 * x),
                      12 * x + 40 * y + phase, below ? 900 * (0.11 - y) : 600 * (0.29 - y));
        }
    }
    return s;
}

inline sandlane::scene::Scene space_scene() {
    sandlane::scene::Scene s;
    s.domain.dimension = 3;
    s.domain.lower = empty_space().lower;
    s.domain.upper = empty_space().upper;
    s.domain.gravity = {0, 0, -9.81};
    s.materials.resize(2);
    return s;
}

inline sandlane::scene::Scene scene() {
    sandlane::scene::Scene s;
    s.domain.gravity = {0, -9.81, 0};
    s.materials.resize(2);
    s.materials[0].name = "glass";
    s.materials[0].young = 1e6;
    s.materials[0].friction = 0.5;
    s.materials[1].name = "steel";
    s.materials[1].young = 3e6;
    s.materials[1].dissipation = 0.01;
    s.materials[1].tangential_damping = 0.2;
    s.md.dt = 1e-5;
    return s;
}

// A folder of its own for one test, removed at its end.
class Folder {
public:
    explicit Folder(const std::string& name)
        : path_(std::filesystem::temp_directory_path() /
                ("sandlane-" + name + "-" + std::to_string(::getpid()))) {
        std::filesystem::remove_all(path_);
        std::filesystem::create_directories(path_);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    ~Folder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    [[nodiscard]] std::filesystem::path operator/(const char* name) const { return path_ / name; }

private:
    std::filesystem::path path_;
};

} // namespace sample
