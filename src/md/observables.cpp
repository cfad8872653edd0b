#include "md/observables.hpp"

#include "core/rng.hpp"
#include "laws/contact.hpp"
#include "md/law_choice.hpp"
#include "md/near_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

namespace sandlane::md {

namespace {

struct ContactForce {
    Vec force;         // N, on the first grain
    double tangential; // N: along the tangent in 2D, its magnitude in 3D
    double overlap, energy;
    Vec turning, couple; // torque on the first grain: R turning + couple, on its partner: R turning - couple
};

using Relative = laws::SpatialState<double>;
using Coefficients = laws::PairCoefficients<double>;

Vec vec(const Vector<double>& v) {
    return {v.x, v.y, v.z};
}

// n: unit normal.
ContactForce evaluate(const laws::PairForce<double>& f, Vec n) {
    const Vec force{f.x, f.y, 0};
    return {force, cross(n, force).z, f.overlap, 0, {0, 0, f.tangential}, {0, 0, f.couple}};
}
ContactForce evaluate(const laws::SpatialForce<double>& f, Vec n) {
    const Vec force = vec(f.force);
    return {force, norm(cross(n, force)), f.overlap, 0, vec(f.turning), vec(f.couple)};
}

// `remembered`: what the contact holds, or null if it is new.
template <class Normal, class Tangential, laws::Couples couples, int dimension>
ContactForce contact_force(const Relative& s, const Coefficients& c, const double* remembered) {
    constexpr int numbers = laws::memory_of<Normal, Tangential, couples, dimension>;
    static_assert(numbers <= laws::most_memory);
    double memory[numbers + 1] = {laws::no_contact};
    if (remembered != nullptr) std::copy_n(remembered, numbers, memory);
    const Vec d = vec(s.d), n = (1 / norm(d)) * d;
    ContactForce f;
    if constexpr (dimension == 3) {
        f = evaluate(laws::pair_force<Normal, Tangential, couples>(s, c, memory, 0.0), n);
    } else {
        const laws::PairState<double> plane{s.d.x,      s.d.y,        s.dv.x,          s.dv.y,
                                            s.spin.z,   s.radius_sum, s.inverse_radii, s.turn.z,
                                            s.differ.z, s.radius,     s.other,         s.square_difference};
        f = evaluate(laws::pair_force<Normal, Tangential, couples>(plane, c, memory, 0.0), n);
    }
    f.energy =
        laws::elastic_energy<Normal, Tangential, couples, dimension>(f.overlap, s.inverse_radii, c, memory);
    return f;
}

using ContactKernel = ContactForce (*)(const Relative&, const Coefficients&, const double*);

ContactKernel contact_kernel(const Plan& plan) {
    return with_laws(plan.normal, plan.tangential, plan.couples,
                     [&]<class Normal, class Tangential, laws::Couples couples>(
                         Type<Normal>, Type<Tangential>, Kind<couples>) -> ContactKernel {
                         if constexpr (laws::exists_in<Tangential, 3>)
                             if (plan.dimension == 3) return contact_force<Normal, Tangential, couples, 3>;
                         return contact_force<Normal, Tangential, couples, 2>;
                     });
}

// What one contact is to its listeners. second: storage index of the other grain; a wall has none.
struct Found {
    std::size_t first, second;
    Vec normal; // from the first to the second
    ContactForce force;
    const WallElement* element;    // null: a pair of grains
    Vec wall_point, wall_velocity; // of the material on the surface of the wall
    Vec wall_torque, wall_spin;    // torque on the wall besides that of -force at wall_point; its rotation
    double rate, reduced_radius;   // of the overlap, m/s; m
    Coefficients coefficients;
};

class Search {
public:
    Search(const scene::Scene& scene, const Plan& plan, const State& state, const Walls& walls,
           const std::vector<double>& coefficients, const ContactMemories& memories, const scene::Box& box)
        : scene_(scene), state_(state), walls_(walls), coefficients_(coefficients), memories_(memories),
          box_(box), kernel_(contact_kernel(plan)), rate_(1 / plan.dt) {}

    template <class Body> void for_contacts(const Body& body) const {
        for_pairs(body);
        if (walls_.empty()) return;
        for (std::size_t i = 0; i < state_.size(); ++i)
            walls_.for_touching(state_.position(i), state_.radius(i),
                                [&](std::size_t e, const WallContact& c) { body(with_wall(i, e, c)); });
    }

private:
    template <class Body> void for_pairs(const Body& body) const {
        const auto position = [&](std::size_t i) { return state_.position(i); };
        double memory[laws::most_memory];
        for_near_pairs(box_, state_, position, [&](std::size_t i, std::size_t j, Vec d) {
            const double reach = state_.radius(i) + state_.radius(j);
            if (!(dot(d, d) < reach * reach)) return;
            Vec dv = rate_ * (state_.shift(j) - state_.shift(i));
            dv.x -= box_.crossings(state_.position(i), state_.position(j)) * scene_.domain.shear_rate *
                    box_.size().y;
            const double ri = state_.radius(i), rj = state_.radius(j);
            const Relative s{vector(d),
                             vector(dv),
                             vector(spin(i) + spin(j)),
                             vector(rate_ * (state_.turn(i) + state_.turn(j))),
                             reach,
                             state_.inverse_radius(i) + state_.inverse_radius(j),
                             vector(rate_ * (state_.turn(i) - state_.turn(j))),
                             ri,
                             rj,
                             ri * ri - rj * rj};
            const bool known = memories_.pairs.find(state_.id[i], state_.id[j], memory);
            const Coefficients c = coefficients_of(state_.material[i], state_.material[j]);
            const ContactForce f = kernel_(s, c, known ? memory : nullptr);
            const Vec n = (1 / norm(d)) * d;
            body(Found{i, j, n, f, nullptr, {}, {}, {}, {}, -dot(dv, n), 1 / s.inverse_radii, c});
        });
    }

