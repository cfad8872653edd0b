// The scene: what a TOML file says, as plain validated structs. Lengths in m, masses in kg, times in s,
// angles in rad. The schema declares every key once (type, unit, default, range, documentation) by pointing
// at these members.
#pragma once

#include "core/vec.hpp"
#include "scene/automata.hpp"
#include "scene/gas.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace sandlane::scene {

// What runs a scene: the value of `method`.
enum class Engine {
#define ENGINE(choice, name, what) choice,
#include "scene/engines.def"
};

class EngineSet {
public:
    constexpr EngineSet(Engine engine) : bits_(1U << static_cast<unsigned>(engine)) {} // NOLINT: md | edmd
    [[nodiscard]] constexpr bool contains(Engine engine) const {
        return (bits_ >> static_cast<unsigned>(engine) & 1U) != 0;
    }
    friend constexpr EngineSet operator|(EngineSet a, EngineSet b) { return EngineSet(a.bits_ | b.bits_); }
    [[nodiscard]] static constexpr EngineSet all() { return EngineSet(~0U); }

private:
    constexpr explicit EngineSet(unsigned bits) : bits_(bits) {}
    unsigned bits_;
};
constexpr EngineSet operator|(Engine a, Engine b) {
    return EngineSet(a) | EngineSet(b);
}
inline constexpr EngineSet every_engine = EngineSet::all();

enum class NormalLaw {
#define NORMAL(type, choice, name, key) choice,
#include "laws/laws.def"
};
enum class TangentialLaw {
#define TANGENTIAL(type, choice, name) choice,
#include "laws/laws.def"
};
enum class Integrator { automatic, gear4, gear5, gear6, velocity_verlet };
enum class ContactOnset { automatic, step, resolved }; // begin and end of a contact: at a step, or inside it
enum class NeighbourMethod { automatic, brute_force, link_cells, lattice, lattice_half, verlet };
enum class Inertia { disc, sphere }; // J = m R^2/2 or 2/5 m R^2 (docs/physics.md 1)
enum class Body { sphere, disc };    // mass of a grain: 4/3 pi R^3 rho, or pi R^2 rho (per metre of depth)
enum class LeverArm {
    undeformed,
    plane
};                                    // R, or the distance to the plane of the contact (docs/physics.md 2)
enum class Outside { error, remove }; // what happens to a grain that leaves an open side of the domain
enum class GrainKind { lattice, random, pour, factory, list, file };
enum class SizeLaw { constant, uniform, inverse_square, lognormal };
// plane, segment, polyline, arc, grains: 2D; plane, box, cylinder, cone, mesh: 3D.
enum class WallKind { plane, segment, polyline, arc, grains, box, cylinder, cone, mesh };
enum class MotionKind { fixed, linear, oscillate, rotate, planetary };
enum class Wave { sine, cosine };
enum class Trajectory { dump, xyz, vtp, book };
enum class Colour { speed, pressure, spin, radius };

struct Domain {
    std::int64_t dimension = 2; // 2 or 3
    Vec lower, upper{1, 1, 0};
    std::array<bool, 3> periodic{};
    Vec gravity; // 2D: z is the angular acceleration G_phi of the book's files
    Outside outside = Outside::remove;
    double shear_rate = 0; // 1/s: Lees-Edwards, d v_x/d y of the periodic images
};

// One material; a law reads only its own coefficients. Mixing rules: docs/physics.md 5.
struct Material {
    std::string name;
    double density = 2500;           // kg/m^3 (body = "disc": kg/m^3 times one metre of depth)
    double stiffness = 0;            // k, N/m: linear dashpot; Walton-Braun: Y_l of loading
    double unloading_stiffness = 0;  // Y_u, N/m: Walton-Braun
    double damping = 0;              // gamma, kg/s: linear dashpot
    double young = 0;                // Y, Pa: viscoelastic
    double poisson = 0.3;            // nu
    double dissipation = 0;          // A, s: viscoelastic
    double friction = 0;             // mu
    double tangential_damping = 0;   // gamma_t, kg/s: Haff-Werner, Cundall-Strack
    double tangential_stiffness = 0; // k_t, N/m: Cundall-Strack; k_0: Walton-Braun
    double cohesion = 0;             // Pa: cohesive viscoelastic, pull over area of contact
    double rolling_friction = 0;     // mu_r: couple over R_eff f_n, at most
    double rolling_damping = 0;      // gamma_r, N m s: couple over the rate of rolling
    double rolling_stiffness = 0;    // k_r, N m: couple over the angle of rolling
};

