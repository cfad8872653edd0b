#include "scene/surface_pieces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sandlane::scene {

namespace {

// d: from the surface to the point.
Foot along(Vec d) {
    const double distance = norm(d);
    if (!(distance > 0)) return {};
    return {distance, (-1 / distance) * d, true};
}

bool leads_away(Vec d, const std::vector<Vec>& directions, double slack) {
    return std::all_of(directions.begin(), directions.end(), [&](Vec t) { return dot(d, t) < slack; });
}

Vec on_segment(Vec p, Vec from, Vec direction, double length) {
    return from + std::clamp(dot(p - from, direction), 0.0, length) * direction;
}

// A point as a profile sees it: (along the axis, away from it, 0), and the unit vector that leads away.
struct Profile {
    Vec at, radial;

    Profile(const Axis3& axis, bool far, Vec p) {
        const Vec d = p - axis.origin;
        const double s = dot(d, axis.direction);
        const Vec across = d - s * axis.direction;
        const double r = norm(across);
        radial = r > 0 ? (1 / r) * across : perpendicular(axis.direction);
        at = {s, r, 0};
        if (!far) return;
        radial = -1.0 * radial;
        at.y = -r;
    }
};

Vec in_space(const Axis3& axis, Vec radial, Vec profile) {
    return profile.x * axis.direction + profile.y * radial;
}

Foot foot_on(const PlanePiece& s, Vec p, double) {
    return {dot(p - s.point, s.normal), -1.0 * s.normal, true};
}

Foot foot_on(const TrianglePiece& s, Vec p, double slack) {
    for (int k = 0; k < 3; ++k)
        if (dot(p - s.corner[k], s.inward[k]) < -slack) return {};
    return along(dot(p - s.corner[0], s.normal) * s.normal);
}

Foot foot_on(const EdgePiece& s, Vec p, double slack) {
    const Vec d = p - s.from;
    const double t = dot(d, s.along);
    if (t < -slack || t > s.length + slack || !leads_away(d, s.surfaces, slack)) return {};
    return along(d - t * s.along);
}

Foot foot_on(const CornerPiece& s, Vec p, double slack) {
    const Vec d = p - s.point;
    return leads_away(d, s.edges, slack) ? along(d) : Foot{};
}

Foot foot_on(const BandPiece& s, Vec p, double slack) {
    const Profile seen(s.axis, s.far, p);
    const Vec d = seen.at - s.from;
    const double t = dot(d, s.along);
    if (t < -slack || t > s.length + slack) return {};
    if (s.far && -seen.at.y >= s.from.y + t * s.along.y) return {};
    return along(in_space(s.axis, seen.radial, d - t * s.along));
}

Foot foot_on(const RimPiece& s, Vec p, double slack) {
    const Profile seen(s.axis, s.far, p);
    const Vec d = seen.at - s.at;
    if (!leads_away(d, s.surfaces, slack) || (s.far && -seen.at.y >= s.at.y)) return {};
    return along(in_space(s.axis, seen.radial, d));
}

Vec closest_on(const PlanePiece& s, Vec p) {
    return p - dot(p - s.point, s.normal) * s.normal;
}

Vec closest_on(const TrianglePiece& s, Vec p) {
    Vec best;
    double least = std::numeric_limits<double>::infinity();
    bool inside = true;
    for (int k = 0; k < 3; ++k) {
        inside = inside && dot(p - s.corner[k], s.inward[k]) >= 0;
        const Vec side = s.corner[(k + 1) % 3] - s.corner[k];
        const double length = norm(side);
        const Vec q = on_segment(p, s.corner[k], (1 / length) * side, length);
        if (const double distance = norm(p - q); distance < least) {
            least = distance;
            best = q;
        }
    }
    return inside ? p - dot(p - s.corner[0], s.normal) * s.normal : best;
}

Vec closest_on(const EdgePiece& s, Vec p) {
    return on_segment(p, s.from, s.along, s.length);
}

Vec closest_on(const CornerPiece& s, Vec) {
    return s.point;
}

Vec closest_on(const BandPiece& s, Vec p) {
    const Profile seen(s.axis, s.far, p);
    return s.axis.origin + in_space(s.axis, seen.radial, on_segment(seen.at, s.from, s.along, s.length));
}

Vec closest_on(const RimPiece& s, Vec p) {
    return s.axis.origin + in_space(s.axis, Profile(s.axis, s.far, p).radial, s.at);
}

Bounds around(Vec a, Vec b) {
    return {{std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)},
            {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}};
}

// Of the circle at a point of a profile.
Bounds around(const Axis3& axis, Vec at) {
    const Vec centre = axis.origin + at.x * axis.direction, k = axis.direction;
    const auto reach = [&](double component) {
        return at.y * std::sqrt(std::max(0.0, 1 - component * component));
    };
    const Vec half{reach(k.x), reach(k.y), reach(k.z)};
    return {centre - half, centre + half};
}

Bounds box_of(const PlanePiece&) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    return {{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}};
}

Bounds box_of(const TrianglePiece& s) {
    Bounds box = around(s.corner[0], s.corner[1]);
    box.include({s.corner[2], s.corner[2]});
    return box;
}

Bounds box_of(const EdgePiece& s) {
    return around(s.from, s.from + s.length * s.along);
}

Bounds box_of(const CornerPiece& s) {
    return {s.point, s.point};
}

Bounds box_of(const BandPiece& s) {
    Bounds box = around(s.axis, s.from);
    box.include(around(s.axis, s.from + s.length * s.along));
    return box;
}

Bounds box_of(const RimPiece& s) {
    return around(s.axis, s.at);
}

} // namespace

TrianglePiece::TrianglePiece(Vec a, Vec b, Vec c) : corner{a, b, c}, normal(unit(cross(b - a, c - a))) {
    for (int k = 0; k < 3; ++k) inward[k] = unit(cross(normal, corner[(k + 1) % 3] - corner[k]));
}

Vec unit(Vec v) {
    const double length = norm(v);
    return {v.x / length, v.y / length, v.z / length};
}

Vec perpendicular(Vec direction) {
    const Vec other = std::abs(direction.x) < 0.9 * norm(direction) ? Vec{1, 0, 0} : Vec{0, 1, 0};
    return unit(cross(direction, other));
}

Foot foot(const SurfacePiece& piece, Vec p, double slack) {
    return std::visit([&](const auto& s) { return foot_on(s, p, slack); }, piece);
}

Vec closest_point(const SurfacePiece& piece, Vec p) {
    return std::visit([&](const auto& s) { return closest_on(s, p); }, piece);
}

double distance_from(const SurfacePiece& piece, Vec p) {
    if (const auto* plane = std::get_if<PlanePiece>(&piece)) return dot(p - plane->point, plane->normal);
    return norm(p - closest_point(piece, p));
}

bool is_face(const SurfacePiece& piece) {
    return !std::holds_alternative<EdgePiece>(piece) && !std::holds_alternative<CornerPiece>(piece) &&
           !std::holds_alternative<RimPiece>(piece);
}

Bounds bounds_of(const SurfacePiece& piece) {
    return std::visit([](const auto& s) { return box_of(s); }, piece);
}

} // namespace sandlane::scene
