#include "md/plan.hpp"

#include "core/error.hpp"
#include "laws/contact.hpp"
#include "md/law_choice.hpp"
#include "md/law_traits.hpp"
#include "scene/schema.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <type_traits>

namespace sandlane::md {

using scene::NeighbourMethod;
using scene::Scene;

namespace {

int order_of(scene::Integrator integrator) {
    switch (integrator) {
    case scene::Integrator::gear4:
        return 4;
    case scene::Integrator::gear5:
        return 5;
    case scene::Integrator::gear6:
        return 6;
    case scene::Integrator::velocity_verlet:
        return 3;
    }
    return 5;
}

const char* integrator_name(scene::Integrator integrator) {
    static const char* names[] = {"gear4", "gear5", "gear6", "velocity-verlet"};
    return names[static_cast<int>(integrator)];
}

// Largest stable w dt of the integrator at damping ratio z (docs/physics.md 8), interpolated.
double stable_phase(int order, double z) {
    static constexpr double at[] = {0.0, 0.3, 1.0, 3.0};
    static constexpr double bound[4][4] = {{2.0, 1.13, 0.47, 0.166},
                                           {1.41, 0.69, 0.26, 0.091},
                                           {0.94, 0.42, 0.148, 0.050},
                                           {0.81, 0.25, 0.081, 0.028}};
    const double* b = bound[order - 3];
    for (int n = 1; n < 4; ++n)
        if (z <= at[n]) return b[n - 1] + (b[n] - b[n - 1]) * (z - at[n - 1]) / (at[n] - at[n - 1]);
    return b[3] * at[3] / z;
}

// Largest stable dt gamma/m of a pure damping force.
double stable_damping(int order) {
    static constexpr double bound[] = {1.0, 0.54, 0.30, 0.16};
    return bound[order - 3];
}

// Calls body(traits) with the traits of the scene's normal law.
template <class Body> auto with_traits(const Scene& scene, const Body& body) {
    return with_normal_law(static_cast<int>(scene.md.normal),
                           [&]<class Law>(Type<Law>) { return body(LawTraits<Law>{}); });
}

bool has_spring(scene::TangentialLaw law) {
    return law == scene::TangentialLaw::cundall_strack || law == scene::TangentialLaw::walton_braun;
}

// Area or volume of a grain and of the domain.
double content(const Scene& scene, double radius) {
    const double area = std::numbers::pi * radius * radius;
    return scene.domain.dimension == 3 ? 4.0 / 3.0 * area * radius : area;
}
double content(const Scene& scene) {
    const Vec size = scene.domain.upper - scene.domain.lower;
    return size.x * size.y * (scene.domain.dimension == 3 ? size.z : 1.0);
}

// What contacts of the plan's laws remember.
void set_memory(Plan& plan) {
    with_laws(plan.normal, plan.tangential, plan.couples,
              [&]<class Normal, class Tangential, laws::Couples couples>(Type<Normal>, Type<Tangential>,
                                                                         Kind<couples>) {
                  using namespace laws;
                  const bool space = plan.dimension == 3;
                  plan.odd_memory = space ? rolling_memory<couples, 3> + tangential_memory<Tangential, 3>
                                          : rolling_memory<couples, 2>;
                  plan.memory = space ? memory_of<Normal, Tangential, couples, 3>
                                      : memory_of<Normal, Tangential, couples, 2>;
              });
}

} // namespace

// Lists are measured to be the fastest from a few grains on, at any density and speed; `tools/bench scenes`
// and `tools/bench kernels` show it.
NeighbourMethod automatic_method(std::size_t grains) {
    return grains <= few_grains ? NeighbourMethod::brute_force : NeighbourMethod::verlet;
}

double lattice_ratio_bound(int reach, double delta) {
    return reach * (2 - delta) / (2 * std::numbers::sqrt2);
}

std::vector<double> pair_table(const Scene& scene) {
    const std::size_t n = scene.materials.size();
    std::vector<double> table(n * n * laws::pair_coefficients);
    with_traits(scene, [&](auto traits) {
        for (std::size_t a = 0; a < n; ++a)
            for (std::size_t b = 0; b < n; ++b) {
                const scene::Material &p = scene.materials[a], &q = scene.materials[b];
                double* c = table.data() + (a * n + b) * laws::pair_coefficients;
                const laws::PairCoefficients<double> mixed{
                    traits.elastic(p, q),
                    traits.dissipative(p, q),
                    std::min(p.tangential_damping, q.tangential_damping),
                    std::min(p.friction, q.friction),
                    std::min(p.tangential_stiffness, q.tangential_stiffness),
                    std::min(p.cohesion, q.cohesion),
                    std::min(p.rolling_friction, q.rolling_friction),
                    std::min(p.rolling_damping, q.rolling_damping),
                    std::min(p.rolling_stiffness, q.rolling_stiffness),
                    scene.md.cut ? 0.0 : -std::numeric_limits<double>::infinity(),
                    scene.md.lever_arm == scene::LeverArm::plane ? 1.0 : 0.0};
                const double values[] = {mixed.elastic,
                                         mixed.dissipative,
                                         mixed.tangential_damping,
                                         mixed.friction,
                                         mixed.tangential_stiffness,
                                         mixed.cohesion,
                                         mixed.rolling_friction,
                                         mixed.rolling_damping,
                                         mixed.rolling_stiffness,
                                         mixed.least,
                                         mixed.lever};
                static_assert(std::size(values) == laws::pair_coefficients);
                std::copy_n(values, laws::pair_coefficients, c);
                for (const scene::MaterialPair& pair : scene.pairs) {
                    const bool here = (pair.first == p.name && pair.second == q.name) ||
                                      (pair.first == q.name && pair.second == p.name);
                    if (!here) continue;
                    const double given[] = {
                        traits.elastic(pair),  traits.dissipative(pair),  pair.tangential_damping,
                        pair.friction,         pair.tangential_stiffness, pair.cohesion,
                        pair.rolling_friction, pair.rolling_damping,      pair.rolling_stiffness};
                    for (std::size_t k = 0; k < std::size(given); ++k)
                        if (given[k] >= 0) c[k] = given[k];
                }
                if (scene.md.tangential == scene::TangentialLaw::none)
                    c[2] = c[3] = c[4] = c[6] = c[7] = c[8] = 0;
            }
    });
    return table;
}

Needs analyse(const Scene& scene, const std::vector<scene::GrainState>& grains) {
    Needs needs;
    needs.radius_min = needs.mass_min = std::numeric_limits<double>::infinity();
    double covered = 0;
    for (const scene::GrainState& g : grains) {
        const bool later = g.insert_at > -std::numeric_limits<double>::infinity();
        (later ? needs.poured : needs.grains) += 1;
        needs.radius_min = std::min(needs.radius_min, g.radius);
        needs.radius_max = std::max(needs.radius_max, g.radius);
        needs.mass_min = std::min(needs.mass_min, g.mass);
        needs.mass_max = std::max(needs.mass_max, g.mass);
        if (g.material != grains.front().material) needs.many_materials = true;
        needs.spinning = needs.spinning || g.omega != 0 || norm(g.angular_velocity) > 0;
        covered += content(scene, g.radius);
    }
    if (grains.empty()) needs.radius_min = needs.radius_max = needs.mass_min = needs.mass_max = 0;
    needs.many_radii = needs.radius_min != needs.radius_max;
    const std::vector<double> table = pair_table(scene);
    if (scene.md.tangential != scene::TangentialLaw::none)
        for (std::size_t p = 0; p < table.size(); p += laws::pair_coefficients) {
            const laws::PairCoefficients<double> c = laws::coefficients_from<double>(table.data() + p);
            const bool surfaces = c.friction > 0 && (c.tangential_damping > 0 || c.tangential_stiffness > 0);
            needs.friction = needs.friction || surfaces;
            const bool rolling = c.rolling_friction > 0 && (c.rolling_damping > 0 || c.rolling_stiffness > 0);
            if (rolling || (surfaces && c.lever > 0))
                needs.couples = std::max(needs.couples, laws::Couples::damped);
            if (rolling && c.rolling_stiffness > 0) needs.couples = laws::Couples::sprung;
        }
    needs.memory = needs.friction && has_spring(scene.md.tangential);
    needs.memory = needs.memory || needs.couples == laws::Couples::sprung;
    needs.sizes = size_classes(grains.size(), [&](std::size_t i) { return grains[i].radius; });
    needs.walls = !scene.walls.empty();
    for (const scene::Wall& w : scene.walls) needs.moving_walls = needs.moving_walls || !w.motion.empty();
    needs.gravity = norm(scene.domain.gravity) > 0;
    needs.packing_fraction = covered / content(scene);
    return needs;
}

Derived derive(const Scene& scene, const Needs& needs) {
    Derived d;
    if (needs.radius_max == 0) {
        d.collision_time = d.critical_dt = d.recommended_dt = std::numeric_limits<double>::infinity();
        d.restitution_min = 1;
        return d;
    }
    d.collision_time = d.critical_dt = d.recommended_dt = std::numeric_limits<double>::infinity();
    d.restitution_max = 0;
    const int order = order_of(scene.md.integrator);
    const std::vector<double> table = pair_table(scene);
    // Two of the lightest grains make the stiffest contact, two of the heaviest (or one on a wall) the
    // deepest.
    const double light = 0.5 * needs.mass_min, heavy = needs.mass_max;
    const double inertia = scene.md.inertia == scene::Inertia::disc ? 0.5 : 0.4;
    const auto scale = [&](const Coefficients& c, double mass, double radius) {
        return with_traits(scene,
                           [&](auto traits) { return traits.scale(c, mass, radius, scene.md.max_speed); });
    };
    const auto bound = [&](double critical, double recommended) {
        d.critical_dt = std::min(d.critical_dt, critical);
        d.recommended_dt = std::min(d.recommended_dt, recommended);
    };
    for (std::size_t p = 0; p < table.size(); p += laws::pair_coefficients) {
        const Coefficients c = laws::coefficients_from<double>(table.data() + p);
        const ContactScale fast = scale(c, light, 0.5 * needs.radius_min);
        const ContactScale deep = scale(c, heavy, needs.radius_max);
        d.collision_time = std::min(d.collision_time, fast.collision_time);
        bound(stable_phase(order, fast.damping_ratio) / fast.frequency, fast.half_swing / 50);
        d.restitution_min = std::min({d.restitution_min, fast.restitution, deep.restitution});
        d.restitution_max = std::max({d.restitution_max, fast.restitution, deep.restitution});
        d.overlap_ratio = std::max(d.overlap_ratio, deep.overlap / needs.radius_min);
        // Of two of the lightest grains.
        const double inertia_of_two = 0.5 * inertia * needs.mass_min * needs.radius_min * needs.radius_min;
        if (c.rolling_friction > 0 && c.rolling_damping > 0)
            bound(stable_damping(order) * inertia_of_two / c.rolling_damping,
                  0.15 * inertia_of_two / c.rolling_damping);
        if (c.rolling_friction > 0 && c.rolling_stiffness > 0) {
            const double frequency = std::sqrt(c.rolling_stiffness / inertia_of_two);
            const double ratio = c.rolling_damping / (2 * std::sqrt(c.rolling_stiffness * inertia_of_two));
            bound(stable_phase(order, ratio) / frequency, std::numbers::pi / frequency / 50);
        }
        if (!needs.friction || c.friction == 0) continue;
        const double tangential_mass = 1 / (2 / needs.mass_min * (1 + 1 / inertia)); // of two light grains
        if (c.tangential_damping > 0)
            bound(stable_damping(order) * tangential_mass / c.tangential_damping,
                  0.15 * tangential_mass / c.tangential_damping);
        if (has_spring(scene.md.tangential)) { // which swings at its own frequency
            const double frequency = std::sqrt(c.tangential_stiffness / tangential_mass);
            const double ratio =
                c.tangential_damping / (2 * std::sqrt(c.tangential_stiffness * tangential_mass));
            bound(stable_phase(order, ratio) / frequency, std::numbers::pi / frequency / 50);
        }
    }
    d.recommended_dt = std::min(d.recommended_dt, 0.25 * d.critical_dt);
    return d;
}

double contact_time_step(const Scene& scene, const Coefficients& c, double mass, double radius,
                         double overlap) {
    return with_traits(scene, [&](auto traits) {
        const double frequency = std::sqrt(traits.stiffness(c, radius, overlap) / mass);
        const double ratio = traits.damping(c, radius, overlap) / (2 * mass * frequency);
        return std::min(std::numbers::pi / 50, 0.25 * stable_phase(order_of(scene.md.integrator), ratio)) /
               frequency;
    });
}

// ---- the plan

namespace {

// Sites are numbered with 32 bits; around the domain there is a halo, and rows are padded.
constexpr double most_sites = 0x1p31, site_margin = 64;

// Site edges that divide the domain and keep dx^2 + dy^2 <= r_min^2, 2 R_max <= reach min(dx, dy) (items
// 2-6). Returns false if no reach up to 4 serves.
bool fit_lattice(const Scene& scene, const Needs& needs, Plan& plan) {
    const Vec size = plan.upper - plan.lower;
    const double edge = (2 - scene.md.delta) * needs.radius_min / std::numbers::sqrt2;
    const double columns = std::ceil(size.x / edge), rows = std::ceil(size.y / edge);
    if (!((columns + site_margin) * (rows + site_margin) < most_sites)) return false;
    plan.columns = static_cast<std::int32_t>(columns);
    plan.rows = static_cast<std::int32_t>(rows);
    plan.site_x = size.x / plan.columns;
    plan.site_y = size.y / plan.rows;
    for (plan.reach = 2; plan.reach <= 4; ++plan.reach)
        if (2 * needs.radius_max <= plan.reach * std::min(plan.site_x, plan.site_y)) break;
    const int least = 2 * plan.reach + 1;
    const bool wide_enough = (!scene.domain.periodic[0] || plan.columns >= least) &&
                             (!scene.domain.periodic[1] || plan.rows >= least);
    return plan.reach <= 4 && wide_enough;
}

void choose_neighbours(const Scene& scene, const Needs& needs, Plan& plan) {
    const NeighbourMethod wanted = scene.md.neighbours;
    const double ratio = needs.radius_min > 0 ? needs.radius_max / needs.radius_min : 1;
    const bool asks = wanted == NeighbourMethod::lattice || wanted == NeighbourMethod::lattice_half;
    if (asks && plan.dimension == 3)
        fail(Exit::invalid_input,
             "md.neighbours = \"lattice\": the lattice is of the plane, the domain has three dimensions; use "
             "\"auto\", \"verlet\" or \"link-cells\"");
    const bool fits = plan.dimension == 2 && needs.radius_max > 0 && fit_lattice(scene, needs, plan);
    if (asks && needs.radius_max > 0 && plan.columns == 0)
        fail(Exit::invalid_input,
             "md.neighbours = \"lattice\": the domain of {:.4g} x {:.4g} m would have more than {:.3g} "
             "sites, about {:.3g} m "
             "wide for the smallest radius. Shrink the domain, or use md.neighbours = \"auto\" or "
             "\"link-cells\".",
             plan.upper.x - plan.lower.x, plan.upper.y - plan.lower.y, most_sites, needs.radius_min);
    if (asks && needs.radius_max > 0 && !fits)
        fail(Exit::invalid_input,
             "md.neighbours = \"lattice\": radius ratio {:.4g} and domain do not suit the lattice; with "
             "delta = {} the "
             "9x9 mask serves ratios up to {:.4g} and a periodic side needs 2 reach + 1 sites (here {} x {} "
             "sites, "
             "reach {}). Use md.neighbours = \"auto\" or \"link-cells\".",
             ratio, scene.md.delta, lattice_ratio_bound(4, scene.md.delta), plan.columns, plan.rows,
             plan.reach);
    if (plan.memory > 0) {
        if (wanted != NeighbourMethod::automatic && wanted != NeighbourMethod::verlet)
            fail(Exit::invalid_input,
                 "md.neighbours = \"{}\": the contacts of md.normal = \"{}\" with md.tangential = \"{}\" "
                 "remember, which only lists of pairs can hold; use \"auto\" or \"verlet\"",
                 scene::neighbour_choices()[static_cast<std::size_t>(wanted)],
                 scene::normal_choices()[static_cast<std::size_t>(scene.md.normal)],
                 scene::tangential_choices()[static_cast<std::size_t>(scene.md.tangential)]);
        plan.neighbours = NeighbourMethod::verlet;
        plan.chosen.push_back("neighbours: Verlet lists, the contacts remember");
        return;
    }
    plan.neighbours = wanted;
    if (wanted != NeighbourMethod::automatic) {
        if (asks && needs.radius_max == 0) plan.neighbours = NeighbourMethod::brute_force;
        plan.chosen.push_back(
            asks ? fmt::format("neighbours: as asked for in md.neighbours, {0}x{0} mask; radius "
                               "ratio {1:.4g} <= {2:.4g}; link cells take over if two centres "
                               "meet in a site",
                               2 * plan.reach + 1, ratio, lattice_ratio_bound(plan.reach, scene.md.delta))
                 : "neighbours: as asked for in md.neighbours");
        return;
    }
    const bool sheared = scene.domain.shear_rate != 0; // only lists know the seam
    plan.neighbours = sheared ? NeighbourMethod::verlet : automatic_method(needs.grains + needs.poured);
    const bool small = plan.neighbours == NeighbourMethod::brute_force;
    plan.chosen.push_back(
        sheared ? "neighbours: Verlet lists, which alone follow a shear flow"
                : fmt::format("neighbours: {}; asked again every 256 steps: brute force for {} grains or "
                              "fewer, else Verlet lists, the fastest at any density",
                              small ? "brute force" : "Verlet lists", few_grains));
}

void note_skipped(const Scene& scene, const Needs& needs, Plan& plan) {
    const auto skip = [&](bool unused, const char* what) {
        if (unused) plan.skipped.emplace_back(what);
    };
    skip(!turns(plan),
         "rotation: no angle, spin or torque columns and kernels (no friction couples to spin)");
    skip(plan.dimension == 3 && turns(plan) && !plan.orientation, "orientations: nothing asks for them");
    skip(!plan.many_radii, "radii: one radius, the distance stage compares with a constant");
    skip(!plan.many_materials, "materials: one material, no gather of coefficients");
    skip(!plan.walls, "walls: none");
    skip(plan.walls && !needs.moving_walls, "wall motion: all walls are fixed");
    skip(!needs.gravity, "gravity: none");
    const std::array<bool, 3>& periodic = scene.domain.periodic;
    skip(!periodic[0] && !periodic[1] && !periodic[2], "periodic images: the domain is open");
    skip(plan.dimension == 2, "third dimension");
}

void check_time_step(const Scene& scene, const Derived& derived, double dt) {
    if (!(dt > derived.critical_dt)) return;
    fail(Exit::invalid_input,
         "md.dt = {:.4g} s is above the critical time step {:.4g} s of the stiffest contact with {} "
         "(allowed: 0 to that; "
         "recommended: {:.3g} s). Lower md.dt, leave it out, or soften the material.",
         dt, derived.critical_dt, integrator_name(scene.md.integrator), derived.recommended_dt);
}

} // namespace

Plan make_plan(const Scene& scene, const Needs& needs, const Derived& derived, simd::Isa isa,
               const ThreadChoice& threads) {
    Plan plan;
    plan.isa = isa;
    plan.threads = threads.count;
    std::string threads_reason = threads.reason;
    // Three fork-joins per step cost as much as this many grains; the number of threads changes no bit.
    const std::size_t grains_per_thread = 2000;
    const std::size_t useful = std::max<std::size_t>(1, (needs.grains + needs.poured) / grains_per_thread);
    if (threads.automatic && useful < static_cast<std::size_t>(threads.count)) {
        plan.threads = static_cast<int>(useful);
        threads_reason =
            fmt::format("of {} allowed: {} grains per thread at least", threads.count, grains_per_thread);
    }
    plan.dimension = static_cast<int>(scene.domain.dimension);
    plan.lower = scene.domain.lower;
    plan.upper = scene.domain.upper;
    plan.order = order_of(scene.md.integrator);
    plan.normal = static_cast<int>(scene.md.normal);
    const bool couples = needs.couples != laws::Couples::none;
    const bool turns =
        needs.friction || couples || needs.spinning || (plan.dimension == 2 && scene.domain.gravity.z != 0);
    plan.couples = needs.couples;
    plan.rotation = couples ? simd::Rotation::couples
                    : turns ? simd::Rotation::friction
                            : simd::Rotation::none;
    // Spins without friction: the law of fewest operations whose kernels have room for torques, which are
    // zero.
    const bool idle = couples || (plan.dimension == 3 && turns);
    const scene::TangentialLaw without =
        idle ? scene::TangentialLaw::haff_werner : scene::TangentialLaw::none;
    const bool as_asked = needs.friction || needs.couples == laws::Couples::sprung;
    plan.tangential = static_cast<int>(as_asked ? scene.md.tangential : without);
    plan.orientation = scene.md.orientation && turns;
    set_memory(plan);
    plan.many_materials = needs.many_materials;
    plan.many_radii = needs.many_radii;
    plan.walls = needs.walls;
    plan.inertia_factor = scene.md.inertia == scene::Inertia::disc ? 0.5 : 0.4;
    plan.dt = scene.md.dt > 0 ? scene.md.dt : derived.recommended_dt;
    if (!std::isfinite(plan.dt)) plan.dt = scene.md.duration > 0 ? scene.md.duration / 100 : 1e-3;
    check_time_step(scene, derived, plan.dt);
    if (scene.md.max_speed * plan.dt > 0.1 * needs.radius_min && needs.radius_min > 0)
        fail(Exit::invalid_input,
             "md.dt = {:.4g} s: a grain of md.max_speed = {} m/s moves {:.3g} m per step, more than 0.1 "
             "R_min = {:.3g} m; "
             "it could pass through a wall. Lower md.dt below {:.3g} s.",
             plan.dt, scene.md.max_speed, scene.md.max_speed * plan.dt, 0.1 * needs.radius_min,
             0.1 * needs.radius_min / scene.md.max_speed);
    if (scene.md.adaptive_dt) { // dt times 1/4, 1/3, 1/2, 2/3, 1, 4/3, 2 and 4
        plan.least_stride = 3;
        plan.stride = 12;
        plan.largest_stride = 48;
    }
    plan.tick = plan.dt / static_cast<double>(plan.stride);
    const double steps = scene.md.duration / plan.tick;
    if (!(steps <= 0x1p52))
        fail(
            Exit::invalid_input,
            "md.duration = {:.4g} s: {:.4g} steps of {:.4g} s; allowed: up to 4e15 steps. Lower md.duration.",
            scene.md.duration, steps, plan.tick);
    plan.steps = (std::llround(steps) + plan.largest_stride - 1) / plan.largest_stride * plan.largest_stride;
    choose_neighbours(scene, needs, plan);
    plan.chosen.insert(plan.chosen.begin(), fmt::format("kernels: {}; threads: {} ({})", simd::isa_name(isa),
                                                        plan.threads, threads_reason));
    plan.freeze =
        scene.md.freeze && plan.neighbours == NeighbourMethod::verlet && scene.domain.shear_rate == 0;
    if (scene.md.adaptive_dt)
        plan.chosen.push_back(fmt::format("time step: from {:.3g} to {:.3g} s, chosen every 256 steps or so "
                                          "from the stiffest contact and the fastest grain; steps are "
                                          "counted in units of {:.3g} s",
                                          static_cast<double>(plan.least_stride) * plan.tick,
                                          static_cast<double>(plan.largest_stride) * plan.tick, plan.tick));
    note_skipped(scene, needs, plan);
    return plan;
}

} // namespace sandlane::md
