// Pieces that walls in space are made of, at rest: where a grain touches each, and how far away it is. A
// grain touches a surface wherever its distance has a local minimum: over a face at the foot of the
// perpendicular, at an edge or a corner only where no surface that ends there comes closer.
#pragma once

#include "core/vec.hpp"
#include "scene/box_tree.hpp"

#include <variant>
#include <vector>

namespace sandlane::scene {

// Infinite and of one side: the normal points into the free one.
struct PlanePiece {
    Vec point, normal;
};
// Of both sides.
struct TrianglePiece {
    Vec corner[3], normal;
    Vec inward[3]; // unit vectors in the plane from the side that begins at the corner of the same number

    TrianglePiece(Vec a, Vec b, Vec c);
};
struct EdgePiece {
    Vec from, along; // unit vector
    double length = 0;
    std::vector<Vec> surfaces; // unit vectors across the edge into the faces that end here
};
struct CornerPiece {
    Vec point;
    std::vector<Vec> edges; // unit vectors along the edges that end here
};

struct Axis3 {
    Vec origin, direction; // unit vector
};
// Surfaces of revolution. Their profile is given by vectors (along the axis, away from it, 0). A grain inside
// may be wedged between two sides: the far half of the profile is a piece of its own, of points inside alone.
struct BandPiece {
    Axis3 axis;
    Vec from, along; // profile, unit vector
    double length = 0;
    bool far = false;
};
struct RimPiece {
    Axis3 axis;
    Vec at;                    // profile
    std::vector<Vec> surfaces; // unit vectors of the profile into the bands that end here
    bool far = false;
};

using SurfacePiece = std::variant<PlanePiece, TrianglePiece, EdgePiece, CornerPiece, BandPiece, RimPiece>;

// Where a sphere touches a piece: from its centre to the surface.
struct Foot {
    double distance = 0; // negative behind a plane
    Vec direction;       // unit vector to the surface
    bool valid = false;
};
// `slack` [m] widens pieces, so that rounding opens no gap between them; what two of them claim, the caller
// keeps once.
[[nodiscard]] Foot foot(const SurfacePiece& piece, Vec p, double slack);

[[nodiscard]] Vec closest_point(const SurfacePiece& piece, Vec p);
// Negative behind a plane.
[[nodiscard]] double distance_from(const SurfacePiece& piece, Vec p);
[[nodiscard]] bool is_face(const SurfacePiece& piece);

// Not of planes, which have none.
[[nodiscard]] Bounds bounds_of(const SurfacePiece& piece);

// Of length 1; exact along an axis.
[[nodiscard]] Vec unit(Vec v);
// Unit vector across another one, always the same.
[[nodiscard]] Vec perpendicular(Vec direction);

} // namespace sandlane::scene
