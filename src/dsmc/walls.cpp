#include "dsmc/walls.hpp"

#include "core/rng.hpp"
#include "laws/collision.hpp"
#include "motion/ballistic.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

namespace sandlane::simd {

namespace {

struct Particle {
    double *place, *velocity, *spin;

    [[nodiscard]] const GasWallKind& kind(const GasWalls& walls) const {
        return walls.kind[std::bit_cast<std::uint64_t>(velocity[3]) >> 60];
    }
};

void advance(const GasFlightView& view, const Particle& p, double duration) {
    for (int d = 0; d < view.walls->dimension; ++d) {
        p.place[d] = motion::straight(p.place[d], p.velocity[d], duration);
        if (!view.falls) continue;
        p.place[d] = motion::bent(p.place[d], view.gravity[d], 0.5 * duration * duration);
        p.velocity[d] = p.velocity[d] + view.gravity[d] * duration;
    }
}

// Whether the flight stays where there are no walls: the test of the kernels, one particle.
bool is_safe(const GasFlightView& view, const Particle& p, double duration) {
    for (int d = 0; d < view.walls->dimension; ++d) {
        double to = motion::straight(p.place[d], p.velocity[d], duration);
        double least = min(p.place[d], to), most = max(p.place[d], to);
        if (view.falls) {
            to = motion::bent(to, view.gravity[d], 0.5 * duration * duration);
            least = min(least, to);
            most = max(most, to);
        }
        if (!(least >= view.safe_lower[d] && most < view.safe_upper[d])) return false;
    }
    return true;
}

struct Hit {
    double time = std::numeric_limits<double>::infinity(); // after now, s
    int axis = 0, upper = 0;
};

// The first wall within `limit` after the time `now`.
Hit next_hit(const GasFlightView& view, const Particle& p, double now, double limit) {
    Hit first;
    const GasWalls& walls = *view.walls;
    for (int d = 0; d < walls.dimension; ++d) {
        if (walls.periodic[d]) continue;
        for (int upper = 0; upper < 2; ++upper) {
            const GasSide& side = walls.side[d][upper];
            const double sign = upper == 0 ? 1 : -1;
            const double gap = sign * (p.place[d] - (upper == 0 ? walls.lower[d] : walls.upper[d]));
            const double v = sign * p.velocity[d], g = view.falls ? sign * view.gravity[d] : 0;
            const double t = side.moves() ? laws::oscillating_wall_time(gap, v, g, side.motion, now, limit)
                                          : laws::flat_wall_time(gap, v, g);
            if (t <= limit && t < first.time) first = {t, d, upper};
        }
    }
    return first;
}

// Per mass of the first kind.
double kinetic(const Particle& p, const GasWalls& walls) {
    double sum = 0;
    for (int d = 0; d < 3; ++d) sum += 0.5 * p.velocity[d] * p.velocity[d];
    const GasWallKind& kind = p.kind(walls);
    const double inertia = walls.inertia * kind.radius * kind.radius;
    if (kind.radius > 0)
        for (int d = 0; d < 3; ++d) sum += 0.5 * inertia * p.spin[d] * p.spin[d];
    return kind.mass * sum;
}

// The heated wall of the specification of event-driven dynamics, 7.4, draws (4 hit + block, id, step).
void emit(const GasFlightView& view, const Particle& p, const Hit& hit, double wall_speed,
          std::uint32_t number) {
    const GasWalls& walls = *view.walls;
    const GasSide& side = walls.side[hit.axis][hit.upper];
    const GasWallKind& kind = p.kind(walls);
    const double speed = side.thermal_speed * kind.speed;
    std::uint32_t id = 0;
    std::memcpy(&id, p.place + 3, sizeof id);
    const auto draw = [&](std::uint32_t block) {
        const auto w =
            philox({4 * number + block, id, view.random.step, view.random.last_word(GasStream::wall)},
                   {view.random.key[0], view.random.key[1]});
        return std::array<double, 2>{unit_number(w[0], w[1]), unit_number(w[2], w[3])};
    };
    const double sign = hit.upper == 0 ? 1 : -1;
    const auto [u, accommodates] = draw(0);
    if (accommodates >= side.accommodation) {
        p.velocity[hit.axis] = sign * (2 * wall_speed - sign * p.velocity[hit.axis]);
        return;
    }
    p.velocity[hit.axis] = sign * (wall_speed + speed * laws::flux_speed(u));
    const auto [u1, w1] = draw(1);
    const auto along = laws::normal_pair(u1, w1);
    for (int d = 0, n = 0; d < walls.dimension; ++d)
        if (d != hit.axis) p.velocity[d] = side.velocity[d] + speed * along[static_cast<std::size_t>(n++)];
    if (!(kind.radius > 0)) return;
    const double spin = side.thermal_speed * kind.spin_speed;
    const auto [u2, w2] = draw(2);
    const auto first = laws::normal_pair(u2, w2);
    if (walls.dimension == 2) {
        p.spin[2] = spin * first[0];
        return;
    }
    const auto [u3, w3] = draw(3);
    p.spin[0] = spin * first[0];
    p.spin[1] = spin * first[1];
    p.spin[2] = spin * laws::normal_pair(u3, w3)[0];
}

void reflect(const GasFlightView& view, const Particle& p, const Hit& hit, double wall_speed) {
    const GasWalls& walls = *view.walls;
    const GasSide& side = walls.side[hit.axis][hit.upper];
    const double sign = hit.upper == 0 ? 1 : -1;
    const double radius = p.kind(walls).radius;
    if (!(radius > 0) || side.eps_t == 1) {
        const double toward = sign * p.velocity[hit.axis] - wall_speed; // negative
        p.velocity[hit.axis] = sign * (wall_speed - side.eps_n * toward);
        return;
    }
    double normal[3] = {0, 0, 0}, wall[3] = {side.velocity[0], side.velocity[1], side.velocity[2]};
    normal[hit.axis] = sign;
    wall[hit.axis] = sign * wall_speed;
    const Vector<double> e{normal[0], normal[1], normal[2]};
    const Vector<double> relative{p.velocity[0] - wall[0], p.velocity[1] - wall[1], p.velocity[2] - wall[2]};
    const Vector<double> spin{p.spin[0], p.spin[1], p.spin[2]};
    const Vector<double> g = relative - cross(radius * spin, e);
    const Vector<double> push =
        laws::impulse(g, e, side.eps_n, side.eps_t, walls.inertia / (1 + walls.inertia));
    const Vector<double> turn = (1 / (walls.inertia * radius)) * cross(e, push);
    p.velocity[0] += push.x, p.velocity[1] += push.y, p.velocity[2] += push.z;
    p.spin[0] -= turn.x, p.spin[1] -= turn.y, p.spin[2] -= turn.z;
}

// Images crossed stand in the last word of the velocity, 20 bits each.
void count_image(double* velocity, int axis, int step) {
    constexpr std::uint64_t mask = 0xfffff;
    const int shift = 20 * axis;
    auto word = std::bit_cast<std::uint64_t>(velocity[3]);
    const std::uint64_t count = (word >> shift) + static_cast<std::uint64_t>(static_cast<std::int64_t>(step));
    word = (word & ~(mask << shift)) | (count & mask) << shift;
    velocity[3] = std::bit_cast<double>(word);
}

void settle(const GasFlightView& view, const Particle& p, double now) {
    const GasWalls& walls = *view.walls;
    if (walls.shear != 0) { // a box above or below has moved along x, and moves
        const double height = walls.upper[1] - walls.lower[1];
        const double turns = std::floor((p.place[1] - walls.lower[1]) / height);
        if (turns != 0) {
            const double speed = walls.shear * height;
            p.place[0] -= turns * std::fmod(speed * now, walls.upper[0] - walls.lower[0]);
            p.velocity[0] -= turns * speed;
        }
    }
    for (int d = 0; d < walls.dimension; ++d) {
        const double lower = walls.lower[d], upper = walls.upper[d], period = upper - lower;
        if (walls.periodic[d]) {
            if (p.place[d] >= lower && p.place[d] < upper) continue;
            const double turns = std::floor((p.place[d] - lower) / period);
            p.place[d] -= turns * period;
            count_image(p.velocity, d, static_cast<int>(turns));
            if (p.place[d] >= upper || p.place[d] < lower) p.place[d] = lower; // rounding
            continue;
        }
        const auto at = [&](int side) {
            const laws::Oscillation& motion = walls.side[d][side].motion;
            return motion.amplitude > 0 ? motion.displacement(now) : 0.0;
        };
        p.place[d] = std::clamp(p.place[d], lower + at(0), upper - at(1)); // rounding
    }
}

} // namespace

void fly_to_walls(const GasFlightView& view, double* place, double* velocity, double* spin, bool second,
                  GasFlight& result) {
    const Particle p{place, velocity, spin};
    const GasWalls& walls = *view.walls;
    double left = view.durations[second ? 1 : 0];
    if (is_safe(view, p, left)) {
        advance(view, p, left);
        return;
    }
    double now = walls.time[second ? 1 : 0];
    if (walls.periodic[0] && walls.periodic[1] && walls.periodic[2]) {
        advance(view, p, left);
        settle(view, p, now + left);
        return;
    }
    const double before = kinetic(p, walls);
    double fallen = 0; // work of gravity
    const auto height = [&] {
        double sum = 0;
        for (int d = 0; d < walls.dimension; ++d) sum += view.gravity[d] * p.place[d];
        return view.falls ? p.kind(walls).mass * sum : 0.0;
    };
    bool met = false;
    const double start = height();
    for (std::uint32_t hits = 0;; ++hits) {
        const Hit hit = next_hit(view, p, now, left);
        if (!(hit.time <= left)) break;
        met = true;
        advance(view, p, hit.time);
        now += hit.time;
        left -= hit.time;
        const GasSide& side = walls.side[hit.axis][hit.upper];
        const double wall_speed = side.moves() ? side.motion.velocity(now) : 0.0;
        const double at = side.moves() ? side.motion.displacement(now) : 0.0;
        place[hit.axis] = hit.upper == 0 ? walls.lower[hit.axis] + at : walls.upper[hit.axis] - at;
        if (hits == most_hits) { // it comes to rest at the wall
            velocity[hit.axis] = (hit.upper == 0 ? 1 : -1) * wall_speed;
            ++result.stuck;
            left = 0;
            break;
        }
        if (side.kind == GasSide::Kind::heated)
            emit(view, p, hit, wall_speed, hits + (second ? most_hits : 0));
        else
            reflect(view, p, hit, wall_speed);
    }
    if (left > 0) advance(view, p, left);
    fallen = height() - start;
    if (met) result.wall_energy[second ? 1 : 0] += kinetic(p, walls) - before - fallen;
    settle(view, p, now + left);
}

} // namespace sandlane::simd