    [[nodiscard]] Found with_wall(std::size_t i, std::size_t e, const WallContact& c) const {
        const WallElement& element = walls_.element(e);
        const Vec n = c.direction, wall_spin{0, 0, c.spin};
        const Vec omega = rate_ * state_.turn(i);
        const Relative s{vector(c.distance * n),
                         vector(c.velocity - rate_ * state_.shift(i)),
                         vector(spin(i) + wall_spin),
                         vector(omega + c.angular_velocity),
                         state_.radius(i) + c.radius,
                         state_.inverse_radius(i) + c.inverse_radius,
                         vector(omega - c.angular_velocity),
                         state_.radius(i),
                         c.radius,
                         flat_or_round(c, state_.radius(i))};
        const Coefficients k = coefficients_of(state_.material[i], element.material);
        const ContactForce f =
            kernel_(s, k, memories_.walls.find_wall(state_.id[i], static_cast<std::int64_t>(e)));
        return {i,
                i,
                n,
                f,
                &element,
                state_.position(i) + (c.distance - c.radius) * n,
                c.velocity + c.spin * Vec{n.y, -n.x, 0},
                c.radius * (f.turning - cross(n, f.force)) - f.couple,
                c.angular_velocity,
                -dot(vec(s.dv), n),
                1 / s.inverse_radii,
                k};
    }

    static Vector<double> vector(Vec v) { return {v.x, v.y, v.z}; }
    // R omega
    [[nodiscard]] Vec spin(std::size_t i) const { return state_.radius(i) * rate_ * state_.turn(i); }
    [[nodiscard]] Coefficients coefficients_of(int a, int b) const {
        const int materials = static_cast<int>(scene_.materials.size());
        return laws::coefficients_from<double>(coefficients_.data() +
                                               (a * materials + b) * laws::pair_coefficients);
    }

