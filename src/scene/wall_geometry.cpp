#include "scene/wall_geometry.hpp"

#include "scene/lookup.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>

namespace sandlane::scene {

namespace {

constexpr double two_pi = 2 * std::numbers::pi;

Vec direction(double angle) {
    return {std::cos(angle), std::sin(angle), 0};
}

double spacing_of(const Wall& wall) {
    return wall.spacing > 0 ? wall.spacing : 2 * wall.radius;
}

// A length that is a multiple of the spacing up to rounding counts as one.
double intervals(double length, double spacing) {
    return std::floor(length / spacing + 1e-9);
}

bool is_full_ring(const Wall& wall) {
    return wall.angle_to - wall.angle_from >= two_pi * (1 - 1e-12);
}

std::vector<GrainItem> ring(const Wall& wall) {
    const double span = wall.angle_to - wall.angle_from;
    const bool full = is_full_ring(wall);
    const int n = static_cast<int>(wall_grain_count(wall));
    std::vector<GrainItem> grains;
    for (int k = 0; k < n; ++k) {
        const double angle = wall.angle_from + span * k / std::max(1, full ? n : n - 1);
        grains.push_back({wall.centre + wall.ring_radius * direction(angle), {}, wall.radius, wall.omega});
    }
    return grains;
}

std::vector<GrainItem> row(const Wall& wall) {
    const Vec from = wall.points.front(), along = wall.points.back() - from;
    const double length = norm(along), spacing = spacing_of(wall);
    const int n = static_cast<int>(wall_grain_count(wall));
    std::vector<GrainItem> grains;
    grains.reserve(static_cast<std::size_t>(n));
    for (int k = 0; k < n; ++k)
        grains.push_back(
            {k == 0 ? from : from + (spacing * k / length) * along, {}, wall.radius, wall.omega});
    return grains;
}

void add_pieces(std::vector<WallPiece>& pieces, const Wall& wall, int index) {
    WallPiece piece;
    piece.wall = index;
    switch (wall.kind) {
    case WallKind::plane:
        piece.kind = WallPiece::Kind::plane;
        piece.a = wall.points[0];
        piece.b = (1 / norm(wall.normal)) * wall.normal;
        pieces.push_back(piece);
        break;
    case WallKind::segment:
    case WallKind::polyline: {
        const std::size_t n = wall.points.size();
        for (std::size_t s = 0; s < (wall.closed ? n : n - 1); ++s) {
            piece.a = wall.points[s];
            piece.b = wall.points[(s + 1) % n];
            pieces.push_back(piece);
        }
        break;
    }
    case WallKind::arc:
        piece.kind = WallPiece::Kind::arc;
        piece.a = wall.centre;
        piece.radius = wall.radius;
        piece.angle_from = wall.angle_from;
        piece.angle_span = std::min(wall.angle_to - wall.angle_from, two_pi);
        pieces.push_back(piece);
        break;
    case WallKind::grains:
        piece.kind = WallPiece::Kind::disc;
        for (const GrainItem& grain : wall_grains(wall)) {
            piece.a = grain.position;
            piece.radius = grain.radius;
            pieces.push_back(piece);
        }
        break;
    case WallKind::box:
    case WallKind::cylinder:
    case WallKind::cone:
    case WallKind::mesh:
        break;
    }
}

Gap from_point(Vec p, Vec nearest) {
    const Vec d = p - nearest;
    const double distance = norm(d);
    return {distance, distance > 0 ? (1 / distance) * d : Vec{0, 1, 0}};
}

Gap from_arc(const WallPiece& piece, Vec p) {
    const Vec d = p - piece.a;
    const double r = norm(d);
    if (r == 0) return {piece.radius, -1.0 * direction(piece.angle_from + 0.5 * piece.angle_span)};
    double turned = std::fmod(std::atan2(d.y, d.x) - piece.angle_from, two_pi);
    if (turned < 0) turned += two_pi;
    if (turned <= piece.angle_span)
        return {std::abs(r - piece.radius), ((r < piece.radius ? -1 : 1) / r) * d};
    const Gap first = from_point(p, piece.a + piece.radius * direction(piece.angle_from));
    const Gap last = from_point(p, piece.a + piece.radius * direction(piece.angle_from + piece.angle_span));
    return first.distance < last.distance ? first : last;
}

} // namespace

std::vector<GrainItem> wall_grains(const Wall& wall) {
    if (!wall.items.empty()) {
        std::vector<GrainItem> grains = wall.items;
        for (GrainItem& grain : grains) grain.omega += wall.omega;
        return grains;
    }
    return wall.ring_radius > 0 ? ring(wall) : row(wall);
}

double wall_grain_count(const Wall& wall) {
    if (!wall.items.empty()) return static_cast<double>(wall.items.size());
    if (wall.ring_radius > 0)
        return intervals((wall.angle_to - wall.angle_from) * wall.ring_radius, spacing_of(wall)) +
               (is_full_ring(wall) ? 0 : 1);
    return intervals(norm(wall.points.back() - wall.points.front()), spacing_of(wall)) + 1;
}

Gap gap(const WallPiece& piece, Vec p) {
    switch (piece.kind) {
    case WallPiece::Kind::plane:
        return {dot(p - piece.a, piece.b), piece.b};
    case WallPiece::Kind::segment: {
        const Vec along = piece.b - piece.a;
        const double s = std::clamp(dot(p - piece.a, along) / dot(along, along), 0.0, 1.0);
        return from_point(p, piece.a + s * along);
    }
    case WallPiece::Kind::arc:
        return from_arc(piece, p);
    case WallPiece::Kind::disc: {
        Gap g = from_point(p, piece.a);
        g.distance -= piece.radius;
        return g;
    }
    }
    return {};
}

bool stands_as_given(const Motion& m) {
    switch (m.kind) {
    case MotionKind::fixed:
        return true;
    case MotionKind::linear:
    case MotionKind::rotate:
        return m.start == 0;
    case MotionKind::oscillate:
        return m.start == 0 && m.phase == 0 && m.wave == Wave::sine;
    case MotionKind::planetary:
        return m.start == 0 && m.orbit_radius == 0;
    }
    return false;
}

std::vector<WallPiece> walls_at_start(const Scene& scene) {
    std::vector<WallPiece> pieces;
    for (std::size_t w = 0; w < scene.walls.size(); ++w) {
        const int motion = motion_index(scene, scene.walls[w].motion);
        if (motion < 0 || stands_as_given(scene.motions[static_cast<std::size_t>(motion)]))
            add_pieces(pieces, scene.walls[w], static_cast<int>(w));
    }
    return pieces;
}

Gap gap(const SurfacePiece& piece, Vec p) {
    if (const auto* plane = std::get_if<PlanePiece>(&piece)) return {distance_from(piece, p), plane->normal};
    return from_point(p, closest_point(piece, p));
}

} // namespace sandlane::scene
