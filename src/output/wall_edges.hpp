// Edges of walls made of triangles: those that a drawing shows.
#pragma once

#include "analysis/snapshot.hpp"

#include <vector>

namespace sandlane::output {

struct WallEdge {
    Vec a, b;
    // Of the triangles that end here, turned so that both lie on the same side of the surface. Of more than
    // two, or of one, there is no second one.
    Vec normal, other_normal;
    bool has_other = false;

    // A border, or a bend by more than 30 degrees.
    [[nodiscard]] bool is_sharp() const;
    // As seen from this direction the surface turns away here.
    [[nodiscard]] bool is_outline(Vec towards) const;
};

// Of the triangles among the walls; triangles of one wall that have both end points in common share an edge.
// In the order in which the triangles have them.
[[nodiscard]] std::vector<WallEdge> wall_edges(const std::vector<analysis::WallShape>& walls);

} // namespace sandlane::output