// Overrides the mixing rules for one pair of materials; negative: keep the rule.
struct MaterialPair {
    std::string first, second;
    double stiffness = -1, unloading_stiffness = -1, damping = -1;
    double young = -1,
           dissipation = -1; // young: Y/(1-nu^2) of the pair, so that K = (4/3) sqrt(R_eff) * young / 2
    double friction = -1, tangential_damping = -1, tangential_stiffness = -1;
    double cohesion = -1, rolling_friction = -1, rolling_damping = -1, rolling_stiffness = -1;
};

// R from one uniform number per grain: constant = radius_min; uniform in [min, max]; inverse_square: pdf ~
// 1/R^2; lognormal with median sqrt(min max), cut at min and max (two standard deviations).
struct Sizes {
    SizeLaw law = SizeLaw::constant;
    double min = 0, max = 0;
};

// One grain given explicitly ([[grains.items]]).
struct GrainItem {
    Vec position, velocity;
    double radius = 0, omega = 0;
    double angle = 0;
    double mass = 0;        // 0: from the density
    Vec angular_velocity{}; // 3D, instead of omega
};

// A population of free grains.
struct Grains {
    std::string name;
    std::string material; // empty: the only material
    GrainKind kind = GrainKind::lattice;
    Sizes sizes;
    Vec lower, upper; // region of centres (lattice: lower is the first centre); default: the domain
    std::vector<std::int64_t> counts{0, 0, 1}; // lattice: columns, rows, layers
    Vec spacing;                               // lattice: distance of neighbouring centres
    bool triangular = false;                   // 2D lattice: every second row is shifted by half a column
    bool staggered = false;                    // 3D lattice: every second layer is shifted along x and y
    double jitter = 0;                         // lattice: uniform displacement in units of the spacing
    std::int64_t count = 0;                    // random, pour: number of grains
    double packing_fraction = 0;               // random: used when count = 0
    double start = 0;                          // pour: first insertion, s
    double rate = 0;                           // pour: grains per second
    Vec velocity;                              // common initial velocity
    double thermal_speed = 0;                  // standard deviation of each velocity component
    double omega = 0;                          // initial spin, rad/s
    Vec angular_velocity{};                    // 3D: initial spin, rad/s
    double density = 0;                        // > 0 overrides the material's density
    std::string file;                          // file: CSV, or the book's 25-column format
    std::vector<GrainItem> items;
};

// Grains whose centres lie in a box when it is looked at, every 256 steps, are removed and counted.
struct Sink {
    std::string name;
    Vec lower, upper;
    double start = 0; // s
};

// A wall; several elements of one wall share material and motion.
struct Wall {
    std::string name;
    std::string material;
    std::string motion; // name of a [[motions]] entry; empty: fixed
    WallKind kind = WallKind::segment;
    std::vector<Vec>
        points; // plane: one point; segment: two; polyline: two or more; grains: end points of the row
    bool closed = false; // polyline: joins the last point to the first
    Vec normal;          // plane: points into the free side
    // 3D: box: two corners in points, its six faces act on the inside; cylinder, cone: ends of the axis in
    // points, radius at the first end and radius_to at the second (cone), a surface of both sides; closed
    // adds the end faces; mesh: triangles of an STL file, scaled, then moved by centre, acting on both sides.
    double radius_to = 0, scale = 1;
    std::string file;
    Vec centre;                                          // arc, and grains on an arc
    double radius = 0;                                   // arc radius; grains: radius of the wall grains
    double ring_radius = 0;                              // grains: > 0 puts them on a circle around centre
    double angle_from = 0, angle_to = 6.283185307179586; // arc and ring, counter-clockwise
    double spacing = 0;                                  // grains: distance of centres (0: 2 R)
    std::vector<GrainItem> items; // grains: explicit wall grains instead of a row or ring
    double omega = 0;             // grains: surface spin of each wall grain in addition to the motion
};

// Named prescribed motion of walls, a rigid transformation that is a function of absolute time
// (docs/physics.md 6).
struct Motion {
    std::string name;
    MotionKind kind = MotionKind::fixed;
    Vec velocity;     // linear
    Vec amplitude;    // oscillate: displacement = amplitude * wave(omega t + phase)
    double omega = 0; // oscillate, rotate: rad/s; planetary: spin of the drum
    double phase = 0;
    Wave wave = Wave::sine;
    Vec centre;                               // rotate, planetary: pivot at t = 0
    Vec axis{0, 0, 1};                        // 3D: rotate, planetary: direction of omega
    double orbit_radius = 0, orbit_omega = 0; // planetary
    double start = 0;                         // reference time t_0 of the given positions, s
};

