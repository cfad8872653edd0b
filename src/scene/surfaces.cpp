#include "scene/surfaces.hpp"

#include "core/file.hpp"
#include "scene/lookup.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace sandlane::scene {

namespace {

// In units of the grain's radius.
constexpr double same_contact = 0.01;
constexpr double slack = 1e-6;
// Faces that come so close to a point share it. Within R/100 of a seam their difference in distance is below
// this, and points are one contact.
constexpr double seam = 0.5 * same_contact * same_contact;
// Edges between faces that lie in one plane, up to this sine, belong to neither: the slack bridges them.
constexpr double flat = 1e-7;

TriangleMesh placed_mesh(const Wall& wall) {
    TriangleMesh mesh = parse_stl(read_file(wall.file), wall.file);
    for (Vec& p : mesh.points) p = wall.scale * p + wall.centre;
    return mesh;
}

// A side of a triangle between two points of its mesh, ordered so that those of one edge follow each other.
struct Side {
    std::uint32_t first, second, triangle;
    Vec inward; // into the triangle

    [[nodiscard]] bool same_edge(const Side& other) const {
        return first == other.first && second == other.second;
    }
};

std::vector<Side> sides_of(const TriangleMesh& mesh, const std::vector<TrianglePiece>& faces) {
    std::vector<Side> sides;
    sides.reserve(3 * faces.size());
    for (std::uint32_t t = 0; t < faces.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            const auto [a, b] = std::minmax(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]);
            sides.push_back({a, b, t, faces[t].inward[k]});
        }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return std::tie(a.first, a.second, a.triangle) < std::tie(b.first, b.second, b.triangle);
    });
    return sides;
}

bool lies_inside_a_plane(const std::vector<Vec>& surfaces) {
    return surfaces.size() == 2 && norm(surfaces[0] + surfaces[1]) < flat;
}

} // namespace

Surfaces::Surfaces(const Scene& scene) : frames_(scene.motions.size() + 1) {
    for (std::size_t w = 0; w < scene.walls.size(); ++w) {
        const std::size_t first = pieces_.size();
        add_wall(scene.walls[w], static_cast<int>(w));
        frame_of_wall_.push_back(frame_of(motion_index(scene, scene.walls[w].motion)));
        Frame& frame = frames_[frame_of_wall_.back()];
        for (std::size_t n = first; n < pieces_.size(); ++n) {
            const bool plane = std::holds_alternative<PlanePiece>(pieces_[n].shape);
            (plane ? frame.planes : frame.finite).push_back(static_cast<std::uint32_t>(n));
        }
    }
    for (Frame& frame : frames_) {
        std::vector<Bounds> boxes;
        boxes.reserve(frame.finite.size());
        for (const std::uint32_t n : frame.finite) boxes.push_back(bounds_of(pieces_[n].shape));
        frame.tree = BoxTree(boxes);
    }
}

void Surfaces::add_wall(const Wall& wall, int index) {
    switch (wall.kind) {
    case WallKind::plane:
        endless_.push_back(static_cast<std::uint32_t>(pieces_.size()));
        pieces_.push_back({PlanePiece{wall.points[0], unit(wall.normal)}, index});
        break;
    case WallKind::box:
        add_box(wall, index);
        break;
    case WallKind::cylinder:
    case WallKind::cone:
        add_revolved(wall, index);
        break;
    case WallKind::mesh:
        add_mesh(placed_mesh(wall), index);
        break;
    case WallKind::segment:
    case WallKind::polyline:
    case WallKind::arc:
    case WallKind::grains:
        break; // walls of the plane
    }
}

