#include "md/walls.hpp"

#include "scene/lookup.hpp"
#include "scene/wall_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sandlane::md {

namespace {

constexpr double two_pi = 2 * std::numbers::pi;
// Square of the sum of two unit vectors that differ by less than 0.01.
constexpr double straight = 4 - 0.01 * 0.01;

Vec unit(Vec v) {
    return (1.0 / norm(v)) * v;
}

double wrapped_angle(double angle) { // into [0, 2 pi)
    const double turned = std::fmod(angle, two_pi);
    return turned < 0 ? turned + two_pi : turned;
}

WallContact towards(Vec position, Vec closest) {
    WallContact c;
    const Vec d = closest - position;
    c.distance = norm(d);
    c.valid = c.distance > 0;
    if (c.valid) c.direction = (1.0 / c.distance) * d;
    return c;
}

bool is_own(const WallElement& e, Vec p) {
    return dot(p - e.a, e.after) >= 0 && (e.open_end || dot(p - e.b, e.before) < 0);
}

WallContact arc_contact(const WallElement& e, Vec p) {
    const Vec d = p - e.a;
    const double r = norm(d);
    if (r == 0) return {};
    if (e.angle_span < two_pi && wrapped_angle(std::atan2(d.y, d.x) - e.angle_from) > e.angle_span) return {};
    return towards(p, e.a + (e.radius / r) * d);
}

WallContact plane_contact(const WallElement& e, Vec p) {
    WallContact c;
    c.distance = dot(p - e.a, e.b);
    c.direction = -1.0 * e.b;
    c.valid = true;
    return c;
}

WallContact disc_contact(const WallElement& e, Vec p) {
    WallContact c = towards(p, e.a);
    c.radius = e.radius;
    c.inverse_radius = 1.0 / e.radius;
    return c;
}

} // namespace

// ---- construction

Walls::Walls(const scene::Scene& scene, const Plan& plan, const Needs& needs)
    : motions_(scene.motions), rigid_(scene.motions.size()),
      kernel_(scene.domain.dimension == 3 ? surface_kernel(plan) : wall_kernel(plan)),
      remembered_(plan.memory), fields_(plan.memory), lower_(plan.lower), upper_(plan.upper),
      periodic_(scene.domain.periodic), skin_(0.5 * needs.radius_min), radius_max_(needs.radius_max),
      threads_(plan.threads) {
    remembered_.index();
    if (scene.domain.dimension == 3) {
        build_surfaces(scene);
        return;
    }
    for (std::size_t w = 0; w < scene.walls.size(); ++w) add_wall(scene, w);
    elements_ = reference_;
    for (const WallElement& e : reference_) {
        if (e.motion < 0) continue;
        const scene::Motion& m = motions_[static_cast<std::size_t>(e.motion)];
        const double reach = std::max(norm(e.a - m.centre), norm(e.b - m.centre)) + e.radius;
        fastest_ = std::max(fastest_, motion::largest_speed(m, reach));
    }
}

void Walls::add_wall(const scene::Scene& scene, std::size_t index) {
    const scene::Wall& wall = scene.walls[index];
    WallElement e;
    e.wall = static_cast<int>(index);
    e.material = scene::material_index(scene, wall.material);
    e.motion = scene::motion_index(scene, wall.motion);
    switch (wall.kind) {
    case scene::WallKind::plane:
        e.kind = WallElement::Kind::plane;
        e.a = wall.points[0];
        e.b = unit(wall.normal);
        reference_.push_back(e);
        break;
    case scene::WallKind::segment:
    case scene::WallKind::polyline:
        add_chain(wall.points, wall.closed, e);
        break;
    case scene::WallKind::arc: {
        e.kind = WallElement::Kind::arc;
        e.a = e.b = wall.centre;
        e.radius = wall.radius;
        e.angle_from = wall.angle_from;
        e.angle_span = std::min(wall.angle_to - wall.angle_from, two_pi);
        reference_.push_back(e);
        break;
    }
    case scene::WallKind::grains:
        add_grains(wall, e);
        break;
    case scene::WallKind::box:
    case scene::WallKind::cylinder:
    case scene::WallKind::cone:
    case scene::WallKind::mesh:
        break;
    }
}

void Walls::add_chain(const std::vector<Vec>& points, bool closed, WallElement prototype) {
    const std::size_t n = points.size(), segments = closed ? n : n - 1;
    const auto has_segment = [&](std::size_t s) { return closed || s + 1 < n; };
    const auto along = [&](std::size_t s) { return points[(s + 1) % n] - points[s]; };
    const auto is_joint = [&](std::size_t v) { return closed || (v > 0 && v + 1 < n); };
    // Across a straight joint the nearer segment is touched, across a bent one both or its vertex.
    const auto middle = [&](std::size_t v) { return unit(along((v + n - 1) % n)) + unit(along(v)); };
    const auto is_straight = [&](std::size_t v) {
        return is_joint(v) && dot(middle(v), middle(v)) > straight;
    };
    for (std::size_t s = 0; s < segments; ++s) {
        const std::size_t end = (s + 1) % n;
        WallElement e = prototype;
        e.kind = WallElement::Kind::segment;
        e.a = points[s];
        e.b = points[end];
        e.along = along(s);
        e.after = is_straight(s) ? middle(s) : e.along;
        e.before = is_straight(end) ? middle(end) : e.along;
        reference_.push_back(e);
    }
    for (std::size_t v = 0; v < n; ++v) {
        if (is_straight(v)) continue;
        WallElement e = prototype;
        e.kind = WallElement::Kind::vertex;
        e.a = e.b = points[v];
        if (closed || v > 0) e.after = along((v + n - 1) % n);
        e.open_end = !has_segment(v);
        if (!e.open_end) e.before = along(v);
        reference_.push_back(e);
    }
}

