// Prescribed motions in space: rotations about any axis, and velocities as derivatives of positions.
#include "motion/prescribed.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using namespace sandlane;
using motion::rigid_state;
using motion::RigidState;

namespace {

void expect_near(Vec a, Vec b, double tolerance) {
    EXPECT_NEAR(a.x, b.x, tolerance);
    EXPECT_NEAR(a.y, b.y, tolerance);
    EXPECT_NEAR(a.z, b.z, tolerance);
}

scene::Motion motion_of(scene::MotionKind kind) {
    scene::Motion m;
    m.kind = kind;
    m.velocity = {1, -2, 3};
    m.amplitude = {0.1, 0.2, -0.3};
    m.omega = 1.3;
    m.phase = 0.4;
    m.centre = {0.5, 0.6, 0.7};
    m.axis = {2, -1, 2};
    m.orbit_radius = 0.2;
    m.orbit_omega = 0.8;
    m.start = 0.1;
    return m;
}

} // namespace

TEST(PrescribedMotion, AThirdOfATurnAboutTheDiagonalPermutesTheAxes) {
    scene::Motion m = motion_of(scene::MotionKind::rotate);
    m.axis = {1, 1, 1};
    m.start = 0;
    m.omega = 2 * std::numbers::pi / 3;
    const RigidState state = rigid_state(m, 1);
    expect_near(state.position_of(m.centre + Vec{1, 2, 3}), m.centre + Vec{3, 1, 2}, 1e-15 * 10);
    expect_near(state.rotate({1, 0, 0}), {0, 1, 0}, 1e-15);
}

TEST(PrescribedMotion, PositionsAndBack) {
    for (const auto kind : {scene::MotionKind::linear, scene::MotionKind::oscillate,
                            scene::MotionKind::rotate, scene::MotionKind::planetary}) {
        const RigidState state = rigid_state(motion_of(kind), 1.9);
        const Vec p{0.3, -0.8, 1.1}, q{-0.2, 0.4, 0.9};
        expect_near(state.reference_of(state.position_of(p)), p, 1e-14);
        EXPECT_NEAR(norm(state.position_of(p) - state.position_of(q)), norm(p - q), 1e-14);
    }
}

TEST(PrescribedMotion, VelocityIsTheDerivative) {
    for (const auto kind : {scene::MotionKind::linear, scene::MotionKind::oscillate,
                            scene::MotionKind::rotate, scene::MotionKind::planetary}) {
        const scene::Motion m = motion_of(kind);
        const Vec p{0.3, -0.8, 1.1};
        const double t = 1.9, h = 1e-4;
        const RigidState now = rigid_state(m, t);
        const Vec slope =
            (0.5 / h) * (rigid_state(m, t + h).position_of(p) - rigid_state(m, t - h).position_of(p));
        // h^2/6 times the third derivative, of order one; rounding 1e-16/h.
        expect_near(now.velocity_at(now.position_of(p)), slope, 1e-8);
        EXPECT_LE(norm(slope), motion::largest_speed(m, norm(p - m.centre)) + 1e-8);
    }
}

// Displacement amplitude * wave(omega (t - start) + phase), and its velocity, at two known arguments.
TEST(PrescribedMotion, OscillationsBeginAtTheirReferenceTime) {
    scene::Motion m = motion_of(scene::MotionKind::oscillate);
    const double quarter = 0.5 * std::numbers::pi / m.omega;
    m.phase = 0;
    for (const auto wave : {scene::Wave::sine, scene::Wave::cosine}) {
        m.wave = wave;
        const bool sine = wave == scene::Wave::sine;
        const RigidState first = rigid_state(m, m.start), later = rigid_state(m, m.start + quarter);
        expect_near(first.shift, (sine ? 0.0 : 1.0) * m.amplitude, 1e-15);
        expect_near(first.shift_velocity, (sine ? m.omega : 0.0) * m.amplitude, 1e-15);
        expect_near(later.shift, (sine ? 1.0 : 0.0) * m.amplitude, 1e-15);
        expect_near(later.shift_velocity, (sine ? 0.0 : -m.omega) * m.amplitude, 1e-15);
    }
}

TEST(PrescribedMotion, AnOrbitLiesAcrossItsAxis) {
    const scene::Motion m = motion_of(scene::MotionKind::planetary);
    for (const double t : {0.3, 1.0, 2.7}) {
        const RigidState state = rigid_state(m, t);
        EXPECT_NEAR(norm(state.shift), m.orbit_radius, 1e-15);
        EXPECT_NEAR(dot(state.shift, m.axis), 0, 1e-15);
        // It runs in the sense of its axis.
        EXPECT_NEAR(dot(cross(state.shift, state.shift_velocity), m.axis) / norm(m.axis),
                    m.orbit_radius * m.orbit_radius * m.orbit_omega, 1e-15);
    }
}
