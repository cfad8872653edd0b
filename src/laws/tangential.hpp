// Tangential contact forces (docs/physics.md 4). Formulas only, templates on R; in the plane along one
// tangent, in space as vectors.
#pragma once

#include "core/vector.hpp"
#include "laws/cube_root.hpp"

namespace sandlane::laws {

// Load f_n >= 0 [N] that presses the surfaces together, rate v_t of the surfaces along t [m/s], coefficients
// of the pair of materials, time since the last evaluation [s].
template <class R> struct TangentialInput {
    R normal_force, rate;
    R damping, friction, stiffness; // gamma_t [kg/s], mu, k_t [N/m]
    R elapsed;
};
// The same in space: velocity u_t of i's surface relative to j's [m/s], unit normal from i to j, mean spin of
// both grains about it [rad/s].
template <class R> struct SpatialInput {
    R normal_force;
    Vector<R> velocity, normal;
    R twist;
    R damping, friction, stiffness;
    R elapsed;
};

// A law returns f_t on grain i along t, or as a vector [N]. `memory` numbers per contact (`memory_in_space`
// in 3D) live as long as the contact does; both partners see the same numbers in 2D and opposite ones in 3D.
// At its first evaluation they are zero, and so is the time elapsed. Laws without memory do not look at them.
// energy, energy_in_space: what the contact holds and can give back, J, from k_t, mu and its memory.
// in_space: the law has a form in 3D. damped: its force has the part -gamma_t v_t while it does not slide.
struct Frictionless {
    static constexpr bool needs_spin = false, needs_twist = false, damped = false, in_space = true;
    static constexpr int memory = 0, memory_in_space = 0;
    template <class R> static SANDLANE_INLINE R force(const TangentialInput<R>&, R*) { return R(0.0); }
    template <class R> static SANDLANE_INLINE Vector<R> force(const SpatialInput<R>&, R*) {
        return {R(0.0), R(0.0), R(0.0)};
    }
    static double energy(double, double, const double*) { return 0; }
    static double energy_in_space(double, double, const double*) { return 0; }
};

// f_t = -sign(v_t) min(gamma_t |v_t|, mu f_n) (2.18), written as a clamp so that v_t = 0 gives zero.
struct HaffWerner {
    static constexpr bool needs_spin = true, needs_twist = false, damped = true, in_space = true;
    static constexpr int memory = 0, memory_in_space = 0;
    template <class R> static SANDLANE_INLINE R force(const TangentialInput<R>& c, R*) {
        const R limit = c.friction * c.normal_force;
        return max(min(-(c.damping * c.rate), limit), -limit);
    }
    // -u_t min(gamma_t, mu f_n/|u_t|). Zero over zero is no number, and min then takes its second operand.
    template <class R> static SANDLANE_INLINE Vector<R> force(const SpatialInput<R>& c, R*) {
        const R speed = sqrt(dot(c.velocity, c.velocity));
        return -min(c.friction * c.normal_force / speed, c.damping) * c.velocity;
    }
    static double energy(double, double, const double*) { return 0; }
    static double energy_in_space(double, double, const double*) { return 0; }
};

// A spring zeta in the tangential direction, held by Coulomb friction (2.20)-(2.21):
// f_t = -k_t zeta - gamma_t v_t, at most mu f_n; while the contact slides zeta is what gives just that force,
// so that it lets go at once when the motion reverses. memory: zeta [m].
struct CundallStrack {
    static constexpr bool needs_spin = true, needs_twist = true, damped = true, in_space = true;
    static constexpr int memory = 1, memory_in_space = 3;
    template <class R> static SANDLANE_INLINE R force(const TangentialInput<R>& c, R* zeta) {
        const R zero(0.0);
        const R spring = zeta[0] + c.elapsed * c.rate;
        const R drag = c.damping * c.rate;
        const R trial = -(c.stiffness * spring) - drag;
        const R limit = c.friction * c.normal_force;
        const R force = max(min(trial, limit), -limit);
        const R pulled = -(force + drag) / c.stiffness;
        const R held = select(trial > limit, pulled, select(-limit > trial, pulled, spring));
        zeta[0] = select(c.normal_force > zero, held, zero);
        return force;
    }
    template <class R> static SANDLANE_INLINE Vector<R> force(const SpatialInput<R>& c, R* zeta) {
        const R zero(0.0), one(1.0);
        const Vector<R> none{zero, zero, zero};
        const Vector<R> spring = carried(c, {zeta[0], zeta[1], zeta[2]}) + c.elapsed * c.velocity;
        const Vector<R> drag = c.damping * c.velocity;
        const Vector<R> trial = -c.stiffness * spring - drag;
        const R limit = c.friction * c.normal_force;
        const R square = dot(trial, trial);
        const auto slides = square > limit * limit;
        Vector<R> force = trial, held = spring;
        if (any(slides)) {
            force = select(slides, limit / sqrt(square), one) * trial;
            held = select(slides, -(one / c.stiffness) * (force + drag), spring);
        }
        held = select(c.normal_force > zero, held, none);
        zeta[0] = held.x;
        zeta[1] = held.y;
        zeta[2] = held.z;
        return force;
    }
    // k_t zeta^2/2.
    static double energy(double stiffness, double, const double* zeta) {
        return 0.5 * stiffness * zeta[0] * zeta[0];
    }
    static double energy_in_space(double stiffness, double, const double* zeta) {
        return 0.5 * stiffness * (zeta[0] * zeta[0] + zeta[1] * zeta[1] + zeta[2] * zeta[2]);
    }

private:
    // The spring moves along with its contact: turned into the tangential plane and about the normal by the
    // mean twist of the grains, at its old length, |old|/|turned| = (1 - e)^(-1/2) with e = 1 -
    // turned^2/old^2. In a time step e is so small that its series is exact to rounding, and has no root to
    // wait for.
    template <class R>
    static SANDLANE_INLINE Vector<R> carried(const SpatialInput<R>& c, const Vector<R>& old) {
        const R one(1.0), before = dot(old, old), inverse = one / before;
        const Vector<R> flat = old - dot(c.normal, old) * c.normal;
        const Vector<R> turned = flat + (c.elapsed * c.twist) * cross(c.normal, flat);
        const R after = dot(turned, turned), e = (before - after) * inverse;
        R stretch = one + e * (R(0.5) + R(0.375) * e);
        const auto far = max(e, -e) > R(1e-5);
        if (any(far)) stretch = select(far, sqrt(before / after), stretch);
        return select(after > R(1e-300), stretch, R(0.0)) * turned;
    }
};

// A tangential stiffness that falls from k_0 to zero at Coulomb's limit and starts anew at every reversal
// (2.22)-(2.23), with the exponent 1/3. stiffness = k_0 [N/m]. memory: F, F* [N], sign of the last
// displacement, load at the last evaluation [N]. In the plane only.
struct WaltonBraunTangential {
    static constexpr bool needs_spin = true, needs_twist = false, damped = false, in_space = false;
    static constexpr int memory = 4, memory_in_space = 0;
    template <class R> static SANDLANE_INLINE R force(const TangentialInput<R>& c, R* m) {
        const R zero(0.0), one(1.0), limit = c.friction * c.normal_force;
        const R scaled = select(m[3] > zero, m[1] * (c.normal_force / m[3]), zero);
        const R f = max(min(m[0], limit), -limit), last = max(min(scaled, limit), -limit);
        const R shift = c.elapsed * c.rate;
        const R turn = select(zero > shift * m[2], f, last);
        const auto grows = shift > zero;
        const R room = select(grows, limit - f, limit + f), whole = select(grows, limit - turn, limit + turn);
        const R part = max(min(room / whole, one), zero);
        const R stiffness = select(whole > R(1e-12) * limit, c.stiffness * cube_root(part), zero);
        m[0] = max(min(f + stiffness * shift, limit), -limit);
        m[1] = turn;
        m[2] = select(grows, one, select(zero > shift, -one, m[2]));
        m[3] = c.normal_force;
        return -m[0];
    }
    // What unloading gives back at the present load L = mu f_n: the integral of F dF/k_t from F to zero. On
    // the way to zero k_t counts from F*, else a reversal makes F the turning point.
    static double energy(double stiffness, double friction, const double* m) {
        const double limit = friction * m[3], size = m[0] < 0 ? -m[0] : m[0];
        const double whole = limit + size, turn = limit + (m[0] < 0 ? -m[1] : m[1]);
        if (!(size > 0)) return 0;
        const double root = cube_root(limit / whole);
        const double fresh = 0.6 * whole * whole - 1.5 * limit * whole + 0.9 * limit * whole * root * root;
        const bool unloads = m[0] * m[2] < 0 && turn > whole;
        return (unloads ? fresh / cube_root(whole / turn) : fresh) / stiffness;
    }
};

} // namespace sandlane::laws
