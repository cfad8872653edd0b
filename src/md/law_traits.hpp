// What a normal law means beyond its formula: how coefficients of two materials mix (docs/physics.md 5) and
// what a contact does at a given impact speed (2.1-2.3). One specialisation per NORMAL line of laws.def.
#pragma once

#include "laws/normal.hpp"
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

template <class Law> struct LawTraits;

template <> struct LawTraits<laws::LinearDashpot> {
    static double elastic(const scene::Material& a, const scene::Material& b) {
        return 2 * a.stiffness * b.stiffness / (a.stiffness + b.stiffness);
    }
    static double dissipative(const scene::Material& a, const scene::Material& b) {
        return 0.5 * (a.damping + b.damping);
    }
    // Overrides of one pair of materials; negative: keep the rule.
    static double elastic(const scene::MaterialPair& pair) { return pair.stiffness; }
    static double dissipative(const scene::MaterialPair& pair) { return pair.damping; }

    // Contact of reduced mass m [kg] and reduced radius [m] at normal impact speed g [m/s].
    static ContactScale scale(double k, double gamma, double mass, double, double speed) {
        const double frequency = std::sqrt(k / mass), ratio = gamma / (2 * std::sqrt(k * mass));
        return {frequency, ratio, std::numbers::pi / frequency, laws::linear_dashpot_restitution(ratio),
                speed / frequency};
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

    static ContactScale scale(double elastic, double a, double mass, double radius, double speed) {
        const double k = elastic * std::sqrt(radius);
        const double overlap = std::pow(5 * mass * speed * speed / (4 * k), 0.4);
        const double frequency = std::sqrt(1.5 * k * std::sqrt(overlap) / mass);
        const double x = a * std::pow(k / mass, 0.4) * std::pow(speed, 0.2);
        return {frequency, a * k * std::sqrt(overlap) / (2 * mass * frequency),
                3.2180654597 * std::pow(mass / k, 0.4) * std::pow(speed, -0.2),
                laws::viscoelastic_restitution(x), overlap};
    }
};

} // namespace sandlane::md
