#include "md/collision_error.hpp"

#include "md/law_traits.hpp"
#include "motion/gear.hpp"

#include <algorithm>
#include <cmath>

namespace sandlane::md {

namespace {

// Grains that touch for longer stick.
constexpr double longest_contact = 20; // of the estimate

// m/s^2, of the overlap; `memory` of the contact is brought up to date.
template <class Law>
double acceleration(const Impact& k, double overlap, double rate, double* memory, double dt = 0) {
    return -laws::normal_force<Law>(overlap, rate, k.coefficients, k.radius, memory, dt).force / k.mass;
}

// Whether the values from the second derivative on have died away.
template <int order> bool is_straight(const double (&x)[order]) {
    return std::all_of(x + 2, x + order,
                       [&](double value) { return std::abs(value) < 1e-15 * std::abs(x[1]); });
}

// x: the overlap and its derivatives as the integrator stores them, negative before and after the contact.
template <class Law, int scheme> double stepped(const Impact& k, double dt, double gap) {
    double x[motion::values_of(scheme)] = {-gap, k.speed * dt}, memory[Law::memory + 1] = {};
    const auto steps = static_cast<std::int64_t>((longest_contact * k.time + gap / k.speed) / dt) + 100;
    bool met = false;
    for (std::int64_t n = 0; n < steps; ++n) {
        motion::predict<scheme>(x);
        const bool touching = x[0] > 0;
        const double a = touching ? acceleration<Law>(k, x[0], x[1] / dt, memory, dt) : 0.0;
        motion::correct<scheme>(x, a, 0.5 * dt * dt);
        met = met || touching;
        if (!std::isfinite(x[1])) return 0;
        if (met && !touching && x[1] < 0 && is_straight(x)) return -x[1] / (dt * k.speed);
    }
    return 0;
}

// Overlap and rate after a step of the classical Runge-Kutta method.
struct Motion {
    double overlap, rate;
};

template <class Law> Motion runge_kutta(const Impact& k, Motion at, double h, const double* remembered) {
    const auto slope = [&](const Motion& y) {
        double memory[Law::memory + 1] = {remembered[0]};
        return Motion{y.rate, y.overlap > 0 ? acceleration<Law>(k, y.overlap, y.rate, memory) : 0.0};
    };
    const auto moved = [&](const Motion& by, double time) {
        return Motion{at.overlap + time * by.overlap, at.rate + time * by.rate};
    };
    const Motion a = slope(at), b = slope(moved(a, 0.5 * h)), c = slope(moved(b, 0.5 * h)),
                 d = slope(moved(c, h));
    return moved(
        {a.overlap + 2 * (b.overlap + c.overlap) + d.overlap, a.rate + 2 * (b.rate + c.rate) + d.rate},
        h / 6);
}

// Steps adapt: they become short where the force is not smooth, at the begin, at a cut and at the end, which
// is found to 1e-12 of the contact.
template <class Law> double exact(const Impact& k) {
    constexpr double tolerance = 1e-13;
    const double time = k.time;
    Motion y{0, k.speed};
    double h = 1e-3 * time, elapsed = 0, memory[Law::memory + 1] = {};
    for (int n = 0; n < 1000000 && elapsed < longest_contact * time; ++n) {
        const Motion whole = runge_kutta<Law>(k, y, h, memory);
        const Motion half = runge_kutta<Law>(k, y, 0.5 * h, memory);
        const Motion fine = runge_kutta<Law>(k, half, 0.5 * h, memory);
        const double error =
            std::max(std::abs(fine.overlap - whole.overlap) / std::max(k.speed * time, y.overlap),
                     std::abs(fine.rate - whole.rate) / std::max(k.speed, std::abs(y.rate)));
        const bool ends = !(fine.overlap > 0), shortest = h < 1e-12 * time;
        // A law that remembers must see the largest overlap.
        const bool turns = Law::memory > 0 && y.rate > 0 && fine.rate < 0 && h > 1e-7 * time;
        if ((error > tolerance || ends || turns) && !shortest) {
            h *= 0.5;
            continue;
        }
        if (ends) return std::max(0.0, -fine.rate / k.speed);
        y = fine;
        elapsed += h;
        (void)acceleration<Law>(k, y.overlap, y.rate, memory);
        if (error < 0.02 * tolerance) h *= 2;
    }
    return 0;
}

} // namespace

Impact make_impact(int normal, const Coefficients& c, double mass, double radius, double speed) {
    return {c, mass, radius, speed, with_normal_law(normal, [&]<class Law>(Type<Law>) {
                return LawTraits<Law>::scale(c, mass, radius, speed).collision_time;
            })};
}

double stepped_restitution(int normal, Stepping stepping, const Impact& impact, double dt, double gap) {
    const auto of_law = [&]<class Law>(Type<Law>) {
        switch (stepping.scheme) {
        case 3:
            return stepped<Law, 3>(impact, dt, gap);
        case 4:
            return stepped<Law, 4>(impact, dt, gap);
        case 5:
            return stepped<Law, 5>(impact, dt, gap);
        case 6:
            return stepped<Law, 6>(impact, dt, gap);
        default:
            return stepped<Law, motion::verlet_with_slope>(impact, dt, gap);
        }
    };
    return with_normal_law(normal, [&]<class Law>(Type<Law> law) {
        if constexpr (laws::can_resolve<Law>)
            if (stepping.resolved) return of_law(Type<laws::Resolved<Law>>{});
        return of_law(law);
    });
}

double exact_restitution(int normal, const Impact& impact) {
    return with_normal_law(normal, [&]<class Law>(Type<Law>) { return exact<Law>(impact); });
}

double collision_error(double restitution, double exact) {
    const double energy = std::abs(restitution * restitution - exact * exact);
    return exact > 0 ? std::max(std::abs(restitution - exact) / exact, energy) : energy;
}

double collision_error(int normal, Stepping stepping, const Impact& impact, double exact, double dt,
                       double enough) {
    double sum = 0;
    for (int n = 0; n < phases && !(std::sqrt(sum / phases) > enough); ++n) {
        const double gap = (n + 0.5) / phases * dt * impact.speed;
        const double error = collision_error(stepped_restitution(normal, stepping, impact, dt, gap), exact);
        sum += error * error;
    }
    return std::sqrt(sum / phases);
}

} // namespace sandlane::md