struct Md {
    NormalLaw normal = NormalLaw::viscoelastic;
    TangentialLaw tangential = TangentialLaw::haff_werner;
    Integrator integrator = Integrator::automatic;        // gear5, or what accuracy asks for
    ContactOnset contact_onset = ContactOnset::automatic; // step, or what accuracy asks for
    NeighbourMethod neighbours = NeighbourMethod::automatic;
    double dt = 0;       // 0: t_c/50 at max_speed, or what accuracy asks for
    double accuracy = 0; // largest error of a collision; 0: not asked for
    bool adaptive_dt = false;
    double duration = 0;
    double max_speed = 1; // m/s: expected largest impact speed, for t_c of the viscoelastic law
    double delta = 0.1;   // lattice: largest overlap in units of the smaller radius
    Inertia inertia = Inertia::disc;
    Body body = Body::sphere;
    bool cut = true; // normal forces end at zero: contacts do not pull
    LeverArm lever_arm = LeverArm::undeformed;
    bool freeze = false;      // steps over grains at rest
    bool orientation = false; // 3D: follows the orientations of the grains
};

// Limits of one error that a run watches; 0: none.
struct WatchLimit {
    bool asked = false; // measured and logged
    double warn = 0, stop = 0;
};

// The errors that a run of grains watches of itself (docs/physics.md 14).
struct Watch {
    WatchLimit overlap;       // of the smaller radius
    WatchLimit energy;        // of the balance of energy
    WatchLimit momentum;      // of the balance of momentum
    WatchLimit step;          // of a collision, by halving the step
    std::int64_t sample = 64; // contacts that `step` looks at
};

enum class Axis { x, y, z };
enum class AnalysisKind {
#define ANALYSIS(name, choice) name,
#include "scene/analyses.def"
};

// Which grains are the first population of two: those of the lower half along `axis` in the first frame, of
// the material that comes first in the scene, or the smaller ones.
enum class Populations { sides, materials, sizes };

// One [[analysis]]; a kind reads only its own keys.
struct AnalysisSpec {
    std::string name;
    AnalysisKind kind = AnalysisKind::profile;
    double every = 0; // s; 0: duration/100
    double start = 0; // s: frames before it are left out
    Vec from, to; // flow: ends of the line; else: corners of the region, the domain where they are the same
    Axis axis = Axis::y;   // profile; 3D map: viewing direction; mixing: across the sides
    std::int64_t bins = 0; // 0: chosen by the kind
    double range = 0;      // pair-correlation: largest distance, m; 0: half the shorter side
    double threshold = 1;  // force-chains, map: in units of the mean pressure
    Populations populations = Populations::sides; // mixing
};

struct Output {
    double log_every = 0;        // s; 0: duration/200
    double picture_every = 0;    // s; 0: duration/20, negative: none
    double trajectory_every = 0; // s; 0: duration/100, negative: none
    double checkpoint_every = 0; // s; 0: only at the end and when stopped
    std::vector<Trajectory> trajectory{Trajectory::dump};
    Colour colour = Colour::speed;
    std::int64_t picture_width = 800; // pixels
    Vec view;                         // 3D: direction to the viewer of pictures; 0: chosen by gravity
    bool movie = true;
    bool report = true;
};

struct Scene {
    std::string title;
    std::string description;
    Engine method = Engine::md;
    std::int64_t seed = 1;
    Domain domain;
    std::vector<Material> materials;
    std::vector<MaterialPair> pairs;
    std::vector<Grains> grains;
    std::vector<Wall> walls;
    std::vector<Sink> sinks;
    std::vector<Motion> motions;
    Md md;
    Sandpile sandpile;
    Heap heap;
    Ripples ripples;
    LatticeGas lattice_gas;
    std::vector<Obstacle> obstacles;
    PipeFlow pipe_flow;
    Gas gas;
    std::vector<GasSide> sides;
    std::vector<CurvedWall> curved_walls;
    Dsmc dsmc;
    std::vector<Species> species;
    std::vector<GasPair> gas_pairs;
    Edmd edmd;
    Watch watch;
    std::vector<AnalysisSpec> analyses;
    Output output;
};

} // namespace sandlane::scene
