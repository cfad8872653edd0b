#include "analysis/gas_mixture.hpp"

#include "laws/collision.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sandlane::analysis {

namespace {

// Pair correlation at contact of kinds i and j.
double contact(const MixtureGas& gas, std::size_t i, std::size_t j) {
    if (!gas.dense) return 1;
    const int d = gas.dimension;
    double lower = 0, upper = 0;
    for (const MixtureKind& k : gas.kinds) {
        const double part = std::numbers::pi / (d == 3 ? 6 : 4) * k.density * std::pow(k.diameter, d - 1);
        lower += part;
        upper += part * k.diameter;
    }
    const double s = gas.kinds[i].diameter, t = gas.kinds[j].diameter, free = 1 - upper;
    return laws::contact_of_pair(d, s * t / (s + t) * lower / free) / free;
}

// What collisions of kind i with kind j do: a particle of kind i meets `rate` of the others a second.
struct Encounter {
    double rate;
    double variance; // T_i/m_i + T_j/m_j
};
Encounter encounter(const MixtureGas& gas, std::size_t i, std::size_t j, double t_i, double t_j) {
    const MixtureKind &a = gas.kinds[i], &b = gas.kinds[j];
    const double s = 0.5 * (a.diameter + b.diameter), pi = std::numbers::pi;
    const double variance = t_i / a.mass + t_j / b.mass;
    // S <g> of particles whose relative velocity has this variance.
    const double sweeps =
        gas.dimension == 3 ? pi * s * s * std::sqrt(8 / pi * variance) : 2 * s * std::sqrt(pi / 2 * variance);
    return {b.density * contact(gas, i, j) * sweeps, variance};
}

} // namespace

double collision_rate(const MixtureGas& gas, std::size_t i, std::size_t j, double t_i, double t_j) {
    return encounter(gas, i, j, t_i, t_j).rate;
}

double collision_rate(const MixtureGas& gas, double temperature) {
    double sum = 0, density = 0;
    for (std::size_t i = 0; i < gas.size(); ++i) {
        density += gas.kinds[i].density;
        for (std::size_t j = 0; j < gas.size(); ++j)
            sum += gas.kinds[i].density * encounter(gas, i, j, temperature, temperature).rate;
    }
    return density > 0 ? sum / density : 0;
}

// In a collision v_i changes by (1 + eps) mu g_n along e, mu = m_j/(m_i + m_j). With <g_n^2> = 2 (a_i + a_j)
// and the mean a_i/(a_i + a_j) g of v_i at given g, a = T/m, its square changes by the expression below.
std::vector<double> temperature_rates(const MixtureGas& gas, const std::vector<double>& t) {
    std::vector<double> rates(gas.size(), 0.0);
    for (std::size_t i = 0; i < gas.size(); ++i) {
        const double mass = gas.kinds[i].mass;
        rates[i] = mass * gas.kicks;
        for (std::size_t j = 0; j < gas.size(); ++j) {
            const Encounter e = encounter(gas, i, j, t[i], t[j]);
            const double eps =
                laws::restitution(gas.restitution[i * gas.size() + j], std::sqrt(2 * e.variance));
            const double push = (1 + eps) * gas.kinds[j].mass / (mass + gas.kinds[j].mass);
            rates[i] += mass / gas.dimension * e.rate * 2 * push * (push * e.variance - 2 * t[i] / mass);
        }
    }
    return rates;
}

namespace {

// Goes from one temperature of all kinds through ascending times; visit(dt, temperatures) after each step.
template <class Visit>
std::vector<std::vector<double>> follow(const MixtureGas& gas, double temperature,
                                        const std::vector<double>& times, const Visit& visit) {
    std::vector<std::vector<double>> curves;
    std::vector<double> now(gas.size(), temperature);
    const auto moved = [&](const std::vector<double>& rate, double dt) {
        std::vector<double> t = now;
        for (std::size_t k = 0; k < t.size(); ++k) t[k] = std::max(t[k] + dt * rate[k], 1e-3 * t[k]);
        return t;
    };
    double time = 0;
    for (const double until : times) {
        while (time < until) {
            const auto a = temperature_rates(gas, now);
            double fastest = 0;
            for (std::size_t k = 0; k < now.size(); ++k) {
                fastest = std::max(fastest, std::abs(a[k]) / now[k]);
                // Temperatures come together by collisions, however slowly they change now.
                for (std::size_t j = 0; j < now.size(); ++j)
                    fastest = std::max(fastest, 0.25 * collision_rate(gas, k, j, now[k], now[j]));
            }
            const double dt = fastest > 0 ? std::min(0.05 / fastest, until - time) : until - time;
            const auto b = temperature_rates(gas, moved(a, 0.5 * dt)); // Runge and Kutta
            const auto c = temperature_rates(gas, moved(b, 0.5 * dt));
            const auto d = temperature_rates(gas, moved(c, dt));
            for (std::size_t k = 0; k < now.size(); ++k)
                now[k] += dt / 6 * (a[k] + 2 * b[k] + 2 * c[k] + d[k]);
            time = time + dt >= until ? until : time + dt;
            visit(dt, now);
        }
        curves.push_back(now);
    }
    return curves;
}

} // namespace

std::vector<std::vector<double>> cooling_curves(const MixtureGas& gas, double temperature,
                                                const std::vector<double>& times) {
    return follow(gas, temperature, times, [](double, const std::vector<double>&) {});
}

double collision_clock(const MixtureGas& gas, double temperature, double end) {
    double density = 0, clock = 0, before = 1;
    for (const MixtureKind& k : gas.kinds) density += k.density;
    (void)follow(gas, temperature, {end}, [&](double dt, const std::vector<double>& now) {
        double mean = 0;
        for (std::size_t k = 0; k < now.size(); ++k) mean += gas.kinds[k].density / density * now[k];
        const double speed = std::sqrt(mean / temperature);
        clock += 0.5 * dt * (before + speed);
        before = speed;
    });
    return clock;
}

// The rates scale as T^{3/2}, so the ratios come to rest in the clock of collisions: rescaled to T_0 = 1.
std::vector<double> temperature_ratios(const MixtureGas& gas) {
    MixtureGas free = gas;
    free.kicks = 0;
    std::vector<double> t(gas.size(), 1.0);
    for (int n = 0; n < 200000; ++n) {
        const auto rates = temperature_rates(free, t);
        double fastest = 0, change = 0;
        for (std::size_t i = 0; i < t.size(); ++i)
            for (std::size_t j = 0; j < t.size(); ++j)
                fastest = std::max(fastest, collision_rate(free, i, j, t[i], t[j]));
        const double dt = 0.1 / fastest, zeta = rates[0] / t[0];
        for (std::size_t i = 0; i < t.size(); ++i) {
            const double step = dt * (rates[i] - zeta * t[i]);
            t[i] += step;
            change = std::max(change, std::abs(step) / t[i]);
        }
        if (change < 1e-12) break;
    }
    return t;
}

} // namespace sandlane::analysis
