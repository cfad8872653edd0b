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

// The same for radii that grow: their sum is `reach` now and grows with `speed` [m/s]. Particles that recede
// more slowly than that meet, too.
template <int dimension, class R>
SANDLANE_INLINE R growing_meeting(const Vector<R>& r, const Vector<R>& v, const R& reach, const R& speed,
                                  const R& never) {
    R a = v.x * v.x + v.y * v.y, b = r.x * v.x + r.y * v.y, distance = r.x * r.x + r.y * r.y;
    if constexpr (dimension == 3) {
        a = dot(v, v);
        b = dot(r, v);
        distance = dot(r, r);
    }
    a = a - speed * speed;
    b = b - reach * speed;
    const R c = max(distance - reach * reach, R(0.0)), under = b * b - a * c;
    const R root = sqrt(max(under, R(0.0)));
    const auto approach = b < R(0.0), reached = under >= R(0.0), overtaken = a < R(0.0);
    const R sooner = c / select(approach, root - b, R(1.0));
    const R later = (b + root) / select(overtaken, -a, R(1.0));
    const R met = select(approach, select(reached, sooner, never), select(overtaken, later, never));
    return select(distance > R(0.0), met, never); // nothing meets itself
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

// Relative place and velocity of i and the image of j that is `shift` away, at `base`, the later of their two
// times.
template <class R> struct Relative {
    Vector<R> place, velocity;
    R base;
};
template <int dimension, bool falls, class R>
SANDLANE_INLINE Relative<R> relative(Flight<R> i, Flight<R> j, const Vector<R>& shift,
                                     const Vector<R>& field) {
    Relative<R> p;
    p.base = max(i.time, j.time);
    fly<dimension, falls>(i, p.base - i.time, field);
    fly<dimension, falls>(j, p.base - j.time, field);
    p.place.x = (i.place.x - j.place.x) - shift.x;
    p.place.y = (i.place.y - j.place.y) - shift.y;
    p.velocity.x = i.velocity.x - j.velocity.x;
    p.velocity.y = i.velocity.y - j.velocity.y;
    if constexpr (dimension == 3) {
        p.place.z = (i.place.z - j.place.z) - shift.z;
        p.velocity.z = i.velocity.z - j.velocity.z;
    }
    return p;
}

// Time of their contact.
template <int dimension, bool falls, class R>
SANDLANE_INLINE R pair_time(const Flight<R>& i, const Flight<R>& j, const Vector<R>& shift, const R& reach,
                            const Vector<R>& field, const R& never) {
    const Relative<R> p = relative<dimension, falls>(i, j, shift, field);
    return p.base + meeting<dimension>(p.place, p.velocity, reach, never);
}

// The same for the image of j that is `turns` boxes above i besides, boxes that glide along x: each is offset
// + speed t further than the one below it (Lees and Edwards).
template <int dimension, class R>
SANDLANE_INLINE R sheared_pair_time(const Flight<R>& i, const Flight<R>& j, const Vector<R>& shift,
                                    const R& turns, const R& reach, const R& offset, const R& speed,
                                    const R& never) {
    Relative<R> p = relative<dimension, false>(i, j, shift, Vector<R>{});
    p.place.x = p.place.x - turns * (offset + speed * p.base);
    p.velocity.x = p.velocity.x - turns * speed;
    return p.base + meeting<dimension>(p.place, p.velocity, reach, never);
}

// The same for radii scale + growth t times as large.
template <int dimension, class R>
SANDLANE_INLINE R growing_pair_time(const Flight<R>& i, const Flight<R>& j, const Vector<R>& shift,
                                    const R& reach, const R& scale, const R& growth, const R& never) {
    const Relative<R> p = relative<dimension, false>(i, j, shift, Vector<R>{});
    return p.base + growing_meeting<dimension>(p.place, p.velocity, reach * (scale + growth * p.base),
                                               reach * growth, never);
}

} // namespace sandlane::laws
