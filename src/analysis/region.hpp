// The rectangle or box that an analysis looks at.
#pragma once

#include "analysis/snapshot.hpp"
#include "scene/scene.hpp"

namespace sandlane::analysis {

struct Region {
    Vec lower, upper; // m
    int dimension = 2;

    [[nodiscard]] Vec size() const { return upper - lower; }
    // Area, m^2, or volume, m^3.
    [[nodiscard]] double measure() const {
        return dimension == 3 ? size().x * size().y * size().z : size().x * size().y;
    }
    [[nodiscard]] bool contains(Vec p) const {
        return p.x >= lower.x && p.x < upper.x && p.y >= lower.y && p.y < upper.y &&
               (dimension == 2 || (p.z >= lower.z && p.z < upper.z));
    }
};

// Between the corners `from` and `to`; the domain where they are the same.
[[nodiscard]] Region region_of(const scene::Scene& scene, const scene::AnalysisSpec& spec);
[[nodiscard]] bool is_whole_domain(const scene::AnalysisSpec& spec);

[[nodiscard]] constexpr double component(Vec v, scene::Axis axis) {
    return axis == scene::Axis::x ? v.x : axis == scene::Axis::y ? v.y : v.z;
}
[[nodiscard]] constexpr const char* axis_name(scene::Axis axis) {
    return axis == scene::Axis::x ? "x" : axis == scene::Axis::y ? "y" : "z";
}

// Into the domain along periodic sides.
[[nodiscard]] Vec wrapped(const Snapshot& snapshot, Vec position);

// Area of the part of a disc that lies in the region, m^2.
[[nodiscard]] double disc_area_inside(Vec centre, double radius, const Region& region);

// Volume of the part of a sphere that lies in the region, m^3. By quadrature where sides cut it: the error is
// below 1e-8 of the volume of the sphere.
[[nodiscard]] double sphere_volume_inside(Vec centre, double radius, const Region& region);

// Covered part of the region, images across periodic sides included; overlaps count twice.
[[nodiscard]] double packing_fraction(const Snapshot& snapshot, const Region& region);

} // namespace sandlane::analysis
