// Contacts that begin or end inside a time step (docs/physics.md 7): normal laws with the force whose product
// with the step is the impulse of the part of the step that the grains touched. Formulas only, as in
// normal.hpp. The moments of touch and release follow from the overlap and its rate, nothing is remembered.
#pragma once

#include "core/vector.hpp"
#include "laws/normal.hpp"

namespace sandlane::laws {

// force: what acts on the grains over the step [N]; load: the present one, >= 0; pressed: the load over the
// step; jump, ramp: what a force that is there from the touch on, or to the release, and one that grows as
// time does count over the step, in units of the present.
template <class R> struct StepForce { R force, load, pressed, jump, ramp; };

// s: time from the touch or to the release over the step.
template <class R>
SANDLANE_INLINE StepForce<R> step_force(const R& force, const R& load, const R& pressed, const R& s) {
    const R half(0.5), one(1.0);
    return {force, load, pressed, select(s < one, half + s, one), select(s < one, half + half * s, one)};
}

// Friction over the step from the present one, which is a damper's force and a spring's or sliding.
template <class R>
SANDLANE_INLINE R friction_of_step(const StepForce<R>& n, const R& force, const R& damper,
                                   const R& friction) {
    const R limit = friction * n.pressed;
    return max(min(n.ramp * force + (n.ramp - n.jump) * damper, limit), -limit);
}
template <class R>
SANDLANE_INLINE Vector<R> friction_of_step(const StepForce<R>& n, const Vector<R>& force,
                                           const Vector<R>& damper, const R& friction) {
    const Vector<R> whole = n.ramp * force + (n.ramp - n.jump) * damper;
    // Zero over zero is no number, and min then takes its second operand.
    return min(friction * n.pressed / sqrt(dot(whole, whole)), R(1.0)) * whole;
}

template <class Law> struct Resolved;
template <class Law> inline constexpr bool resolves = false;
template <class Law> inline constexpr bool resolves<Resolved<Law>> = true;
template <class Law> inline constexpr bool can_resolve = requires {
    Resolved<Law>::needs_radius;
};

// Time since the touch of grains that did not touch a step ago, else 0 [s].
template <class R> SANDLANE_INLINE R since_touch(const R& overlap, const R& rate, const R& step) {
    return select(overlap < rate * step, overlap / rate, R(0.0));
}

// With s, the time from the touch or to the release over the step: the spring's force grows as time does, the
// damper's is there at once. Their impulses from the touch to half a step behind the present make
// k xi (1 + s)/2 + gamma xi' (1/2 + s) of the force. A force that is cut ends as a spring's does, at the
// force zero.
template <> struct Resolved<LinearDashpot> {
    static constexpr bool needs_radius = LinearDashpot::needs_radius;
    static constexpr int memory = LinearDashpot::memory;

    template <class R> static SANDLANE_INLINE StepForce<R> force(const NormalInput<R>& c, const R& step) {
        const R zero(0.0), half(0.5), one(1.0);
        const R damper = c.dissipative * c.rate, whole = c.elastic * c.overlap + damper;
        const R swing = c.elastic * (step * max(c.rate, -c.rate)); // of the spring's force within a step
        const R per_swing = one / swing;
        const R load = max(whole, zero), begins = max(damper, zero), s = (load - begins) * per_swing;
        const R pressed = select(s < one, half * (load + s * (load + begins)), load);

        const R jump = max(damper, c.least), r = (whole - jump) * per_swing;
        const R late = parting(min(jump, zero), r);
        const R part = select(r < one, half * (whole + r * (whole + jump)) - late, whole + late);
        return step_force(select(whole > c.least, part, max(whole, c.least)), load, pressed, s);
    }

private:
    // A pull slows grains down as they part, so that a release expected at the end of this step may come
    // early in the next. Within a fifth of a step the two share the jump: what the first leaves, the second
    // takes, and a wrong guess costs little.
    template <class R> static SANDLANE_INLINE R parting(const R& pull, const R& r) {
        const R one(1.0), since = select(r < one, r, min(r, R(2.0)) - one);
        return max(one - R(5.0) * since, R(0.0)) * (R(0.5) + since) * pull;
    }
};

// The same for forces that grow as the power 1/2 and 3/2 of the time since the touch. Sums over steps then
// differ from integrals by Hurwitz's zeta function, not by what the first step alone misses:
// -zeta(-1/2, 1 + s), -zeta(-3/2, 1 + s) as polynomials, error below 3e-5. A force that is cut ends as a
// ramp, steeper where it is cut at a larger overlap; without loss, as it began.
template <> struct Resolved<Viscoelastic> {
    static constexpr bool needs_radius = Viscoelastic::needs_radius;
    static constexpr int memory = Viscoelastic::memory;

    template <class R> static SANDLANE_INLINE StepForce<R> force(const NormalInput<R>& c, const R& step) {
        const R zero(0.0), one(1.0);
        const R root = sqrt(c.overlap * c.reduced_radius), damper = c.dissipative * c.rate;
        const R inner = c.overlap + damper, whole = c.elastic * root * inner, load = max(whole, zero);
        const R stride = step * max(c.rate, -c.rate), reach = sqrt(stride * c.reduced_radius);
        const R per_stride = one / stride, s = c.overlap * per_stride, u = inner * per_stride;

        const R edge = select(
            s < one, c.elastic * reach * (damper * power_half(s) + stride * power_three_halves(s)), whole);
        const R within = min(s, one), early = max(one - (s - u), zero);
        const R as_begun = reach * power_three_halves(within) - min(root, reach) * ramp(within);
        const R end = c.elastic * stride * (root * ramp(u) + early * early * as_begun);
        const R cut_force = select(c.rate > zero, edge, select(u < one, end, whole));
        const R pressed = select(whole > zero, max(cut_force, zero), zero);
        return step_force(select(c.least < zero, edge, pressed), load, pressed,
                          select(c.rate > zero, s, max(u, zero)));
    }

private:
    template <class R> static SANDLANE_INLINE R power_half(const R& s) {
        return R(0.20786215) +
               s * (R(0.73097509) + s * (R(0.32032677) + s * (R(-0.06413508) + s * R(0.01287584))));
    }
    template <class R> static SANDLANE_INLINE R power_three_halves(const R& s) {
        return R(0.02550116) +
               s * (R(0.31131006) + s * (R(0.55157066) + s * (R(0.15137779) + s * R(-0.01428764))));
    }
    // -zeta(-1, 1 + s), of a force that grows with time.
    template <class R> static SANDLANE_INLINE R ramp(const R& s) {
        return R(0.5) * s * (s + R(1.0)) + R(1.0 / 12.0);
    }
};

} // namespace sandlane::laws
