#include "motion/prescribed.hpp"

#include <cmath>

namespace sandlane::motion {

namespace {

void turn(RigidState& state, double angle, double omega) {
    state.angle = angle;
    state.omega = omega;
    state.cosine = std::cos(angle);
    state.sine = std::sin(angle);
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
// drum centred at m.centre, so the shift is the orbit itself (type 4).
void planetary(RigidState& state, const scene::Motion& m, double time) {
    const double argument = m.orbit_omega * (time - m.start) + m.phase;
    state.shift = m.orbit_radius * Vec{std::cos(argument), std::sin(argument), 0};
    state.shift_velocity = (m.orbit_radius * m.orbit_omega) * Vec{-std::sin(argument), std::cos(argument), 0};
    turn(state, m.omega * (time - m.start), m.omega);
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
        turn(state, m.omega * (time - m.start), m.omega);
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