void Walls::add_grains(const scene::Wall& wall, WallElement prototype) {
    prototype.kind = WallElement::Kind::disc;
    for (const scene::GrainItem& grain : scene::wall_grains(wall)) {
        prototype.a = prototype.b = grain.position;
        prototype.radius = grain.radius;
        prototype.omega = grain.omega;
        reference_.push_back(prototype);
    }
}

// ---- motion and geometry

void Walls::move_to(double time) {
    if (motions_.empty()) return;
    for (std::size_t m = 0; m < motions_.size(); ++m) rigid_[m] = motion::rigid_state(motions_[m], time);
    if (surfaces_) return;
    for (std::size_t e = 0; e < elements_.size(); ++e) {
        const WallElement& from = reference_[e];
        if (from.motion < 0) continue;
        const motion::RigidState& rigid = rigid_[static_cast<std::size_t>(from.motion)];
        WallElement& to = elements_[e];
        to.a = rigid.position_of(from.a);
        to.b = from.kind == WallElement::Kind::plane ? rigid.rotate(from.b) : rigid.position_of(from.b);
        to.angle_from = from.angle_from + rigid.angle;
        to.along = rigid.rotate(from.along);
        to.after = rigid.rotate(from.after);
        to.before = rigid.rotate(from.before);
    }
}

Vec Walls::closest_point(std::size_t element, Vec p) const {
    if (surfaces_) return closest_on_surface(element, p);
    const WallElement& e = elements_[element];
    return e.kind == WallElement::Kind::segment ? closest_on_segment(e, p) : e.a;
}

WallContact Walls::contact(std::size_t element, Vec p) const {
    const WallElement& e = elements_[element];
    WallContact c;
    switch (e.kind) {
    case WallElement::Kind::plane:
        c = plane_contact(e, p);
        break;
    case WallElement::Kind::segment:
        if (is_own(e, p)) c = towards(p, closest_on_segment(e, p));
        break;
    case WallElement::Kind::vertex:
        if (is_own(e, p)) c = towards(p, e.a);
        break;
    case WallElement::Kind::arc:
        c = arc_contact(e, p);
        break;
    case WallElement::Kind::disc:
        c = disc_contact(e, p);
        break;
    case WallElement::Kind::surface:
        return {};
    }
    if (!c.valid) return c;
    double omega = e.omega;
    if (e.motion >= 0) {
        const motion::RigidState& rigid = rigid_[static_cast<std::size_t>(e.motion)];
        c.velocity =
            rigid.velocity_at(e.kind == WallElement::Kind::disc ? e.a : p + c.distance * c.direction);
        omega += rigid.omega;
    }
    c.angular_velocity = {0, 0, omega};
    if (e.kind == WallElement::Kind::disc) c.spin = e.radius * omega;
    return c;
}

Vec Walls::pivot(const WallElement& element) const {
    if (element.motion < 0) return {};
    const auto m = static_cast<std::size_t>(element.motion);
    const scene::MotionKind kind = motions_[m].kind;
    if (kind != scene::MotionKind::rotate && kind != scene::MotionKind::planetary) return {};
    return rigid_[m].pivot + rigid_[m].shift;
}

std::vector<analysis::WallShape> Walls::shapes(double time) const {
    Walls now = *this;
    now.move_to(time);
    if (surfaces_) return now.surface_shapes();
    std::vector<analysis::WallShape> result;
    for (const WallElement& e : now.elements_) {
        analysis::WallShape shape;
        shape.wall = e.wall;
        shape.material = e.material;
        shape.a = e.a;
        shape.b = e.b;
        shape.centre = e.a;
        shape.radius = e.radius;
        shape.angle_from = e.angle_from;
        shape.angle_to = e.angle_from + e.angle_span;
        const motion::RigidState* rigid =
            e.motion < 0 ? nullptr : &now.rigid_[static_cast<std::size_t>(e.motion)];
        shape.omega = e.omega + (rigid != nullptr ? rigid->omega : 0.0);
        shape.angle = rigid != nullptr ? rigid->angle : 0.0;
        if (rigid != nullptr) shape.velocity = rigid->velocity_at(e.a);
        switch (e.kind) {
        case WallElement::Kind::vertex:
        case WallElement::Kind::surface:
            continue;
        case WallElement::Kind::plane: {
            const Vec along = norm(upper_ - lower_) * Vec{-e.b.y, e.b.x, 0};
            shape.a = e.a - along;
            shape.b = e.a + along;
            break;
        }
        case WallElement::Kind::segment:
            break;
        case WallElement::Kind::arc:
            shape.kind = analysis::WallShape::Kind::arc;
            break;
        case WallElement::Kind::disc:
            shape.kind = analysis::WallShape::Kind::disc;
            break;
        }
        result.push_back(shape);
    }
    return result;
}

} // namespace sandlane::md