    const scene::Scene& scene_;
    const State& state_;
    const Walls& walls_;
    const std::vector<double>& coefficients_;
    const ContactMemories& memories_;
    const scene::Box& box_;
    ContactKernel kernel_;
    double rate_; // 1/s, from displacements per step to velocities
};

struct GrainEnergy {
    double kinetic = 0, rotational = 0, potential = 0;
};

GrainEnergy energies_of(const scene::Scene& scene, const Plan& plan, const State& state, std::size_t i) {
    const double rate = 1 / plan.dt, m = state.mass[i];
    const Vec v = rate * state.shift(i), size = plan.upper - plan.lower;
    const Vec g = linear_gravity(scene);
    const Vec unwrapped =
        state.position(i) - plan.lower +
        Vec{state.images(i, 0) * size.x, state.images(i, 1) * size.y, state.images(i, 2) * size.z};
    GrainEnergy e{0.5 * m * dot(v, v), 0, -m * dot(g, unwrapped)};
    if (!state.turns()) return e;
    const Vec omega = rate * state.turn(i);
    const double inertia = plan.inertia_factor * m * state.radius(i) * state.radius(i);
    e.rotational = 0.5 * inertia * dot(omega, omega);
    if (plan.dimension == 2) e.potential -= inertia * scene.domain.gravity.z * state.angle(i);
    return e;
}

void add_grains(const scene::Scene& scene, const Plan& plan, const State& state, Observables& o) {
    const double rate = 1 / plan.dt;
    for (std::size_t i = 0; i < state.size(); ++i) {
        const GrainEnergy e = energies_of(scene, plan, state, i);
        o.kinetic += e.kinetic;
        o.rotational += e.rotational;
        o.potential += e.potential;
        const Vec v = rate * state.shift(i);
        o.momentum = o.momentum + state.mass[i] * v;
        o.largest_speed = std::max(o.largest_speed, norm(v));
    }
}

// The wall feels the opposite of the grain's force.
void add_wall_load(const Walls& walls, const Found& c, WallLoad& load) {
    const Vec arm = c.wall_point - walls.pivot(*c.element), force = c.force.force;
    load.force = load.force - force;
    load.torque = load.torque + c.wall_torque - cross(arm, force);
    load.power += dot(force, c.wall_velocity) - dot(c.wall_torque, c.wall_spin);
}

Place place_of(const State& state, const Found& c) {
    const std::int64_t first = state.id[c.first];
    if (c.element != nullptr) return {first, -1 - c.element->wall, state.position(c.first)};
    const std::int64_t second = state.id[c.second];
    return first < second ? Place{first, second, state.position(c.first)}
                          : Place{second, first, state.position(c.second)};
}

} // namespace

Observables observe(const scene::Scene& scene, const Plan& plan, const State& state, const Walls& walls,
                    const std::vector<double>& coefficients, const ContactMemories& memories,
                    const scene::Box& box) {
    Observables o;
    o.grains = static_cast<std::int64_t>(state.size());
    o.pressure.assign(state.size(), 0.0);
    o.walls.resize(scene.walls.size());
    add_grains(scene, plan, state, o);
    // Trace of -(1/V) sum l f over the dimension, l from the centre to the contact: R (-f.n)/(D V)
    // (docs/physics.md 11), V = pi R^2 or 4/3 pi R^3.
    const auto press = [&](std::size_t i, double inward) {
        const double r = state.radius(i), area = 2 * std::numbers::pi * r;
        o.pressure[i] += inward / (plan.dimension == 3 ? 2 * r * area : area);
    };
    Search(scene, plan, state, walls, coefficients, memories, box).for_contacts([&](const Found& c) {
        const double inward = -dot(c.force.force, c.normal);
        o.elastic += c.force.energy;
        press(c.first, inward);
        double smaller = state.radius(c.first);
        if (c.element == nullptr) {
            ++o.contacts;
            press(c.second, inward);
            smaller = std::min(smaller, state.radius(c.second));
        } else {
            ++o.wall_contacts;
            add_wall_load(walls, c, o.walls[static_cast<std::size_t>(c.element->wall)]);
        }
        const double ratio = c.force.overlap / smaller;
        if (ratio <= o.largest_overlap) return;
        o.largest_overlap = ratio;
        o.deepest = place_of(state, c);
    });
    return o;
}

analysis::Contacts contacts(const scene::Scene& scene, const Plan& plan, const State& state,
                            const Walls& walls, const std::vector<double>& coefficients,
                            const ContactMemories& memories, const scene::Box& box) {
    analysis::Contacts all;
    Search(scene, plan, state, walls, coefficients, memories, box).for_contacts([&](const Found& c) {
        analysis::Contact& to = all.emplace_back();
        to.i = static_cast<std::int32_t>(c.first);
        to.normal = c.normal;
        to.overlap = c.force.overlap;
        to.force = c.force.force;
        to.tangential = c.force.tangential;
        if (c.element != nullptr) {
            to.wall = c.element->wall;
            to.point = c.wall_point;
            return;
        }
        to.j = static_cast<std::int32_t>(c.second);
        to.point = state.position(c.first) + (state.radius(c.first) - 0.5 * c.force.overlap) * c.normal;
    });
    return all;
}

std::vector<SampledContact> sample_contacts(const scene::Scene& scene, const Plan& plan, const State& state,
                                            const Walls& walls, const std::vector<double>& coefficients,
                                            const ContactMemories& memories, const scene::Box& box,
                                            std::int64_t step) {
    const Random random(static_cast<std::uint64_t>(scene.seed), Stream::watch);
    const auto at_step = static_cast<std::uint64_t>(step);
    std::vector<SampledContact> all;
    Search(scene, plan, state, walls, coefficients, memories, box).for_contacts([&](const Found& c) {
        const bool wall = c.element != nullptr;
        SampledContact s;
        s.place = place_of(state, c);
        const double mass = 1 / (state.inverse_mass[c.first] + (wall ? 0 : state.inverse_mass[c.second]));
        const double square = c.rate * c.rate + 2 * c.force.energy / mass;
        if (!(square > 0)) return;
        s.impact = {c.coefficients, mass, c.reduced_radius, std::sqrt(square), 0};
        // A chain of three draws: neither grain nor step alone decides.
        const auto mixed = [&](std::uint64_t with) {
            const auto [u, w] = random.uniform2(with ^ s.key);
            s.key = static_cast<std::uint64_t>(u * 0x1p53);
            s.phase = w;
        };
        for (const auto part :
             {at_step, static_cast<std::uint64_t>(s.place.first), static_cast<std::uint64_t>(s.place.second)})
            mixed(part);
        all.push_back(s);
    });
    const auto count = std::min(all.size(), static_cast<std::size_t>(scene.watch.sample));
    const auto before = [](const SampledContact& a, const SampledContact& b) {
        return std::tie(a.key, a.place.first, a.place.second) <
               std::tie(b.key, b.place.first, b.place.second);
    };
    std::partial_sort(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count), all.end(), before);
    all.resize(count);
    for (SampledContact& s : all) {
        const Impact& k = s.impact;
        s.impact = make_impact(plan.normal, k.coefficients, k.mass, k.radius, k.speed);
    }
    return all;
}

double grain_energy(const scene::Scene& scene, const Plan& plan, const State& state, std::size_t i) {
    const GrainEnergy e = energies_of(scene, plan, state, i);
    return e.kinetic + e.rotational + e.potential;
}

} // namespace sandlane::md
