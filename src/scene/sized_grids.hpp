// Grains of any sizes in cells: a grid for each class of radii, so that what is near a small grain is not
// looked for in cells made for large ones. Plain and serial, for start states and what happens between steps.
#pragma once

#include "scene/cell_grid.hpp"
#include "scene/size_classes.hpp"

#include <cstddef>
#include <vector>

namespace sandlane::scene {

class SizedGrids {
public:
    // For `count` grains; radius(i) [m] > 0 of each.
    template <class Radius>
    SizedGrids(const Box& box, std::size_t count, const Radius& radius)
        : classes_(size_classes(count, radius)) {
        levels_.reserve(classes_.size());
        for (const SizeClass& c : classes_) levels_.push_back({CellGrid(box, 2 * c.largest, c.grains), {}});
    }

    [[nodiscard]] const std::vector<SizeClass>& classes() const { return classes_; }

    // Grains are numbered in the order of insertion. No radius above the largest that was announced.
    void insert(Vec p, double radius) {
        Level& level = levels_[class_of(classes_, radius)];
        level.grid.insert(p);
        level.numbers.push_back(size_++);
    }

    // Calls body(number) once for every grain that a grain of this radius at p may touch, and for others.
    template <class Body> void for_near(Vec p, double radius, const Body& body) const {
        for (std::size_t c = 0; c < levels_.size(); ++c) {
            const Level& level = levels_[c];
            if (level.numbers.empty()) continue;
            level.grid.for_within(p, radius + classes_[c].largest,
                                  [&](std::size_t n) { body(level.numbers[n]); });
        }
    }

private:
    struct Level {
        CellGrid grid;
        std::vector<std::size_t> numbers; // of the grid's grains
    };
    std::vector<SizeClass> classes_;
    std::vector<Level> levels_;
    std::size_t size_ = 0;
};

} // namespace sandlane::scene
