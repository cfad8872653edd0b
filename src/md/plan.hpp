// What a scene needs, and which kernels serve it: decided once, printed by `sandlane check`, recorded in
// every output.
#pragma once

#include "core/parallel.hpp"
#include "laws/contact.hpp"
#include "motion/gear.hpp"
#include "scene/initial_state.hpp"
#include "scene/scene.hpp"
#include "scene/size_classes.hpp"
#include "simd/tables.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace sandlane::md {

// Requirements of the scene, independent of the machine.
struct Needs {
    std::size_t grains = 0, poured = 0;
    double radius_min = 0, radius_max = 0; // m
    double mass_min = 0, mass_max = 0;     // kg
    bool many_radii = false, many_materials = false, friction = false;
    bool memory = false; // contacts remember
    laws::Couples couples =
        laws::Couples::none;             // rolling friction, or lever arms to the plane of the contact
    std::vector<scene::SizeClass> sizes; // of radii, from the smallest up
    bool walls = false, moving_walls = false, gravity = false, spinning = false;
    double packing_fraction = 0; // grain area or volume over that of the domain
};

// Physics derived from the scene (docs/physics.md 3).
struct Derived {
    double collision_time = 0; // s, smallest over material pairs: pi/w0 or the viscoelastic t_c at max_speed
    double critical_dt = 0;    // s: stability bound of the integrator for the stiffest contact
    double recommended_dt = 0; // s: t_c/50, and less if damping asks for it
    double restitution_min = 1, restitution_max = 0; // over material pairs, at max_speed
    double overlap_ratio = 0;                        // largest xi_max/R_min at max_speed
    bool known = true; // contacts of all pairs of materials have a duration that is a number above 0
};

struct Plan {
    simd::Isa isa = simd::Isa::scalar;
    int threads = 1;
    scene::NeighbourMethod neighbours = scene::NeighbourMethod::link_cells; // never automatic
    int dimension = 2, order = 5; // values that the integrator stores
    int scheme = 5;               // of motion/gear.hpp
    bool resolved = false;        // contacts begin and end inside a step
    // Numbers that a contact remembers, and how many of them change sign when its partners are exchanged.
    int memory = 0, odd_memory = 0;
    simd::Rotation rotation = simd::Rotation::none;
    laws::Couples couples = laws::Couples::none;
    bool freeze = false;      // tiles of grains at rest are stepped over
    bool orientation = false; // 3D: followed for outputs
    bool many_materials = false, many_radii = false, walls = false;
    int normal = 0, tangential = 0; // positions in laws.def
    double inertia_factor = 0.5;    // J = c m R^2
    // Time is a number of steps times tick. The time step is dt = stride tick; stride is 1 but where the step
    // adapts: there it is a divisor of largest_stride, so that all steps meet at multiples of that.
    double tick = 0, dt = 0; // s
    std::int64_t steps = 0, stride = 1, base_stride = 1, least_stride = 1, largest_stride = 1;
    Vec lower, upper;
    // Lattice geometry (docs/physics.md 10).
    int reach = 2;
    std::int32_t columns = 0, rows = 0;
    double site_x = 0, site_y = 0;            // m
    std::vector<std::string> chosen, skipped; // one reason per line
};

// Scheme of motion/gear.hpp.
[[nodiscard]] constexpr int scheme_of(const scene::Md& md) {
    switch (md.integrator) {
    case scene::Integrator::gear4:
        return 4;
    case scene::Integrator::automatic:
    case scene::Integrator::gear5:
        return 5;
    case scene::Integrator::gear6:
        return 6;
    case scene::Integrator::velocity_verlet:
        return md.contact_onset == scene::ContactOnset::resolved ? motion::verlet_with_slope : 3;
    }
    return 5;
}

// As in a scene; the one that runs, for "auto" without md.accuracy.
[[nodiscard]] const char* integrator_name(scene::Integrator integrator);

// Why a scene has no kernels that resolve begin and end of contacts, and what to do; empty: it has.
[[nodiscard]] std::string why_not_resolved(const scene::Scene& scene, const Needs& needs);

// Laws whose contacts hold a spring.
[[nodiscard]] constexpr bool has_spring(scene::TangentialLaw law) {
    return law == scene::TangentialLaw::cundall_strack || law == scene::TangentialLaw::walton_braun;
}

// What md.dt says or derive() recommends, s; where the step adapts, it does so about this.
[[nodiscard]] constexpr double base_time_step(const Plan& plan) {
    return plan.tick * static_cast<double>(plan.base_stride);
}

[[nodiscard]] constexpr bool turns(const Plan& plan) {
    return plan.rotation != simd::Rotation::none;
}

[[nodiscard]] constexpr bool is_lattice(scene::NeighbourMethod method) {
    return method == scene::NeighbourMethod::lattice || method == scene::NeighbourMethod::lattice_half;
}

[[nodiscard]] Needs analyse(const scene::Scene& scene, const std::vector<scene::GrainState>& grains);
[[nodiscard]] Derived derive(const scene::Scene& scene, const Needs& needs);
// Time step that a contact of reduced mass [kg] and reduced radius [m] needs at this overlap [m], by the
// rules of derive.
[[nodiscard]] double contact_time_step(const scene::Scene& scene,
                                       const laws::PairCoefficients<double>& coefficients, double mass,
                                       double radius, double overlap);

// Throws Error(invalid_input) for a violated precondition of the method asked for (time step, polydispersity,
// periods).
[[nodiscard]] Plan make_plan(const scene::Scene& scene, const Needs& needs, const Derived& derived,
                             simd::Isa isa, const ThreadChoice& threads);

// Largest R_max/R_min that a mask of the given reach serves: reach (2 - delta)/(2 sqrt 2).
[[nodiscard]] double lattice_ratio_bound(int reach, double delta);

// Memory of the simulation, bytes.
[[nodiscard]] double memory_bytes(const Needs& needs, const Plan& plan);

// The text of `sandlane check`.
[[nodiscard]] std::string describe(const scene::Scene& scene, const Needs& needs, const Derived& derived,
                                   const Plan& plan);

// Mixed coefficients of all material pairs (docs/physics.md 5), laws::PairCoefficients
// [materials][materials].
[[nodiscard]] std::vector<double> pair_table(const scene::Scene& scene);

} // namespace sandlane::md
