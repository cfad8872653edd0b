#include "motion/prescribed.hpp"

#include <cmath>

namespace sandlane::motion {

namespace {

Vec unit_axis(const scene::Motion& m) {
    return (1 / norm(m.axis)) * m.axis;
}

// Rodrigues' formula; about z it gives the plane rotation to the last bit.
void turn(RigidState& state, Vec axis, double angle, double omega) {
    state.angle = angle;
    state.omega = omega;
    state.angular_velocity = omega * axis;
    const double cosine = std::cos(angle), sine = std::sin(angle);
    const Vec along = (1 - cosine) * axis, across = sine * axis;
    state.row[0] = along.x * axis + Vec{cosine, -across.z, across.y};
    state.row[1] = along.y * axis + Vec{across.z, cosine, -across.x};
    state.row[2] = along.z * axis + Vec{-across.y, across.x, cosine};
}

void oscillate(RigidState& state, const scene::Motion& m, double time) {
    const double argument = m.omega * (time - m.start) + m.phase;
    const bool sine = m.wave == scene::Wave::sine;
    const double wave = sine ? std::sin(argument) : std::cos(argument);
    const double slope = sine ? std::cos(argument) : -std::sin(argument);
    state.shift = wave * m.amplitude;
    state.shift_velocity = (m.omega * slope) * m.amplitude;
}

// Drum whose centre runs on a circle of orbit_radius about m.centre while it spins: positions are given for a
// drum centred at m.centre, so the shift is the orbit itself (type 4). The orbit lies across the axis and
// starts along x, or along y where the axis leads close to x.
void planetary(RigidState& state, const scene::Motion& m, double time) {
    const double argument = m.orbit_omega * (time - m.start) + m.phase;
    const Vec axis = unit_axis(m), start = std::abs(axis.x) < 0.9 ? Vec{1, 0, 0} : Vec{0, 1, 0};
    const Vec across = start - dot(start, axis) * axis, first = (1 / norm(across)) * across;
    const Vec second = cross(axis, first);
    const double cosine = std::cos(argument), sine = std::sin(argument);
    state.shift = m.orbit_radius * (cosine * first + sine * second);
    state.shift_velocity = (m.orbit_radius * m.orbit_omega) * (-sine * first + cosine * second);
    turn(state, axis, m.omega * (time - m.start), m.omega);
}

} // namespace

RigidState rigid_state(const scene::Motion& m, double time) {
    RigidState state;
    state.pivot = m.centre;
    switch (m.kind) {
    case scene::MotionKind::fixed:
        break;
    case scene::MotionKind::linear:
        state.shift = (time - m.start) * m.velocity;
        state.shift_velocity = m.velocity;
        break;
    case scene::MotionKind::oscillate:
        oscillate(state, m, time);
        break;
    case scene::MotionKind::rotate:
        turn(state, unit_axis(m), m.omega * (time - m.start), m.omega);
        break;
    case scene::MotionKind::planetary:
        planetary(state, m, time);
        break;
    }
    return state;
}

double largest_speed(const scene::Motion& m, double reach) {
    switch (m.kind) {
    case scene::MotionKind::fixed:
        return 0;
    case scene::MotionKind::linear:
        return norm(m.velocity);
    case scene::MotionKind::oscillate:
        return std::abs(m.omega) * norm(m.amplitude);
    case scene::MotionKind::rotate:
        return std::abs(m.omega) * reach;
    case scene::MotionKind::planetary:
        return std::abs(m.orbit_omega) * m.orbit_radius + std::abs(m.omega) * reach;
    }
    return 0;
}

} // namespace sandlane::motion
