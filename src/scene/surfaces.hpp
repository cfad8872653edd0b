// The walls of a scene in space as pieces of surface, where the scene puts them, and which contacts a sphere
// has with them. Walls with the same motion share a frame, whose coordinates are those of the scene file.
#pragma once

#include "scene/outline.hpp"
#include "scene/scene.hpp"
#include "scene/stl.hpp"
#include "scene/surface_pieces.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace sandlane::scene {

// A sphere at a piece of surface, in the frame of the piece.
struct Touch {
    std::uint32_t piece = 0;
    Foot foot;
    Vec point; // of the surface
};

class Surfaces {
public:
    // Throws Error(invalid_input) for a mesh whose file cannot be read.
    explicit Surfaces(const Scene& scene);

    [[nodiscard]] std::size_t size() const { return pieces_.size(); }
    [[nodiscard]] const SurfacePiece& piece(std::size_t n) const { return pieces_[n].shape; }
    [[nodiscard]] int wall(std::size_t n) const { return pieces_[n].wall; } // index in Scene::walls

    // Frame of a motion of the scene, or of what stands still for -1.
    [[nodiscard]] static std::size_t frame_of(int motion) { return static_cast<std::size_t>(motion + 1); }
    [[nodiscard]] std::size_t frames() const { return frames_.size(); }
    // Calls body(n), in no particular order, for pieces of a frame: at least for those closer than `reach` to
    // p, and whatever the distance for planes.
    template <class Body> void for_near(std::size_t frame, Vec p, double reach, const Body& body) const {
        const Frame& f = frames_[frame];
        for (const std::uint32_t n : f.planes) body(n);
        f.tree.for_near(p, reach, [&](std::uint32_t k) { body(f.finite[k]); });
    }
    // Largest distance of the pieces of a frame from p, infinite with planes.
    [[nodiscard]] double farthest(std::size_t frame, Vec p) const;

    // Adds the contact of a sphere of radius R at p with a piece, if there is one.
    void add_touch(std::size_t n, Vec p, double radius, std::vector<Touch>& found) const;
    // Keeps one of those contacts with a wall whose points are closer than R/100: they are the same.
    // Afterwards they are ordered by wall, then distance.
    void keep_own(double radius, std::vector<Touch>& found) const;

    // What of the walls can be seen, for outputs, but for planes that only end where the domain does.
    [[nodiscard]] const std::vector<OutlineTriangle>& outline() const { return outline_; }
    [[nodiscard]] const std::vector<std::uint32_t>& endless() const { return endless_; }

private:
    struct Piece {
        SurfacePiece shape;
        int wall;
    };
    struct Frame {
        std::vector<std::uint32_t> planes, finite;
        BoxTree tree; // of the finite ones
    };

    void add_wall(const Wall& wall, int index);
    void add_box(const Wall& wall, int index);
    void add_revolved(const Wall& wall, int index);
    void add_mesh(const TriangleMesh& mesh, int index);
    [[nodiscard]] bool a_face_leads_closer(const Touch& touch, double radius) const;

    std::vector<Piece> pieces_;
    std::vector<Frame> frames_;
    std::vector<std::size_t> frame_of_wall_;
    std::vector<OutlineTriangle> outline_;
    std::vector<std::uint32_t> endless_;
};

} // namespace sandlane::scene
