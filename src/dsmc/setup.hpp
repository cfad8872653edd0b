// What a simulation of a gas is made of: box, cells, particles, collisions, time step.
#pragma once

#include "analysis/gas_samples.hpp"
#include "dsmc/walls.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace sandlane::dsmc {

// Particles of another mass or diameter than the first ones.
struct Kind {
    double mass = 1, diameter = 1; // kg, m
    double fraction = 0;           // of all particles
};

// What two kinds have instead of the restitution of the gas; the model is the same.
struct PairRestitution {
    std::size_t first = 0, second = 0;
    double eps = 1, dissipation = 0;
};

struct Setup {
    int dimension = 3;                                 // of the velocities; cells may be one in a direction
    double lower[3] = {0, 0, 0}, upper[3] = {1, 1, 1}; // m; in the plane the third direction is one metre
    std::int32_t cells[3] = {1, 1, 1};
    simd::GasWalls walls; // sides; box, radius and inertia are filled in
    double gravity[3] = {0, 0, 0};
    double shear = 0;                   // d u_x/d y of a flow without ends (Lees and Edwards), 1/s
    double mass = 1, diameter = 1;      // of the first kind, kg, m
    std::vector<Kind> others;           // kinds 1 and so on
    std::vector<PairRestitution> pairs; // that are not as the gas
    double weight = 1;                  // real particles that one stands for
    bool rough = false;
    double tangential = 1, friction = 0; // rough: eps_t, mu
    double inertia = 0.4;                // rough: J = inertia m R^2
    laws::Restitution restitution;
    laws::CollisionScheme scheme = laws::CollisionScheme::no_time_counter;
    bool enskog = false;
    std::int32_t partners = 1; // of which the nearest is taken
    double dt = 0;             // s
    bool adaptive = false;     // dt grows as 1/sqrt(T)
    double kicks = 0;          // white noise xi^2 of each velocity component, m^2/s^3
    double margin = 1.1;       // of the majorant
    std::uint64_t seed = 1;

    // Of the flow at a height, m/s.
    [[nodiscard]] double flow(double y) const { return shear * (y - 0.5 * (lower[1] + upper[1])); }
    [[nodiscard]] double volume() const; // m^3, m^2 in the plane
    [[nodiscard]] double cell_volume() const;
    [[nodiscard]] double cross_section() const;   // pi s^2, 2 s of the largest kind
    [[nodiscard]] double particle_volume() const; // mean of the kinds
    [[nodiscard]] std::size_t kinds() const { return 1 + others.size(); }
    [[nodiscard]] Kind kind(std::size_t k) const;
    [[nodiscard]] laws::Restitution restitution_of(std::size_t i, std::size_t j) const;
    [[nodiscard]] double edge(int d) const { return (upper[d] - lower[d]) / cells[d]; }
};

struct Particle {
    std::uint32_t id = 0, kind = 0;
    std::array<double, 3> place{}, velocity{}, spin{};
    std::array<std::int32_t, 3> image{};
};

// Uniform places and a Maxwellian of temperature T [J] without mean velocity, scaled to T exactly; spins of
// temperature T_spin. Stream 5 of the specification.
// Of kinds in their order, by their fractions.
[[nodiscard]] std::vector<Particle> maxwellian(const Setup& setup, std::uint32_t count, double temperature,
                                               double spin_temperature = 0);

// What pairs of kinds do in the kernels.
[[nodiscard]] simd::GasMixture mixture_of(const Setup& setup);

// What frames of this gas are taken of.
[[nodiscard]] analysis::GasFrame frame_of(const Setup& setup);
// Where the particles are at a time.
[[nodiscard]] analysis::GasVessel vessel_of(const Setup& setup, double time);

// Numbers of the gas at density n F and temperature T [J], dilute or after Enskog.
struct Scales {
    double density = 0;        // real particles per volume
    double packing = 0;        // their volume fraction
    double correlation = 1;    // g2
    double speed = 0;          // mean thermal speed, m/s
    double collision_rate = 0; // per particle, 1/s
    double free_path = 0;      // m
    double cooling = 0;        // zeta, 1/s, of the restitution at the mean square normal speed
};
[[nodiscard]] Scales scales(const Setup& setup, std::size_t particles, double temperature);

// Criteria of the method that the setup does not meet (specification 4.3), one sentence each.
[[nodiscard]] std::vector<std::string> warnings(const Setup& setup, std::size_t particles, double temperature,
                                                double drift = 0);

} // namespace sandlane::dsmc
