// The tables of a scene that describe a gas of hard particles, and how direct simulation Monte Carlo and
// event-driven dynamics run it.
#pragma once

#include "core/vec.hpp"
#include "laws/collision.hpp"

#include <array>
#include <cstdint>

namespace sandlane::scene {

enum class RestitutionModel { constant, viscoelastic, saturating };
enum class GasBody { sphere, disc, hollow_sphere, ring }; // J = q m R^2, q = 2/5, 1/2, 2/3, 1
enum class GasAxis { x, y, z };

struct Gas {
    std::int64_t particles = 0;
    double temperature = 0;        // J: m <v^2> per component at the start
    double mass = 1, diameter = 1; // kg, m
    double weight = 1;             // real particles that one stands for
    RestitutionModel model = RestitutionModel::constant;
    double restitution = 1;            // constant; saturating: of fast impacts
    double dissipation = 0;            // viscoelastic: A rho^{2/5}, (s/m)^{1/5}
    double critical_speed = 1;         // saturating: restitution is reached here, m/s
    double exponent = 0.2;             // saturating
    double tangential_restitution = 1; // 1: smooth
    double friction = 0;               // bounds it; 0: does not
    GasBody body = GasBody::sphere;    // rough particles
    double spin_temperature = 0;       // J: of the spins at the start
};

enum class SideKind { reflecting, heated };
enum class SideName { lower_x, upper_x, lower_y, upper_y, lower_z, upper_z };

// A side of the domain that is not periodic. Those that no [[sides]] names reflect elastically.
struct GasSide {
    SideName side = SideName::lower_x;
    SideKind kind = SideKind::reflecting;
    double restitution = 1, tangential_restitution = 1;
    double temperature = 0;   // J, heated
    double accommodation = 1; // heated
    Vec velocity;             // along the wall, m/s
    double amplitude = 0;     // m: oscillates along its normal
    double frequency = 0;     // 1/s
    double phase = 0;         // rad
    double speed = 0;         // along its normal, towards the gas, m/s
};

// A sphere (a circle in the plane) or a cylinder that encloses the gas, or stands in it.
enum class CurvedShape { sphere, cylinder };
enum class CurvedGas { inside, outside };
struct CurvedWall {
    CurvedShape shape = CurvedShape::sphere;
    CurvedGas gas = CurvedGas::inside;
    Vec center;
    double radius = 0;
    GasAxis axis = GasAxis::z; // of a cylinder
    SideKind kind = SideKind::reflecting;
    double restitution = 1, tangential_restitution = 1;
    double temperature = 0, accommodation = 1; // heated
};

using laws::CollisionScheme;

struct Dsmc {
    std::array<std::int64_t, 3> cells{}; // 0: chosen
    CollisionScheme scheme = CollisionScheme::no_time_counter;
    bool enskog = false;
    std::int64_t near_partners = 1;
    double dt = 0; // s; 0: chosen
    bool adaptive = false;
    double duration = 0;
    double heating = 0;                        // m^2/s^3: white noise xi^2 of each velocity component
    double sample_every = 0, sample_start = 0; // s
    GasAxis profile_axis = GasAxis::x;
    std::int64_t profile_bins = 0; // 0: the cells along it
    double structure_every = 0;    // s; 0: never
    double cluster_reach = 1.2;
};

// Hard particles of another size or mass beside those of the gas.
struct Species {
    std::int64_t particles = 0;
    double mass = 1, diameter = 1; // kg, m
};

// Restitution of two kinds: 0 are the particles of [gas], n those of the n-th [[species]].
struct GasPair {
    std::array<std::int64_t, 2> between{};
    double restitution = 1; // as that of the gas, where the model has one
    double dissipation = 0; // viscoelastic
};

enum class EventAlgorithm { automatic, improved, simple };
enum class EventStart { automatic, random, lattice, growth };
enum class EventSpacing { time, log_time, events };

struct Edmd {
    EventAlgorithm algorithm = EventAlgorithm::automatic;
    double duration = 0;
    std::int64_t events = 0; // the run ends after so many; 0: only by its duration
    std::int64_t replicas = 1;
    EventStart start = EventStart::automatic;
    double growth_rate = 0.05;                // of radii, in units of the thermal speed
    double heating = 0, heating_interval = 0; // white noise xi^2, m^2/s^3; s between kicks, 0: chosen
    double contact_time = 0;                  // s: sooner collisions are elastic
    double elastic_speed = 0;                 // m/s: slower impacts are elastic
    double cell_edge = 0;                     // m; 0: chosen
    EventSpacing output_spacing = EventSpacing::time;
    double sample_every = 0, sample_start = 0; // s
    GasAxis profile_axis = GasAxis::x;
    std::int64_t profile_bins = 20;
    double structure_every = 0; // s; 0: never
    double cluster_reach = 1.2;
};

} // namespace sandlane::scene
