#include "md/observables.hpp"

#include "laws/contact.hpp"
#include "md/near_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sandlane::md {

namespace {

struct ContactForce {
    double x, y, overlap, energy;
};

template <class Normal, class Tangential>
ContactForce contact_force(const laws::PairState<double>& s, const laws::PairCoefficients<double>& c,
                           const double* remembered) {
    double memory[Tangential::memory + 1];
    for (int m = 0; m < Tangential::memory; ++m)
        memory[m] = remembered != nullptr ? remembered[m] : laws::no_contact;
    const auto f = laws::pair_force<Normal, Tangential, double>(s, c, memory, 0.0);
    const double energy = Normal::energy(
        laws::NormalInput<double>{f.overlap, 0, c.elastic, c.dissipative, s.inverse_reduced_radius});
    return {f.x, f.y, f.overlap, energy + Tangential::energy(c.tangential_stiffness, memory)};
}

using ContactKernel = ContactForce (*)(const laws::PairState<double>&, const laws::PairCoefficients<double>&,
                                       const double*);

template <class Normal> ContactKernel with_tangential(int tangential) {
    int position = 0;
    ContactKernel kernel = nullptr;
#define TANGENTIAL(type, choice, name)                                                                       \
    if (position++ == tangential) kernel = contact_force<Normal, laws::type>;
#include "laws/laws.def"
    return kernel;
}

ContactKernel contact_kernel(const Plan& plan) {
    int position = 0;
    ContactKernel kernel = nullptr;
#define NORMAL(type, choice, name, key)                                                                      \
    if (position++ == plan.normal) kernel = with_tangential<laws::type>(plan.tangential);
#include "laws/laws.def"
    return kernel;
}

void add_grain_energies(const scene::Scene& scene, const Plan& plan, const State& state, Observables& o) {
    const double rate = 1 / plan.dt;
    for (std::size_t i = 0; i < state.size(); ++i) {
        const double vx = state.value(i, 0, 1) * rate, vy = state.value(i, 1, 1) * rate, m = state.mass[i];
        o.kinetic += 0.5 * m * (vx * vx + vy * vy);
        o.momentum_x += m * vx;
        o.momentum_y += m * vy;
        o.largest_speed = std::max(o.largest_speed, std::hypot(vx, vy));
        const Vec g = scene.domain.gravity;
        o.potential -= m * (g.x * (state.value(i, 0, 0) - scene.domain.lower.x) +
                            g.y * (state.value(i, 1, 0) - scene.domain.lower.y));
        if (!state.spin()) continue;
        const double omega = state.value(i, 2, 1) * rate;
        o.rotational += 0.5 * state.radius[i] / state.spin_factor[i] * omega * omega;
    }
}

} // namespace

Observables observe(const scene::Scene& scene, const Plan& plan, const State& state, const Walls& walls,
                    const std::vector<double>& coefficients, const ContactMemories& memories) {
    Observables o;
    o.grains = static_cast<std::int64_t>(state.size());
    o.pressure.assign(state.size(), 0.0);
    add_grain_energies(scene, plan, state, o);
    const ContactKernel kernel = contact_kernel(plan);
    const double rate = 1 / plan.dt;
    const int materials = static_cast<int>(scene.materials.size());
    const auto spin = [&](std::size_t i) {
        return state.spin() ? state.radius[i] * state.value(i, 2, 1) * rate : 0.0;
    };
    const auto coefficients_of = [&](int a, int b) -> laws::PairCoefficients<double> {
        return laws::coefficients_from<double>(coefficients.data() +
                                               (a * materials + b) * laws::pair_coefficients);
    };
    // Half the trace of -(1/V) sum l f with l from centre to contact, V = pi R^2 (8.1): R (-f.n)/(2 pi R^2).
    const auto press = [&](std::size_t i, double inward) {
        o.pressure[i] += inward / (2 * std::numbers::pi * state.radius[i]);
    };

    const auto centre = [&](std::size_t i) { return Vec{state.value(i, 0, 0), state.value(i, 1, 0), 0}; };
    for_near_pairs(scene, state, centre, [&](std::size_t i, std::size_t j, Vec d) {
        const double reach = state.radius[i] + state.radius[j];
        if (!(dot(d, d) < reach * reach)) return;
        const laws::PairState<double> s{d.x,
                                        d.y,
                                        (state.value(j, 0, 1) - state.value(i, 0, 1)) * rate,
                                        (state.value(j, 1, 1) - state.value(i, 1, 1)) * rate,
                                        spin(i) + spin(j),
                                        reach,
                                        state.inverse_radius[i] + state.inverse_radius[j]};
        const ContactForce f = kernel(s, coefficients_of(state.material[i], state.material[j]),
                                      memories.pairs.find(state.id[i], state.id[j]));
        ++o.contacts;
        o.elastic += f.energy;
        o.largest_overlap =
            std::max(o.largest_overlap, f.overlap / std::min(state.radius[i], state.radius[j]));
        const double inward = -(f.x * d.x + f.y * d.y) / norm(d);
        press(i, inward);
        press(j, inward);
    });
    if (walls.empty()) return o;
    for (std::size_t i = 0; i < state.size(); ++i)
        walls.for_touching(centre(i), state.radius[i], [&](std::size_t e, const WallContact& c) {
            const laws::PairState<double> s{c.distance * c.direction.x,
                                            c.distance * c.direction.y,
                                            c.velocity.x - state.value(i, 0, 1) * rate,
                                            c.velocity.y - state.value(i, 1, 1) * rate,
                                            spin(i) + c.spin,
                                            state.radius[i] + c.radius,
                                            state.inverse_radius[i] + c.inverse_radius};
            const ContactForce f =
                kernel(s, coefficients_of(state.material[i], walls.elements()[e].material),
                       memories.walls.find_wall(state.id[i], static_cast<std::int64_t>(e)));
            ++o.wall_contacts;
            o.elastic += f.energy;
            o.largest_overlap = std::max(o.largest_overlap, f.overlap / state.radius[i]);
            press(i, -(f.x * c.direction.x + f.y * c.direction.y));
        });
    return o;
}

} // namespace sandlane::md
