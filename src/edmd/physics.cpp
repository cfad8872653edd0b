#include "edmd/physics.hpp"

#include "core/rng.hpp"

#include <cmath>
#include <limits>

namespace sandlane::edmd {

namespace {

constexpr double never = std::numeric_limits<double>::infinity();
// Of the counter of random numbers (specification, 7.4).
constexpr std::uint32_t kick_stream = 3, wall_stream = 4;

double& component(Vector<double>& v, int axis) {
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}
double component(const Vector<double>& v, int axis) {
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

double kinetic(const Setup& setup, const Body& b) {
    const Class& c = setup.classes[b.kind];
    return 0.5 * c.mass * dot(b.velocity, b.velocity) + 0.5 * c.moment() * dot(b.spin, b.spin);
}

} // namespace

Image image_of(const Setup& setup, const std::array<std::int64_t, 3>& boxes, double now) {
    Image image;
    for (int d = 0; d < setup.dimension; ++d)
        if (setup.periodic[d])
            component(image.shift, d) =
                static_cast<double>(boxes[static_cast<std::size_t>(d)]) * setup.length(d);
    if (setup.shear == 0) return image;
    const auto up = static_cast<double>(boxes[1]);
    image.shift.x += up * setup.offset_at(now);
    image.speed = up * setup.image_speed();
    return image;
}

std::int64_t fold_height(const Setup& setup, double now, double& x, double& y, double& speed_x) {
    const double boxes = std::floor((y - setup.lower[1]) / setup.length(1));
    if (boxes == 0) return 0;
    y -= boxes * setup.length(1);
    x -= boxes * setup.offset_at(now);
    speed_x -= boxes * setup.image_speed();
    return static_cast<std::int64_t>(boxes);
}

Impact collide(const Setup& setup, Body& i, Body& j, const Image& image, bool soon, double now) {
    const Class &a = setup.classes[i.kind], &b = setup.classes[j.kind];
    Vector<double> r = i.place - j.place - image.shift;
    if (setup.dimension == 2) r.z = 0;
    const double distance = std::sqrt(dot(r, r));
    const Vector<double> e = (1 / distance) * r;
    Vector<double> relative = i.velocity - j.velocity;
    relative.x -= image.speed;
    // Of the surfaces, which approach by themselves where radii grow.
    const double reach = a.radius + b.radius;
    const double normal = min(dot(relative, e) - reach * setup.growth, 0.0);
    Impact impact{distance - reach * (setup.scale + setup.growth * now)};
    const double given = laws::restitution(setup.restitution_of(i.kind, j.kind), -normal);
    impact.elastic = soon || -normal < setup.elastic_speed;
    const double eps = impact.elastic ? 1 : given;
    impact.push = -((1 + eps) * normal);
    const double share_i = b.mass / (a.mass + b.mass), share_j = a.mass / (a.mass + b.mass);
    const double taken = 0.5 * a.mass * share_i * (1 - given * given) * normal * normal;
    (impact.elastic ? impact.kept : impact.lost) = taken;
    if (!setup.rough || impact.elastic) {
        const Vector<double> push = laws::smooth_impulse(normal, e, eps);
        i.velocity = i.velocity + share_i * push;
        j.velocity = j.velocity - share_j * push;
        impact.across = push.x * e.y;
        return impact;
    }
    const Vector<double> g = relative - cross(a.radius * i.spin + b.radius * j.spin, e);
    const double ratio = 1 / (1 + (share_i / a.inertia + share_j / b.inertia));
    double eps_t = setup.tangential;
    const Vector<double> along = g - dot(g, e) * e;
    if (setup.friction > 0)
        eps_t = laws::sliding_restitution(eps_t, setup.friction, eps, ratio, -normal,
                                          std::sqrt(dot(along, along)));
    impact.lost += 0.5 * a.mass * share_i * ratio * (1 - eps_t * eps_t) * dot(along, along);
    const Vector<double> push = laws::impulse(g, e, eps, eps_t, ratio), turn = cross(e, push);
    impact.across = push.x * e.y;
    i.velocity = i.velocity + share_i * push;
    j.velocity = j.velocity - share_j * push;
    i.spin = i.spin - (share_i / (a.inertia * a.radius)) * turn;
    j.spin = j.spin - (share_j / (b.inertia * b.radius)) * turn;
    return impact;
}

double wall_time(const Setup& setup, const laws::Flight<double>& state, std::uint32_t kind, int wall,
                 double epoch) {
    const double radius = setup.classes[kind].radius;
    if (wall >= 6) {
        const Curved& c = setup.curved[static_cast<std::size_t>(wall - 6)];
        const Vector<double> gravity{setup.gravity[0], setup.gravity[1], setup.gravity[2]};
        Vector<double> v = state.velocity, g = gravity;
        if (c.axis >= 0) component(v, c.axis) = component(g, c.axis) = 0;
        const double distance = c.container ? c.radius - radius : c.radius + radius;
        return state.time +
               laws::curved_wall_time(from_centre(setup, c, state.place), v, g, distance, c.container);
    }
    const int axis = wall / 2, upper = wall % 2;
    if (axis >= setup.dimension || setup.periodic[axis]) return never;
    const Side& side = setup.side[axis][upper];
    const double sign = upper == 0 ? 1 : -1;
    const double bound = upper == 0 ? setup.lower[axis] : setup.upper[axis];
    double gap =
        sign * (component(state.place, axis) - bound) - radius * (setup.scale + setup.growth * state.time);
    double v = sign * component(state.velocity, axis) - radius * setup.growth;
    const double g = sign * setup.gravity[axis];
    if (side.oscillates())
        return state.time + laws::oscillating_wall_time(gap, v, g, side.motion, epoch + state.time, never);
    if (side.speed != 0) {
        gap -= side.speed * (epoch + state.time);
        v -= side.speed;
    }
    return state.time + laws::flat_wall_time(gap, v, g);
}

Vector<double> from_centre(const Setup& setup, const Curved& curved, const Vector<double>& place) {
    Vector<double> r{place.x - curved.center[0], place.y - curved.center[1], place.z - curved.center[2]};
    if (setup.dimension == 2) r.z = 0;
    if (curved.axis >= 0) component(r, curved.axis) = 0;
    return r;
}

std::vector<Vector<double>> kicks(const Setup& setup, const std::vector<std::uint32_t>& kinds,
                                  std::int64_t number) {
    const double deviation = std::sqrt(setup.kicks * setup.kick_interval);
    std::vector<Vector<double>> all(kinds.size());
    Vector<double> momentum{0, 0, 0};
    double mass = 0;
    for (std::size_t n = 0; n < all.size(); ++n) {
        const auto normals = [&](std::uint32_t block) {
            const auto w = philox(
                {block, static_cast<std::uint32_t>(n), static_cast<std::uint32_t>(number), kick_stream},
                {static_cast<std::uint32_t>(setup.seed), static_cast<std::uint32_t>(setup.seed >> 32)});
            return laws::normal_pair(unit_number(w[0], w[1]), unit_number(w[2], w[3]));
        };
        const auto xy = normals(0);
        all[n] = {deviation * xy[0], deviation * xy[1],
                  setup.dimension == 3 ? deviation * normals(1)[0] : 0.0};
        const double m = setup.classes[kinds[n]].mass;
        momentum = momentum + m * all[n];
        mass += m;
    }
    for (Vector<double>& v : all) v = v - (1 / mass) * momentum;
    return all;
}

namespace {

// What a heated wall sends a particle back with.
struct Emission {
    bool accommodates = false; // else it is reflected elastically
    double normal = 0;         // m/s, away from the wall
    std::array<double, 2> along{};
    Vector<double> spin{0, 0, 0}; // rough particles
};

Emission emission(const Setup& setup, const Side& side, const Class& c, const WallHit& hit) {
    const auto draw = [&](std::uint32_t block) {
        const auto w =
            philox({4 * hit.count + block, hit.id, 0, wall_stream},
                   {static_cast<std::uint32_t>(setup.seed), static_cast<std::uint32_t>(setup.seed >> 32)});
        return std::array<double, 2>{unit_number(w[0], w[1]), unit_number(w[2], w[3])};
    };
    const auto [u, accommodates] = draw(0);
    Emission e;
    e.accommodates = accommodates < side.accommodation;
    if (!e.accommodates) return e;
    const double speed = std::sqrt(side.temperature / c.mass);
    e.normal = speed * laws::flux_speed(u);
    const auto [u1, w1] = draw(1);
    const auto along = laws::normal_pair(u1, w1);
    e.along = {speed * along[0], speed * along[1]};
    if (!setup.rough) return e;
    const double spin = speed / (std::sqrt(c.inertia) * c.radius);
    const auto [u2, w2] = draw(2);
    const auto first = laws::normal_pair(u2, w2);
    if (setup.dimension == 2) {
        e.spin = {0, 0, spin * first[0]};
        return e;
    }
    const auto [u3, w3] = draw(3);
    e.spin = {spin * first[0], spin * first[1], spin * laws::normal_pair(u3, w3)[0]};
    return e;
}

void emit(const Setup& setup, const Side& side, Body& body, const WallHit& hit, double wall_speed) {
    const double sign = hit.wall % 2 == 0 ? 1 : -1;
    const int axis = hit.wall / 2;
    const Emission e = emission(setup, side, setup.classes[body.kind], hit);
    double& normal = component(body.velocity, axis);
    if (!e.accommodates) {
        normal = sign * (2 * wall_speed - sign * normal);
        return;
    }
    normal = sign * (wall_speed + e.normal);
    for (int d = 0, n = 0; d < setup.dimension; ++d)
        if (d != axis)
            component(body.velocity, d) = side.velocity[d] + e.along[static_cast<std::size_t>(n++)];
    if (setup.rough) body.spin = e.spin;
}

// From a wall with the normal e that moves along it with wall_speed, and beside it with side.velocity.
void reflect(const Setup& setup, const Side& side, Body& body, const Vector<double>& e, double wall_speed,
             bool elastic) {
    const Class& c = setup.classes[body.kind];
    const double eps_n = elastic ? 1 : side.eps_n;
    if (!setup.rough || side.eps_t == 1 || elastic) {
        // As a sum of parts, so that no rounding leaves it slower than the wall.
        const double normal = dot(body.velocity, e);
        const double after = max(normal, wall_speed - eps_n * min(normal - wall_speed, 0.0));
        body.velocity = (body.velocity - normal * e) + after * e;
        return;
    }
    const Vector<double> slide{side.velocity[0], side.velocity[1], side.velocity[2]};
    const Vector<double> wall = slide + (wall_speed - dot(slide, e)) * e;
    const Vector<double> g = body.velocity - wall - cross(c.radius * body.spin, e);
    const Vector<double> push = laws::impulse(g, e, eps_n, side.eps_t, c.inertia / (1 + c.inertia));
    body.velocity = body.velocity + push;
    body.spin = body.spin - (1 / (c.inertia * c.radius)) * cross(e, push);
}

WallEffect meet_curved(const Setup& setup, Body& body, const WallHit& hit) {
    const Curved& curved = setup.curved[static_cast<std::size_t>(hit.wall - 6)];
    const Side& side = curved.wall;
    const Vector<double> r = from_centre(setup, curved, body.place);
    const double distance = std::sqrt(dot(r, r));
    const Vector<double> e = ((curved.container ? -1 : 1) / distance) * r;
    const double before = kinetic(setup, body);
    WallEffect effect;
    effect.heated = side.kind == Side::Kind::heated;
    if (!effect.heated) {
        effect.elastic = hit.soon || -dot(body.velocity, e) < setup.elastic_speed;
        reflect(setup, side, body, e, 0, effect.elastic);
        effect.energy = kinetic(setup, body) - before;
        return effect;
    }
    const Emission out = emission(setup, side, setup.classes[body.kind], hit);
    if (!out.accommodates) {
        reflect(setup, side, body, e, 0, true);
        return effect;
    }
    // Two directions along the wall: of the axis that is farthest from e, in the plane of z.
    Vector<double> axis{0, 0, 1};
    if (setup.dimension == 3) {
        const double x = std::abs(e.x), y = std::abs(e.y), z = std::abs(e.z);
        axis = {0, 0, 0};
        component(axis, x <= y && x <= z ? 0 : y <= z ? 1 : 2) = 1;
    }
    const Vector<double> across = cross(axis, e);
    const Vector<double> t1 = (1 / std::sqrt(dot(across, across))) * across, t2 = cross(e, t1);
    body.velocity = out.normal * e + out.along[0] * t1;
    if (setup.dimension == 3) body.velocity = body.velocity + out.along[1] * t2;
    if (setup.rough) body.spin = out.spin;
    effect.energy = kinetic(setup, body) - before;
    return effect;
}

} // namespace

WallEffect meet_wall(const Setup& setup, Body& body, const WallHit& hit) {
    if (hit.wall >= 6) return meet_curved(setup, body, hit);
    const Side& side = setup.side[hit.wall / 2][hit.wall % 2];
    const double speed = (side.oscillates() ? side.motion.velocity(hit.now) : side.speed) +
                         setup.classes[body.kind].radius * setup.growth;
    const double before = kinetic(setup, body);
    WallEffect effect;
    effect.heated = side.kind == Side::Kind::heated;
    if (effect.heated) {
        emit(setup, side, body, hit, speed);
    } else {
        Vector<double> e{0, 0, 0};
        component(e, hit.wall / 2) = hit.wall % 2 == 0 ? 1 : -1;
        effect.elastic = hit.soon || speed - dot(body.velocity, e) < setup.elastic_speed;
        reflect(setup, side, body, e, speed, effect.elastic);
    }
    effect.energy = kinetic(setup, body) - before;
    return effect;
}

} // namespace sandlane::edmd
