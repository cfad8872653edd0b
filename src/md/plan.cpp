#include "md/plan.hpp"

#include "core/error.hpp"
#include "laws/contact.hpp"
#include "md/law_choice.hpp"
#include "scene/schema.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace sandlane::md {

using scene::NeighbourMethod;
using scene::Scene;

namespace {

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

const char* integrator_name(scene::Integrator integrator) {
    static const char* names[] = {"gear5", "gear4", "gear5", "gear6", "velocity-verlet"};
    return names[static_cast<int>(integrator)];
}

std::string why_not_resolved(const Scene& scene, const Needs& needs) {
    const int normal = static_cast<int>(scene.md.normal);
    const bool law =
        with_normal_law(normal, []<class Normal>(Type<Normal>) { return laws::can_resolve<Normal>; });
    if (!law)
        return fmt::format("not for md.normal = \"{}\" (allowed: linear-dashpot, viscoelastic); use \"step\"",
                           scene::normal_choices()[static_cast<std::size_t>(normal)]);
    if (needs.couples != laws::Couples::none)
        return "not with rolling friction or md.lever_arm = \"plane\"; use \"step\", or leave those out";
    const NeighbourMethod wanted = scene.md.neighbours;
    if (wanted != NeighbourMethod::automatic && wanted != NeighbourMethod::verlet)
        return fmt::format("needs md.neighbours = \"auto\" or \"verlet\" (here \"{}\")",
                           scene::neighbour_choices()[static_cast<std::size_t>(wanted)]);
    return {};
}

double lattice_ratio_bound(int reach, double delta) {
    return reach * (2 - delta) / (2 * std::numbers::sqrt2);
}

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
             "sites, about {:.3g} m wide for the smallest radius. Shrink the domain, or use md.neighbours = "
             "\"auto\" or \"link-cells\".",
             plan.upper.x - plan.lower.x, plan.upper.y - plan.lower.y, most_sites, needs.radius_min);
    if (asks && needs.radius_max > 0 && !fits)
        fail(Exit::invalid_input,
             "md.neighbours = \"lattice\": radius ratio {:.4g} and domain do not suit the lattice; with "
             "delta = {} the 9x9 mask serves ratios up to {:.4g} and a periodic side needs 2 reach + 1 "
             "sites (here {} x {} sites, reach {}). Use md.neighbours = \"auto\" or \"link-cells\".",
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
    // Measured to be the fastest from two grains on, at every density and at every speed that the guards let
    // pass (docs/performance.md): there is nothing to decide anew when a scene changes.
    plan.neighbours = NeighbourMethod::verlet;
    plan.chosen.emplace_back(
        "neighbours: Verlet lists, the fastest for any number, density and speed of grains");
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

void check_resolved(const Scene& scene, const Needs& needs) {
    if (const std::string why = why_not_resolved(scene, needs); !why.empty())
        fail(Exit::invalid_input, "md.contact_onset = \"resolved\": {}", why);
}

void check_time_step(const Scene& scene, const Needs& needs, const Derived& derived, double dt) {
    if (!derived.known)
        fail(
            Exit::invalid_input,
            "materials: a contact of two grains of {:.3g} kg has no duration that is a number: masses, radii and "
            "stiffness are so small or large that their products are beyond the range. Choose other units.",
            needs.mass_min);
    if (!(dt > derived.critical_dt)) return;
    fail(Exit::invalid_input,
         "md.dt = {:.4g} s is above the critical time step {:.4g} s of the stiffest contact with {} "
         "(allowed: 0 to that; recommended: {:.3g} s). Lower md.dt, leave it out, or soften the material.",
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
    plan.scheme = scheme_of(scene.md);
    plan.order = motion::values_of(plan.scheme);
    plan.resolved = scene.md.contact_onset == scene::ContactOnset::resolved;
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
    if (plan.resolved) check_resolved(scene, needs);
    plan.many_materials = needs.many_materials;
    plan.many_radii = needs.many_radii;
    plan.walls = needs.walls;
    plan.inertia_factor = scene.md.inertia == scene::Inertia::disc ? 0.5 : 0.4;
    plan.dt = scene.md.dt > 0 ? scene.md.dt : derived.recommended_dt;
    if (!std::isfinite(plan.dt)) plan.dt = scene.md.duration > 0 ? scene.md.duration / 100 : 1e-3;
    check_time_step(scene, needs, derived, plan.dt);
    if (scene.md.max_speed * plan.dt > 0.1 * needs.radius_min && needs.radius_min > 0)
        fail(Exit::invalid_input,
             "md.dt = {:.4g} s: a grain of md.max_speed = {} m/s moves {:.3g} m per step, more than 0.1 "
             "R_min = {:.3g} m; it could pass through a wall. Lower md.dt below {:.3g} s.",
             plan.dt, scene.md.max_speed, scene.md.max_speed * plan.dt, 0.1 * needs.radius_min,
             0.1 * needs.radius_min / scene.md.max_speed);
    if (scene.md.adaptive_dt) { // dt times 1/4, 1/3, 1/2, 2/3, 1, 4/3, 2 and 4
        plan.least_stride = 3;
        plan.stride = plan.base_stride = 12;
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
    if (scene.md.freeze && !plan.freeze)
        plan.chosen.emplace_back("tiles at rest: not stepped over, md.freeze needs lists and no shear flow");
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
