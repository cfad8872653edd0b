// When two hard particles that fly freely meet: a pure function of both states, on R = double or a block of
// lanes, so that whoever asks, and when, gets the same bits (specification of event-driven
// dynamics, 5.1-5.9).
#pragma once

#include "core/vector.hpp"

namespace sandlane::laws {

// Time from now to the contact of particles at relative place r and velocity v whose radii sum up to `reach`:
// the smaller root of |r + v t| = reach, in forms without cancellation; `never` if there is none. Particles
// that touch or overlap by rounding and approach meet now.
template <int dimension, class R>
SANDLANE_INLINE R meeting(const Vector<R>& r, const Vector<R>& v, const R& reach, const R& never) {
    R a = v.x * v.x + v.y * v.y, b = r.x * v.x + r.y * v.y, distance = r.x * r.x + r.y * r.y;
    const R square = reach * reach, turn = r.x * v.y - r.y * v.x;
    R across = turn * turn;
    if constexpr (dimension == 3) {
        a = dot(v, v);
        b = dot(r, v);
        distance = dot(r, r);
        const Vector<R> turns = cross(r, v);
        across = dot(turns, turns);
    }
    const R c = distance - square, under = a * square - across;
    const auto approach = b < R(0.0), reached = under >= R(0.0);
    const R gap = max(c, R(0.0));
    // Touching is decided before the discriminant, which may be rounded below zero then.
    const R root = sqrt(max(under, R(0.0)));
    const R time = gap / (select(approach, root - b, R(1.0)));
    const R met = select(reached, time, select(c > R(0.0), never, R(0.0)));
    return select(approach, met, never);
}

// Whether surfaces touch, but for rounding: how one knows the image with which a particle has just collided.
inline bool touches(const Vector<double>& r, double reach) {
    return dot(r, r) <= (1 + 1e-9) * (reach * reach);
}

// What the flight of a particle is known by: place and velocity at `time`.
template <class R> struct Flight {
    Vector<R> place, velocity;
    R time;
};

// Place and velocity after dt, in a uniform field if it falls.
template <int dimension, bool falls, class R>
SANDLANE_INLINE void fly(Flight<R>& f, const R& dt, const Vector<R>& field) {
    f.place.x = f.place.x + f.velocity.x * dt;
    f.place.y = f.place.y + f.velocity.y * dt;
    if constexpr (dimension == 3) f.place.z = f.place.z + f.velocity.z * dt;
    if constexpr (falls) {
        const R half = R(0.5) * (dt * dt);
        f.place.x = f.place.x + field.x * half;
        f.place.y = f.place.y + field.y * half;
        f.velocity.x = f.velocity.x + field.x * dt;
        f.velocity.y = f.velocity.y + field.y * dt;
        if constexpr (dimension == 3) {
            f.place.z = f.place.z + field.z * half;
            f.velocity.z = f.velocity.z + field.z * dt;
        }
    }
}

// Time of the contact of i with the image of j that is `shift` away: both are flown to the later of their two
// times, then as above.
template <int dimension, bool falls, class R>
SANDLANE_INLINE R pair_time(Flight<R> i, Flight<R> j, const Vector<R>& shift, const R& reach,
                            const Vector<R>& field, const R& never) {
    const R base = max(i.time, j.time);
    fly<dimension, falls>(i, base - i.time, field);
    fly<dimension, falls>(j, base - j.time, field);
    Vector<R> r, v;
    r.x = (i.place.x - j.place.x) - shift.x;
    r.y = (i.place.y - j.place.y) - shift.y;
    v.x = i.velocity.x - j.velocity.x;
    v.y = i.velocity.y - j.velocity.y;
    if constexpr (dimension == 3) {
        r.z = (i.place.z - j.place.z) - shift.z;
        v.z = i.velocity.z - j.velocity.z;
    }
    return base + meeting<dimension>(r, v, reach, never);
}

} // namespace sandlane::laws
