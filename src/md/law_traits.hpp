// What a normal law means beyond its formula: how coefficients of two materials mix (docs/physics.md 5) and
// what a contact does at a given impact speed (2.1-2.3). One specialisation per NORMAL line of laws.def.
#pragma once

#include "laws/contact.hpp"
#include "laws/restitution.hpp"
#include "md/law_choice.hpp"
#include "scene/scene.hpp"

#include <cmath>
#include <numbers>

namespace sandlane::md {

struct ContactScale {
    double frequency = 0;      // rad/s, of the contact at its largest overlap
    double damping_ratio = 0;  // of critical
    double collision_time = 0; // s
    double restitution = 1;
    double overlap = 0; // m, largest
    double half_swing =
        0; // s: steps resolve this; most laws' collision time, pi/frequency if that is shorter
};

using Coefficients = laws::PairCoefficients<double>;

inline double harmonic(double a, double b) {
    return a + b > 0 ? 2 * a * b / (a + b) : 0.0;
}

// Restitution coefficient of a head-on collision of reduced mass m, by its equation of motion: steps of a
// thousandth of `time` with the midpoint rule, until the overlap is gone, at an instant within a step. Two
// grains that stick: 0. For laws without memory.
template <class Law>
double collide(const Coefficients& c, double mass, double radius, double speed, double time) {
    static_assert(Law::memory == 0);
    double overlap = 0, rate = speed, memory[1] = {};
    const double dt = time / 1000;
    const auto acceleration = [&](double xi, double v) {
        const double positive = xi > 0 ? xi : 0.0;
        return -laws::normal_force<Law>(positive, v, c, radius, memory).force / mass;
    };
    for (int step = 0; step < 20000; ++step) {
        const double half = rate + 0.5 * dt * acceleration(overlap, rate);
        const double middle = overlap + 0.5 * dt * rate;
        const double old_overlap = overlap, old_rate = rate;
        overlap += dt * half;
        rate += dt * acceleration(middle, half);
        if (overlap <= 0)
            return -(old_rate + (rate - old_rate) * old_overlap / (old_overlap - overlap)) / speed;
    }
    return 0;
}

// stiffness, damping: slopes of the force of a contact over its overlap [N/m] and over the rate of that
// [kg/s], the largest that it may have there.
template <class Law> struct LawTraits;

template <> struct LawTraits<laws::LinearDashpot> {
    static double elastic(const scene::Material& a, const scene::Material& b) {
        return harmonic(a.stiffness, b.stiffness);
    }
    static double dissipative(const scene::Material& a, const scene::Material& b) {
        return 0.5 * (a.damping + b.damping);
    }
    // Overrides of one pair of materials; negative: keep the rule.
    static double elastic(const scene::MaterialPair& pair) { return pair.stiffness; }
    static double dissipative(const scene::MaterialPair& pair) { return pair.damping; }

    // Contact of reduced mass m [kg] and reduced radius [m] at normal impact speed g [m/s].
    static ContactScale scale(const Coefficients& c, double mass, double radius, double speed) {
        const double frequency = std::sqrt(c.elastic / mass);
        const double ratio = c.dissipative / (2 * std::sqrt(c.elastic * mass)),
                     time = std::numbers::pi / frequency;
        const double restitution = c.least == 0 ? laws::linear_dashpot_restitution(ratio)
                                                : collide<laws::LinearDashpot>(c, mass, radius, speed, time);
        return {frequency, ratio, time, restitution, speed / frequency, time};
    }
    static double stiffness(const Coefficients& c, double, double) { return c.elastic; }
    static double damping(const Coefficients& c, double, double) { return c.dissipative; }
};

template <> struct LawTraits<laws::Viscoelastic> {
    static double elastic(const scene::Material& a, const scene::Material& b) {
        const auto compliance = [](const scene::Material& m) {
            return (1 - m.poisson * m.poisson) / m.young;
        };
        return (4.0 / 3.0) / (compliance(a) + compliance(b));
    }
    static double dissipative(const scene::Material& a, const scene::Material& b) {
        return 0.5 * (a.dissipation + b.dissipation);
    }
    static double elastic(const scene::MaterialPair& pair) { return (2.0 / 3.0) * pair.young; }
    static double dissipative(const scene::MaterialPair& pair) { return pair.dissipation; }

    static ContactScale scale(const Coefficients& c, double mass, double radius, double speed) {
        const double k = c.elastic * std::sqrt(radius), a = c.dissipative;
        const double overlap = std::pow(5 * mass * speed * speed / (4 * k), 0.4);
        const double frequency = std::sqrt(1.5 * k * std::sqrt(overlap) / mass);
        const double x = a * std::pow(k / mass, 0.4) * std::pow(speed, 0.2);
        const double time = 3.2180654597 * std::pow(mass / k, 0.4) * std::pow(speed, -0.2);
        const double restitution = c.least == 0 ? laws::viscoelastic_restitution(x)
                                                : collide<laws::Viscoelastic>(c, mass, radius, speed, time);
        const double ratio = a * k * std::sqrt(overlap) / (2 * mass * frequency);
        return {frequency, ratio, time, restitution, overlap, time};
    }
    static double stiffness(const Coefficients& c, double radius, double overlap) {
        return 1.5 * c.elastic * std::sqrt(radius * overlap);
    }
    static double damping(const Coefficients& c, double radius, double overlap) {
        return c.dissipative * c.elastic * std::sqrt(radius * overlap);
    }
};

template <> struct LawTraits<laws::WaltonBraun> {
    static double elastic(const scene::Material& a, const scene::Material& b) {
        return harmonic(a.stiffness, b.stiffness);
    }
    static double dissipative(const scene::Material& a, const scene::Material& b) {
        return harmonic(a.unloading_stiffness, b.unloading_stiffness);
    }
    static double elastic(const scene::MaterialPair& pair) { return pair.stiffness; }
    static double dissipative(const scene::MaterialPair& pair) { return pair.unloading_stiffness; }

    // Unloading is the faster half of the collision (2.4).
    static ContactScale scale(const Coefficients& c, double mass, double, double speed) {
        const double loading = std::sqrt(c.elastic / mass), unloading = std::sqrt(c.dissipative / mass);
        ContactScale s;
        s.frequency = unloading;
        s.collision_time = 0.5 * std::numbers::pi * (1 / loading + 1 / unloading);
        s.restitution = std::sqrt(c.elastic / c.dissipative);
        s.overlap = speed / loading;
        s.half_swing = std::numbers::pi / unloading;
        return s;
    }
    static double stiffness(const Coefficients& c, double, double) { return c.dissipative; }
    static double damping(const Coefficients&, double, double) { return 0; }
};

// The pull draws grains deeper together, where the contact is stiffer.
template <> struct LawTraits<laws::CohesiveViscoelastic> : LawTraits<laws::Viscoelastic> {
    static ContactScale scale(const Coefficients& c, double mass, double radius, double speed) {
        ContactScale s = LawTraits<laws::Viscoelastic>::scale(c, mass, radius, speed);
        const double stiffer = std::pow(largest_overlap(c, mass, radius, speed) / s.overlap, 0.25);
        s.frequency *= stiffer;
        s.collision_time /= stiffer;
        s.half_swing /= stiffer;
        s.damping_ratio *= stiffer;
        s.overlap *= std::pow(stiffer, 4);
        s.restitution = collide<laws::CohesiveViscoelastic>(c, mass, radius, speed, s.collision_time);
        return s;
    }

private:
    // Without loss: m g^2/2 = (2/5) K xi^{5/2} - 2 pi c R_eff xi^2. As a fixed point it attracts: the slope
    // is below 0.8.
    static double largest_overlap(const Coefficients& c, double mass, double radius, double speed) {
        const double k = c.elastic * std::sqrt(radius);
        double overlap = 0;
        for (int n = 0; n < 100; ++n) {
            const double energy =
                0.5 * mass * speed * speed + 2 * std::numbers::pi * c.cohesion * radius * overlap * overlap;
            overlap = std::pow(2.5 * energy / k, 0.4);
        }
        return overlap;
    }
};

// Calls body(traits) with the traits of the scene's normal law.
template <class Body> auto with_traits(const scene::Scene& scene, const Body& body) {
    return with_normal_law(static_cast<int>(scene.md.normal),
                           [&]<class Law>(Type<Law>) { return body(LawTraits<Law>{}); });
}

} // namespace sandlane::md