void Surfaces::add_box(const Wall& wall, int index) {
    const Vec a = wall.points[0], b = wall.points[1];
    const Vec lower{std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
    const Vec upper{std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
    for (const Vec axis : {Vec{1, 0, 0}, Vec{0, 1, 0}, Vec{0, 0, 1}}) {
        pieces_.push_back({PlanePiece{lower, axis}, index});
        pieces_.push_back({PlanePiece{upper, -1.0 * axis}, index});
    }
    outline_box(lower, upper, index, outline_);
}

// The profile is a chain: the middle of one end face, its rim, the rim of the other, its middle.
void Surfaces::add_revolved(const Wall& wall, int index) {
    const Vec d = wall.points[1] - wall.points[0];
    const Axis3 axis{wall.points[0], unit(d)};
    const double end_radius = wall.kind == WallKind::cone ? wall.radius_to : wall.radius;
    const Vec first{0, wall.radius, 0}, last{norm(d), end_radius, 0};
    const auto add_band = [&](Vec from, Vec to) {
        const Vec side = to - from;
        const BandPiece band{axis, from, unit(side), norm(side), false};
        pieces_.push_back({band, index});
        outline_band(band, index, outline_);
        if (side.x == 0) return; // an end face has no far half
        pieces_.push_back({BandPiece{axis, from, unit(side), norm(side), true}, index});
    };
    const auto add_rim = [&](Vec at, Vec along_side) {
        std::vector<Vec> surfaces{along_side};
        if (wall.closed && at.y > 0) surfaces.push_back({0, -1, 0});
        pieces_.push_back({RimPiece{axis, at, surfaces, false}, index});
        if (at.y > 0) pieces_.push_back({RimPiece{axis, at, surfaces, true}, index});
    };
    add_band(first, last);
    if (wall.closed)
        for (const Vec end : {first, last})
            if (end.y > 0) add_band({end.x, 0, 0}, end);
    add_rim(first, unit(last - first));
    add_rim(last, unit(first - last));
}

void Surfaces::add_mesh(const TriangleMesh& mesh, int index) {
    std::vector<TrianglePiece> faces;
    faces.reserve(mesh.triangles.size());
    for (const auto& t : mesh.triangles)
        faces.emplace_back(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]);
    for (const TrianglePiece& face : faces) {
        pieces_.push_back({face, index});
        outline_.push_back({face.corner[0], face.corner[1], face.corner[2], index});
    }
    std::vector<std::vector<Vec>> along(mesh.points.size());
    std::vector<bool> sharp(mesh.points.size(), false);
    const std::vector<Side> sides = sides_of(mesh, faces);
    for (auto side = sides.begin(), next = side; side != sides.end(); side = next) {
        std::vector<Vec> surfaces;
        for (; next != sides.end() && next->same_edge(*side); ++next) surfaces.push_back(next->inward);
        const std::uint32_t a = side->first, b = side->second;
        const Vec from = mesh.points[a], direction = unit(mesh.points[b] - from);
        along[a].push_back(direction);
        along[b].push_back(-1.0 * direction);
        if (lies_inside_a_plane(surfaces)) continue;
        sharp[a] = sharp[b] = true;
        const double length = norm(mesh.points[b] - from);
        pieces_.push_back({EdgePiece{from, direction, length, std::move(surfaces)}, index});
    }
    for (std::size_t p = 0; p < mesh.points.size(); ++p)
        if (sharp[p]) pieces_.push_back({CornerPiece{mesh.points[p], std::move(along[p])}, index});
}

double Surfaces::farthest(std::size_t frame, Vec p) const {
    if (!frames_[frame].planes.empty()) return std::numeric_limits<double>::infinity();
    double reach = 0;
    for (const std::uint32_t n : frames_[frame].finite) {
        const Bounds box = bounds_of(pieces_[n].shape);
        const Vec d{std::max(p.x - box.lower.x, box.upper.x - p.x),
                    std::max(p.y - box.lower.y, box.upper.y - p.y),
                    std::max(p.z - box.lower.z, box.upper.z - p.z)};
        reach = std::max(reach, norm(d));
    }
    return reach;
}

void Surfaces::add_touch(std::size_t n, Vec p, double radius, std::vector<Touch>& found) const {
    const Foot at = foot(pieces_[n].shape, p, slack * radius);
    if (!at.valid || !(at.distance < radius)) return;
    const Touch touch{static_cast<std::uint32_t>(n), at, p + at.distance * at.direction};
    if (is_face(pieces_[n].shape) || !a_face_leads_closer(touch, radius)) found.push_back(touch);
}

// An edge knows the faces that share both its ends, but meshes may have others there.
bool Surfaces::a_face_leads_closer(const Touch& touch, double radius) const {
    const int own = wall(touch.piece);
    const Frame& frame = frames_[frame_of_wall_[static_cast<std::size_t>(own)]];
    const Vec p = touch.point - touch.foot.distance * touch.foot.direction;
    const double near = seam * radius;
    bool closer = false;
    frame.tree.for_near(touch.point, near, [&](std::uint32_t k) {
        const Piece& other = pieces_[frame.finite[k]];
        closer = closer || (other.wall == own && is_face(other.shape) &&
                            distance_from(other.shape, p) < touch.foot.distance - near &&
                            distance_from(other.shape, touch.point) < near);
    });
    return closer;
}

void Surfaces::keep_own(double radius, std::vector<Touch>& found) const {
    if (found.size() < 2) return;
    const auto place = [&](const Touch& t) { return std::tuple(wall(t.piece), t.foot.distance, t.piece); };
    std::sort(found.begin(), found.end(),
              [&](const Touch& a, const Touch& b) { return place(a) < place(b); });
    const auto same = [&](const Touch& kept, const Touch& t) {
        return wall(kept.piece) == wall(t.piece) && norm(kept.point - t.point) < same_contact * radius;
    };
    std::size_t kept = 0;
    for (const Touch& t : found) {
        const bool new_one = std::none_of(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(kept),
                                          [&](const Touch& k) { return same(k, t); });
        if (new_one) found[kept++] = t;
    }
    found.resize(kept);
}

} // namespace sandlane::scene
