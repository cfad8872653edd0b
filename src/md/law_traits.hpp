// What a normal law means beyond its formula: how coefficients of two materials mix (docs/physics.md 5) and
// what a contact does at a given impact speed (2.1-2.3). One specialisation per NORMAL line of laws.def.
#pragma once

#include "laws/contact.hpp"
#include "laws/restitution.hpp"
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
};

using Coefficients = laws::PairCoefficients<double>;

inline double harmonic(double a, double b) {
    return a + b > 0 ? 2 * a * b / (a + b) : 0.0;
}

// Restitution coefficient of a head-on collision of reduced mass m, by its equation of motion: steps of a
// thousandth of `time` with the midpoint rule, until the overlap is gone. Two grains that stick: 0.
template <class Law>
double collide(const Coefficients& c, double mass, double radius, double speed, double time) {
    double overlap = 0, rate = speed, memory[Law::memory + 1] = {};
    const double dt = time / 1000;
    const auto acceleration = [&](double xi, double v) {
        const double positive = xi > 0 ? xi : 0.0;
        return -laws::normal_force<Law>(positive, v, c, radius, memory).force / mass;
    };
    for (int step = 0; step < 20000; ++step) {
        const double half = rate + 0.5 * dt * acceleration(overlap, rate);
        const double middle = overlap + 0.5 * dt * rate;
        overlap += dt * half;
        rate += dt * acceleration(middle, half);
        if (overlap <= 0) return -rate / speed;
    }
    return 0;
}

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
        return {frequency, ratio, time, restitution, speed / frequency};
    }
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
        return {frequency, a * k * std::sqrt(overlap) / (2 * mass * frequency), time, restitution, overlap};
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
        return {unloading, 0, 0.5 * std::numbers::pi * (1 / loading + 1 / unloading),
                std::sqrt(c.elastic / c.dissipative), speed / loading};
    }
};

template <> struct LawTraits<laws::CohesiveViscoelastic> : LawTraits<laws::Viscoelastic> {
    static ContactScale scale(const Coefficients& c, double mass, double radius, double speed) {
        ContactScale scale = LawTraits<laws::Viscoelastic>::scale(c, mass, radius, speed);
        scale.restitution = collide<laws::CohesiveViscoelastic>(c, mass, radius, speed, scale.collision_time);
        return scale;
    }
};

} // namespace sandlane::md
