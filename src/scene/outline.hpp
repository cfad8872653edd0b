// Walls in space as triangles for outputs.
#pragma once

#include "scene/scene.hpp"
#include "scene/surface_pieces.hpp"

#include <vector>

namespace sandlane::scene {

struct OutlineTriangle {
    Vec a, b, c;
    int wall = 0; // index in Scene::walls
};

void outline_box(Vec lower, Vec upper, int wall, std::vector<OutlineTriangle>& to);
void outline_band(const BandPiece& band, int wall, std::vector<OutlineTriangle>& to);
// The part of a plane inside a box; none if they do not meet.
void outline_plane(Vec point, Vec normal, const Bounds& box, int wall, std::vector<OutlineTriangle>& to);

} // namespace sandlane::scene
