// The rectangle that an analysis looks at.
#pragma once

#include "analysis/snapshot.hpp"
#include "scene/scene.hpp"

namespace sandlane::analysis {

struct Region {
    Vec lower, upper; // m

    [[nodiscard]] Vec size() const { return upper - lower; }
    [[nodiscard]] double area() const { return size().x * size().y; } // m^2
    [[nodiscard]] bool contains(Vec p) const {
        return p.x >= lower.x && p.x < upper.x && p.y >= lower.y && p.y < upper.y;
    }
};

// Between the corners `from` and `to`; the domain where they are the same.
[[nodiscard]] Region region_of(const scene::Scene& scene, const scene::AnalysisSpec& spec);
[[nodiscard]] bool is_whole_domain(const scene::AnalysisSpec& spec);

// Into the domain along periodic sides.
[[nodiscard]] Vec wrapped(const Snapshot& snapshot, Vec position);

// Area of the part of a disc that lies in the region, m^2.
[[nodiscard]] double disc_area_inside(Vec centre, double radius, const Region& region);

// Covered part of the region, images across periodic sides included; overlaps count twice.
[[nodiscard]] double packing_fraction(const Snapshot& snapshot, const Region& region);

} // namespace sandlane::analysis
