// What happens at an event: two particles collide, one meets a wall. Both algorithms call these.
#pragma once

#include "edmd/setup.hpp"
#include "laws/collision.hpp"
#include "laws/pair_time.hpp"

#include <vector>

namespace sandlane::edmd {

// A particle at the time of an event.
struct Body {
    Vector<double> place{0, 0, 0}, velocity{0, 0, 0}, spin{0, 0, 0};
    std::uint32_t kind = 0;
};

// What a collision did.
struct Impact {
    double gap = 0;       // of the surfaces when they met: rounding, m
    double push = 0;      // normal impulse over m_eff, m/s
    bool elastic = false; // made elastic by the rules against inelastic collapse
    double kept = 0;      // energy that these rules kept, J
    double lost = 0;      // energy that the collision took, J
    double across = 0;    // impulse along x over m_eff, times the y component of the unit vector to i, m/s
};

// Smooth particles of one class with constant restitution: the arithmetic of collide(), with what is trivial
// left out.
template <int dimension>
SANDLANE_INLINE Impact collide_plain(double eps, double reach, double mass, Body& i, Body& j,
                                     const Vector<double>& shift) {
    Vector<double> r = i.place - j.place - shift;
    if constexpr (dimension == 2) r.z = 0;
    const double distance = std::sqrt(dot(r, r));
    const Vector<double> e = (1 / distance) * r;
    // Rounding may let particles that graze part already.
    const double normal = min(dot(i.velocity - j.velocity, e), 0.0);
    const Vector<double> push = laws::smooth_impulse(normal, e, eps);
    i.velocity = i.velocity + 0.5 * push;
    j.velocity = j.velocity - 0.5 * push;
    return {distance - reach, -((1 + eps) * normal), false, 0,
            0.25 * mass * (1 - eps * eps) * normal * normal};
}

// Where the image of a particle is, and how much faster it moves along x than the particle itself.
struct Image {
    Vector<double> shift{0, 0, 0}; // m
    double speed = 0;              // m/s; of a sheared gas
};
// The one so many boxes away, at a time of the epoch.
[[nodiscard]] Image image_of(const Setup& setup, const std::array<std::int64_t, 3>& boxes, double now);
// Of a sheared gas: what left the box in y goes back to it. Returns how many boxes it went down.
std::int64_t fold_height(const Setup& setup, double now, double& x, double& y, double& speed_x);

// With the image of j. soon: one of them had another collision less than the contact time ago. now: since the
// start of the epoch.
Impact collide(const Setup& setup, Body& i, Body& j, const Image& image, bool soon, double now);

// Time of the contact with a wall, from the state of the particle; never_meets if there is none. epoch: time
// of the clock at state.time = 0.
[[nodiscard]] double wall_time(const Setup& setup, const laws::Flight<double>& state, std::uint32_t kind,
                               int wall, double epoch);

struct WallHit {
    int wall;
    double now;          // of the clock, s
    std::uint32_t id;    // of the particle
    std::uint32_t count; // heated walls that it met before
    bool soon;           // as above
};
struct WallEffect {
    double energy = 0; // given to the particle, J
    bool elastic = false;
    bool heated = false;
};
WallEffect meet_wall(const Setup& setup, Body& body, const WallHit& hit);

// From the axis or centre of a curved wall to a place; without what lies along the axis.
[[nodiscard]] Vector<double> from_centre(const Setup& setup, const Curved& curved,
                                         const Vector<double>& place);

// One kick of white noise: what it adds to the velocities of all particles, by id. Stream 3 of the
// specification of Monte Carlo; without mean momentum. number: of the kick.
[[nodiscard]] std::vector<Vector<double>> kicks(const Setup& setup, const std::vector<std::uint32_t>& kinds,
                                                std::int64_t number);

} // namespace sandlane::edmd
