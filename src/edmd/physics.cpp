#include "edmd/physics.hpp"

#include "core/rng.hpp"

#include <cmath>
#include <limits>

namespace sandlane::edmd {

namespace {

constexpr double never = std::numeric_limits<double>::infinity();
// Of the counter of random numbers (specification, 7.4).
constexpr std::uint32_t wall_stream = 4;

double& component(Vector<double>& v, int axis) {
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}
double component(const Vector<double>& v, int axis) {
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

double kinetic(const Setup& setup, const Body& b) {
    const Class& c = setup.classes[b.kind];
    const double moment = c.inertia * c.mass * c.radius * c.radius;
    return 0.5 * c.mass * dot(b.velocity, b.velocity) + 0.5 * moment * dot(b.spin, b.spin);
}

} // namespace

Impact collide(const Setup& setup, Body& i, Body& j, const Vector<double>& shift, bool soon) {
    const Class &a = setup.classes[i.kind], &b = setup.classes[j.kind];
    Vector<double> r = i.place - j.place - shift;
    if (setup.dimension == 2) r.z = 0;
    const double distance = std::sqrt(dot(r, r));
    const Vector<double> e = (1 / distance) * r;
    const Vector<double> relative = i.velocity - j.velocity;
    const double normal = min(dot(relative, e), 0.0);
    Impact impact{distance - (a.radius + b.radius)};
    const double given = laws::restitution(setup.restitution, -normal);
    impact.elastic = soon || -normal < setup.elastic_speed;
    const double eps = impact.elastic ? 1 : given;
    impact.push = -((1 + eps) * normal);
    const double share_i = b.mass / (a.mass + b.mass), share_j = a.mass / (a.mass + b.mass);
    if (impact.elastic) impact.kept = 0.5 * a.mass * share_i * (1 - given * given) * normal * normal;
    if (!setup.rough || impact.elastic) {
        const Vector<double> push = laws::smooth_impulse(normal, e, eps);
        i.velocity = i.velocity + share_i * push;
        j.velocity = j.velocity - share_j * push;
        return impact;
    }
    const Vector<double> g = relative - cross(a.radius * i.spin + b.radius * j.spin, e);
    const double ratio = 1 / (1 + (share_i / a.inertia + share_j / b.inertia));
    double eps_t = setup.tangential;
    if (setup.friction > 0) {
        const Vector<double> along = g - dot(g, e) * e;
        eps_t = laws::sliding_restitution(eps_t, setup.friction, eps, ratio, -normal,
                                          std::sqrt(dot(along, along)));
    }
    const Vector<double> push = laws::impulse(g, e, eps, eps_t, ratio), turn = cross(e, push);
    i.velocity = i.velocity + share_i * push;
    j.velocity = j.velocity - share_j * push;
    i.spin = i.spin - (share_i / (a.inertia * a.radius)) * turn;
    j.spin = j.spin - (share_j / (b.inertia * b.radius)) * turn;
    return impact;
}

double wall_time(const Setup& setup, const laws::Flight<double>& state, std::uint32_t kind, int axis,
                 int upper, double epoch) {
    if (setup.periodic[axis]) return never;
    const Side& side = setup.side[axis][upper];
    const double sign = upper == 0 ? 1 : -1;
    const double bound = upper == 0 ? setup.lower[axis] : setup.upper[axis];
    const double gap = sign * (component(state.place, axis) - bound) - setup.classes[kind].radius;
    const double v = sign * component(state.velocity, axis), g = sign * setup.gravity[axis];
    const double dt = side.moves()
                          ? laws::oscillating_wall_time(gap, v, g, side.motion, epoch + state.time, never)
                          : laws::flat_wall_time(gap, v, g);
    return state.time + dt;
}

namespace {

// Sent back with the temperature of the wall.
void emit(const Setup& setup, Body& body, const WallHit& hit, double wall_speed) {
    const Side& side = setup.side[hit.axis][hit.upper];
    const Class& c = setup.classes[body.kind];
    const auto draw = [&](std::uint32_t block) {
        const auto w =
            philox({4 * hit.count + block, hit.id, 0, wall_stream},
                   {static_cast<std::uint32_t>(setup.seed), static_cast<std::uint32_t>(setup.seed >> 32)});
        return std::array<double, 2>{unit_number(w[0], w[1]), unit_number(w[2], w[3])};
    };
    const double sign = hit.upper == 0 ? 1 : -1;
    const auto [u, accommodates] = draw(0);
    double& normal = component(body.velocity, hit.axis);
    if (accommodates >= side.accommodation) {
        normal = sign * (2 * wall_speed - sign * normal);
        return;
    }
    const double speed = std::sqrt(side.temperature / c.mass);
    normal = sign * (wall_speed + speed * laws::flux_speed(u));
    const auto [u1, w1] = draw(1);
    const auto along = laws::normal_pair(u1, w1);
    for (int d = 0, n = 0; d < setup.dimension; ++d)
        if (d != hit.axis)
            component(body.velocity, d) = side.velocity[d] + speed * along[static_cast<std::size_t>(n++)];
    if (!setup.rough) return;
    const double spin = speed / (std::sqrt(c.inertia) * c.radius);
    const auto [u2, w2] = draw(2);
    const auto first = laws::normal_pair(u2, w2);
    if (setup.dimension == 2) {
        body.spin.z = spin * first[0];
        return;
    }
    const auto [u3, w3] = draw(3);
    body.spin = {spin * first[0], spin * first[1], spin * laws::normal_pair(u3, w3)[0]};
}

void reflect(const Setup& setup, Body& body, const WallHit& hit, double wall_speed, bool elastic) {
    const Side& side = setup.side[hit.axis][hit.upper];
    const Class& c = setup.classes[body.kind];
    const double sign = hit.upper == 0 ? 1 : -1;
    double& normal = component(body.velocity, hit.axis);
    const double eps_n = elastic ? 1 : side.eps_n;
    if (!setup.rough || side.eps_t == 1 || elastic) {
        normal = sign * (wall_speed - eps_n * min(sign * normal - wall_speed, 0.0));
        return;
    }
    Vector<double> e{0, 0, 0}, wall{side.velocity[0], side.velocity[1], side.velocity[2]};
    component(e, hit.axis) = sign;
    component(wall, hit.axis) = sign * wall_speed;
    const Vector<double> g = body.velocity - wall - cross(c.radius * body.spin, e);
    const Vector<double> push = laws::impulse(g, e, eps_n, side.eps_t, c.inertia / (1 + c.inertia));
    body.velocity = body.velocity + push;
    body.spin = body.spin - (1 / (c.inertia * c.radius)) * cross(e, push);
}

} // namespace

WallEffect meet_wall(const Setup& setup, Body& body, const WallHit& hit) {
    const Side& side = setup.side[hit.axis][hit.upper];
    const double speed = side.moves() ? side.motion.velocity(hit.now) : 0.0;
    const double before = kinetic(setup, body);
    WallEffect effect;
    effect.heated = side.kind == Side::Kind::heated;
    if (effect.heated) {
        emit(setup, body, hit, speed);
    } else {
        const double sign = hit.upper == 0 ? 1 : -1;
        const double toward = speed - sign * component(body.velocity, hit.axis);
        effect.elastic = hit.soon || toward < setup.elastic_speed;
        reflect(setup, body, hit, speed, effect.elastic);
    }
    effect.energy = kinetic(setup, body) - before;
    return effect;
}

} // namespace sandlane::edmd
