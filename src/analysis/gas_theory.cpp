#include "analysis/gas_theory.hpp"

#include <cmath>
#include <limits>
#include <numbers>

namespace sandlane::analysis {

namespace {

using laws::Restitution;

// Mean of 1 - eps^2 over the energies of impacts: int 2 x^3 exp(-x^2) (1 - eps^2(2 x sqrt(T/m))) dx.
double loss(const Restitution& law, double variance) {
    if (law.model == Restitution::Model::constant) return 1 - law.eps * law.eps;
    constexpr int parts = 200; // Simpson, of an integrand that vanishes at both ends
    constexpr double end = 7;
    double sum = 0;
    for (int n = 1; n < parts; ++n) {
        const double x = end * n / parts;
        const double eps = laws::restitution(law, 2 * x * std::sqrt(variance));
        sum += (n % 2 == 1 ? 4 : 2) * 2 * x * x * x * std::exp(-x * x) * (1 - eps * eps);
    }
    return sum * end / parts / 3;
}

class Cooling {
public:
    explicit Cooling(const HardGas& gas) : gas_(gas), rate_(collision_rate(gas, gas.mass)) {
        if (gas.restitution.model != Restitution::Model::constant) return;
        sonine_ = 1 + 3.0 / 16 * cooling_a2(gas.dimension, gas.restitution.eps);
    }
    // d ln T/dt.
    [[nodiscard]] double rate(double temperature) const {
        return heating(temperature) - cooling(temperature);
    }
    // How fast T comes to a steady state, at most about.
    [[nodiscard]] double relaxation(double temperature) const {
        return heating(temperature) + cooling(temperature);
    }
    // ln T after dt.
    [[nodiscard]] double advance(double log, double dt) const { // Runge and Kutta
        const auto f = [&](double l) { return rate(std::exp(l)); };
        const double a = f(log), b = f(log + 0.5 * dt * a), c = f(log + 0.5 * dt * b), d = f(log + dt * c);
        return log + dt / 6 * (a + 2 * b + 2 * c + d);
    }

private:
    [[nodiscard]] double heating(double temperature) const { return gas_.kicks / (temperature / gas_.mass); }
    [[nodiscard]] double cooling(double temperature) const {
        const double variance = temperature / gas_.mass;
        return rate_ * std::sqrt(variance) / gas_.dimension * loss(gas_.restitution, variance) * sonine_;
    }

    const HardGas& gas_;
    double rate_; // of collisions at T = m
    double sonine_ = 1;
};

// Calls look(t, T) along the curve up to `end`.
template <class Look> void follow(const Cooling& cooling, double temperature, double end, const Look& look) {
    double t = 0, log = std::log(temperature);
    while (t < end) {
        const double now = std::exp(log), rate = std::abs(cooling.rate(now));
        // A small part of the time in which T changes, which grows with t; near a steady state of that in
        // which it would return.
        double dt = rate > 0 ? std::min(0.05 / rate, 0.1 / cooling.relaxation(now)) : end;
        if (dt > end - t) dt = end - t;
        log = cooling.advance(log, dt);
        t = t + dt >= end ? end : t + dt;
        look(t, dt, std::exp(log));
    }
}

} // namespace

double cooling_a2(int dimension, double eps) {
    const double d = dimension, e = eps;
    return 16 * (1 - e) * (1 - 2 * e * e) / (25 + 24 * d - 57 * e + 8 * d * e - 2 * e * e * (1 - e));
}

double collision_rate(const HardGas& gas, double temperature) {
    const double variance = temperature / gas.mass, s = gas.diameter, pi = std::numbers::pi;
    const double relative = gas.dimension == 3 ? 4 * std::sqrt(variance / pi) : std::sqrt(pi * variance);
    return gas.density * gas.correlation * (gas.dimension == 3 ? pi * s * s : 2 * s) * relative;
}

CriticalLengths critical_lengths(int dimension, double eps, double density, double diameter) {
    constexpr double infinity = std::numeric_limits<double>::infinity(), pi = std::numbers::pi;
    if (!(eps < 1)) return {infinity, infinity};
    const double d = dimension;
    // Cooling rate and transport coefficients over those of the elastic gas.
    const double zeta = (d + 2) / (4 * d) * (1 - eps * eps);
    const double n1 = (3 - 3 * eps + 2 * d) * (1 + eps) / (4 * d);
    const double n2 = (1 + eps) / (d - 1) * ((d - 1) / 2 + 3 * (d + 8) * (1 - eps) / 16);
    const double eta = 1 / (n1 - zeta / 2), kappa = 1 / (n2 - 2 * d / (d - 1) * zeta);
    const double mu = 2 * zeta * kappa / (2 * (d - 1) / d * n2 - 3 * zeta);
    const double c = dimension == 3 ? 5 / (16 * std::sqrt(pi)) : 1 / (2 * std::sqrt(pi));
    const double k = density * std::pow(diameter, d - 1) / (2 * c);
    return {2 * pi / (k * std::sqrt(2 * zeta / eta)),
            !(kappa > mu) ? infinity
                          : 2 * pi / (k * std::sqrt(2 * (d - 1) * zeta / ((d + 2) * (kappa - mu))))};
}

std::vector<double> cooling_curve(const HardGas& gas, double temperature, const std::vector<double>& times) {
    std::vector<double> curve;
    const Cooling cooling(gas);
    double now = 0, value = temperature;
    for (const double time : times) {
        follow(cooling, value, time - now, [&](double, double, double t) { value = t; });
        now = time;
        curve.push_back(value);
    }
    return curve;
}

double collision_clock(const HardGas& gas, double temperature, double end) {
    const Cooling cooling(gas);
    double clock = 0, before = temperature;
    follow(cooling, temperature, end, [&](double, double dt, double t) {
        clock += dt * 0.5 * (std::sqrt(before / temperature) + std::sqrt(t / temperature));
        before = t;
    });
    return clock;
}

} // namespace sandlane::analysis
