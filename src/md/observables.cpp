#include "md/observables.hpp"

#include "laws/contact.hpp"
#include "md/near_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sandlane::md {

namespace {

struct ContactForce {
    double x, y, tangential, overlap, energy;
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
    return {f.x, f.y, f.tangential, f.overlap, energy + Tangential::energy(c.tangential_stiffness, memory)};
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

// What one contact is to its listeners. second: storage index of the other grain; a wall has none.
struct Found {
    std::size_t first, second;
    Vec normal; // from the first to the second
    ContactForce force;
    const WallElement* element;    // null: a pair of grains
    Vec wall_point, wall_velocity; // of the material on the surface of the wall
};

class Search {
public:
    Search(const scene::Scene& scene, const Plan& plan, const State& state, const Walls& walls,
           const std::vector<double>& coefficients, const ContactMemories& memories)
        : scene_(scene), state_(state), walls_(walls), coefficients_(coefficients), memories_(memories),
          kernel_(contact_kernel(plan)), rate_(1 / plan.dt) {}

    template <class Body> void for_contacts(const Body& body) const {
        for_pairs(body);
        if (walls_.empty()) return;
        for (std::size_t i = 0; i < state_.size(); ++i)
            walls_.for_touching(centre(i), state_.radius[i],
                                [&](std::size_t e, const WallContact& c) { body(with_wall(i, e, c)); });
    }

private:
    template <class Body> void for_pairs(const Body& body) const {
        const auto position = [&](std::size_t i) { return centre(i); };
        for_near_pairs(scene_, state_, position, [&](std::size_t i, std::size_t j, Vec d) {
            const double reach = state_.radius[i] + state_.radius[j];
            if (!(dot(d, d) < reach * reach)) return;
            const laws::PairState<double> s{d.x,
                                            d.y,
                                            (state_.value(j, 0, 1) - state_.value(i, 0, 1)) * rate_,
                                            (state_.value(j, 1, 1) - state_.value(i, 1, 1)) * rate_,
                                            spin(i) + spin(j),
                                            reach,
                                            state_.inverse_radius[i] + state_.inverse_radius[j]};
            const ContactForce f = kernel_(s, coefficients_of(state_.material[i], state_.material[j]),
                                           memories_.pairs.find(state_.id[i], state_.id[j]));
            body(Found{i, j, (1 / norm(d)) * d, f, nullptr, {}, {}});
        });
    }

    [[nodiscard]] Found with_wall(std::size_t i, std::size_t e, const WallContact& c) const {
        const WallElement& element = walls_.element(e);
        const laws::PairState<double> s{c.distance * c.direction.x,
                                        c.distance * c.direction.y,
                                        c.velocity.x - state_.value(i, 0, 1) * rate_,
                                        c.velocity.y - state_.value(i, 1, 1) * rate_,
                                        spin(i) + c.spin,
                                        state_.radius[i] + c.radius,
                                        state_.inverse_radius[i] + c.inverse_radius};
        const ContactForce f = kernel_(s, coefficients_of(state_.material[i], element.material),
                                       memories_.walls.find_wall(state_.id[i], static_cast<std::int64_t>(e)));
        const Vec n = c.direction;
        return {i,
                i,
                n,
                f,
                &element,
                centre(i) + (c.distance - c.radius) * n,
                c.velocity + c.spin * Vec{n.y, -n.x, 0}};
    }

    [[nodiscard]] Vec centre(std::size_t i) const {
        return {state_.value(i, 0, 0), state_.value(i, 1, 0), 0};
    }
    [[nodiscard]] double spin(std::size_t i) const {
        return state_.spin() ? state_.radius[i] * state_.value(i, 2, 1) * rate_ : 0.0;
    }
    [[nodiscard]] laws::PairCoefficients<double> coefficients_of(int a, int b) const {
        const int materials = static_cast<int>(scene_.materials.size());
        return laws::coefficients_from<double>(coefficients_.data() +
                                               (a * materials + b) * laws::pair_coefficients);
    }

