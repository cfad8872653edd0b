// Snapshots and contacts made by hand.
#pragma once

#include "analysis/analysis.hpp"

#include <cmath>

namespace sandlane::analysis {

struct Hand {
    Snapshot grains;
    Contacts contacts;

    // In space where the upper corner has a height.
    explicit Hand(Vec upper = {1, 1, 0}) {
        grains.upper = upper;
        grains.dimension = upper.z > 0 ? 3 : 2;
    }

    // Returns the index of the grain.
    std::int32_t add(Vec at, double radius = 0.1, double mass = 1, Vec velocity = {}, double pressure = 0) {
        Snapshot& s = grains;
        s.id.push_back(static_cast<std::int64_t>(s.id.size()));
        s.x.push_back(at.x);
        s.y.push_back(at.y);
        s.vx.push_back(velocity.x);
        s.vy.push_back(velocity.y);
        s.angle.push_back(0);
        s.omega.push_back(0);
        s.radius.push_back(radius);
        s.mass.push_back(mass);
        s.pressure.push_back(pressure);
        s.material.push_back(0);
        s.image_x.push_back(0);
        s.image_y.push_back(0);
        if (s.dimension == 2) return static_cast<std::int32_t>(s.id.size()) - 1;
        s.z.push_back(at.z);
        s.vz.push_back(velocity.z);
        s.omega_x.push_back(0);
        s.omega_y.push_back(0);
        s.image_z.push_back(0);
        return static_cast<std::int32_t>(s.id.size()) - 1;
    }
    // A contact of grain i along `normal`, pushed with `push` and dragged with f_t; j = -1: a wall.
    void touch(std::int32_t i, std::int32_t j, Vec normal, double push = 1, double tangential = 0) {
        Contact c;
        c.i = i;
        c.j = j;
        c.wall = j < 0 ? 0 : -1;
        c.normal = (1 / norm(normal)) * normal;
        const auto n = static_cast<std::size_t>(i);
        c.point = grains.position(n) + grains.radius[n] * c.normal;
        c.force = -push * c.normal + tangential * Vec{-c.normal.y, c.normal.x, 0};
        c.tangential = tangential;
        contacts.push_back(c);
    }
    [[nodiscard]] Frame frame() const { return {grains, contacts}; }
};

} // namespace sandlane::analysis