    const scene::Scene& scene_;
    const State& state_;
    const Walls& walls_;
    const std::vector<double>& coefficients_;
    const ContactMemories& memories_;
    ContactKernel kernel_;
    double rate_; // 1/s, from Nordsieck-scaled to physical velocities
};

struct GrainEnergy {
    double kinetic = 0, rotational = 0, potential = 0;
};

GrainEnergy energies_of(const scene::Scene& scene, const Plan& plan, const State& state, std::size_t i) {
    const double rate = 1 / plan.dt, m = state.mass[i];
    const double vx = state.value(i, 0, 1) * rate, vy = state.value(i, 1, 1) * rate;
    const Vec g = scene.domain.gravity, size = plan.upper - plan.lower;
    const double x = state.value(i, 0, 0) - plan.lower.x + state.image_x[i] * size.x;
    const double y = state.value(i, 1, 0) - plan.lower.y + state.image_y[i] * size.y;
    GrainEnergy e{0.5 * m * (vx * vx + vy * vy), 0, -m * (g.x * x + g.y * y)};
    if (!state.spin()) return e;
    const double omega = state.value(i, 2, 1) * rate, inertia = state.radius[i] / state.spin_factor[i];
    e.rotational = 0.5 * inertia * omega * omega;
    e.potential -= inertia * g.z * state.value(i, 2, 0);
    return e;
}

void add_grains(const scene::Scene& scene, const Plan& plan, const State& state, Observables& o) {
    const double rate = 1 / plan.dt;
    for (std::size_t i = 0; i < state.size(); ++i) {
        const GrainEnergy e = energies_of(scene, plan, state, i);
        o.kinetic += e.kinetic;
        o.rotational += e.rotational;
        o.potential += e.potential;
        const double vx = state.value(i, 0, 1) * rate, vy = state.value(i, 1, 1) * rate;
        o.momentum_x += state.mass[i] * vx;
        o.momentum_y += state.mass[i] * vy;
        o.largest_speed = std::max(o.largest_speed, std::hypot(vx, vy));
    }
}

// The wall feels the opposite of the grain's force.
void add_wall_load(const Walls& walls, const Found& c, WallLoad& load) {
    const Vec arm = c.wall_point - walls.pivot(*c.element);
    load.force_x -= c.force.x;
    load.force_y -= c.force.y;
    load.torque -= arm.x * c.force.y - arm.y * c.force.x;
    load.power += c.force.x * c.wall_velocity.x + c.force.y * c.wall_velocity.y;
}

} // namespace

Observables observe(const scene::Scene& scene, const Plan& plan, const State& state, const Walls& walls,
                    const std::vector<double>& coefficients, const ContactMemories& memories) {
    Observables o;
    o.grains = static_cast<std::int64_t>(state.size());
    o.pressure.assign(state.size(), 0.0);
    o.walls.resize(scene.walls.size());
    add_grains(scene, plan, state, o);
    // Half the trace of -(1/V) sum l f with l from centre to contact, V = pi R^2 (8.1): R (-f.n)/(2 pi R^2).
    const auto press = [&](std::size_t i, double inward) {
        o.pressure[i] += inward / (2 * std::numbers::pi * state.radius[i]);
    };
    Search(scene, plan, state, walls, coefficients, memories).for_contacts([&](const Found& c) {
        const double inward = -(c.force.x * c.normal.x + c.force.y * c.normal.y);
        o.elastic += c.force.energy;
        press(c.first, inward);
        double smaller = state.radius[c.first];
        if (c.element == nullptr) {
            ++o.contacts;
            press(c.second, inward);
            smaller = std::min(smaller, state.radius[c.second]);
        } else {
            ++o.wall_contacts;
            add_wall_load(walls, c, o.walls[static_cast<std::size_t>(c.element->wall)]);
        }
        o.largest_overlap = std::max(o.largest_overlap, c.force.overlap / smaller);
    });
    return o;
}

analysis::Contacts contacts(const scene::Scene& scene, const Plan& plan, const State& state,
                            const Walls& walls, const std::vector<double>& coefficients,
                            const ContactMemories& memories) {
    analysis::Contacts all;
    Search(scene, plan, state, walls, coefficients, memories).for_contacts([&](const Found& c) {
        analysis::Contact& to = all.emplace_back();
        to.i = static_cast<std::int32_t>(c.first);
        to.normal = c.normal;
        to.overlap = c.force.overlap;
        to.force = {c.force.x, c.force.y, 0};
        to.tangential = c.force.tangential;
        if (c.element != nullptr) {
            to.wall = c.element->wall;
            to.point = c.wall_point;
            return;
        }
        to.j = static_cast<std::int32_t>(c.second);
        const Vec centre{state.value(c.first, 0, 0), state.value(c.first, 1, 0), 0};
        to.point = centre + (state.radius[c.first] - 0.5 * c.force.overlap) * c.normal;
    });
    return all;
}

double grain_energy(const scene::Scene& scene, const Plan& plan, const State& state, std::size_t i) {
    const GrainEnergy e = energies_of(scene, plan, state, i);
    return e.kinetic + e.rotational + e.potential;
}

} // namespace sandlane::md
