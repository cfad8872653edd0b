// The keys of everything but grains, walls and motions.
#include "scene/fields.hpp"
#include "scene/space.hpp"

namespace sandlane::scene {

namespace {

Choices axis_choices(std::int64_t dimension) {
    Choices names;
    for (const AxisOfSpace& axis : axes(dimension)) names.emplace_back(axis.name);
    return names;
}

void read_periodic(Domain& d, const Value& v, const std::string& path, std::int64_t dimension) {
    if (v.kind != Value::Kind::array)
        fail_at(v, path, "must be a list of axes, for example [\"x\", \"y\"] or []");
    d.periodic = {};
    for (const Value& axis : v.items)
        d.periodic[static_cast<std::size_t>(read_choice(axis, path, axis_choices(dimension)))] = true;
}

std::string write_periodic(const Domain& d, std::int64_t dimension) {
    std::vector<std::string> names;
    for (const AxisOfSpace& axis : axes(dimension))
        if (d.periodic[axis.index]) names.push_back(quoted(axis.name));
    return joined(names);
}

// "md: force-based molecular dynamics; ..."
std::string engines_explained() {
    const std::vector<std::string> lines = {
#define ENGINE(choice, name, what) std::string(name) + ": " + (what),
#include "scene/engines.def"
    };
    return fmt::format("{}", fmt::join(lines, "; "));
}

} // namespace

const Choices& engine_choices() {
    static const Choices choices = {
#define ENGINE(choice, name, what) name,
#include "scene/engines.def"
    };
    return choices;
}

const Choices& normal_choices() {
    static const Choices choices = {
#define NORMAL(type, choice, name, key) name,
#include "laws/laws.def"
    };
    return choices;
}

const Choices& tangential_choices() {
    static const Choices choices = {
#define TANGENTIAL(type, choice, name) name,
#include "laws/laws.def"
    };
    return choices;
}

const Choices& neighbour_choices() {
    static const Choices choices = {"auto", "brute-force", "link-cells", "lattice", "lattice-half", "verlet"};
    return choices;
}

const Choices& colour_choices() {
    static const Choices choices = {"speed", "pressure", "spin", "radius"};
    return choices;
}

const Choices& trajectory_choices() {
    static const Choices choices = {"dump", "xyz", "vtp", "book"};
    return choices;
}

const Table<Scene>& scene_table() {
    static const Table<Scene> table =
        Table<Scene>("Keys outside any table.")
            .text("title", &Scene::title, "shown in pictures and reports")
            .text("description", &Scene::description, "shown in the report")
            .choice("method", &Scene::method, engine_choices(), "engine: " + engines_explained())
            .integer("seed", &Scene::seed, between(0, 9e15),
                     "seed of all random numbers; the same seed gives the same scene");
    return table;
}

const Table<Domain>& domain_table() {
    static const Table<Domain> table =
        Table<Domain>("The rectangle, in three dimensions the box, that holds everything. Its sides are open "
                      "or periodic; they are no walls.")
            .integer("dimension", &Domain::dimension, dimensions,
                     "2: discs or spheres that stay in a plane; 3: spheres in space")
            .vector("lower", &Domain::lower, Unit::length, "lower left corner: the smallest coordinates")
            .vector("upper", &Domain::upper, Unit::length, "upper right corner: the largest coordinates")
            .required()
            .custom({"periodic", "list of `\"x\"`, `\"y\"`", "", "",
                     "directions in which a grain that leaves comes back on the other side", false,
                     read_periodic, write_periodic, "list of `\"x\"`, `\"y\"`, `\"z\"`"})
            .vector("gravity", &Domain::gravity, Unit::acceleration, "acceleration of gravity")
            .number(
                "shear_rate", &Domain::shear_rate, Unit::rate, any,
                "shear flow without walls (Lees and Edwards): d v_x/d y of the images beyond the periodic y "
                "sides; the grains start with this profile added to their velocities, zero in the middle")
            .choice(
                "outside", &Domain::outside, {"error", "remove"},
                "a grain whose centre leaves through an open side ends the run, or is removed and counted");
    return table;
}

const Table<Material>& material_table() {
    static const Table<Material> table =
        Table<Material>(
            "Materials of grains and walls. A law reads only its own coefficients: the linear dashpot "
            "stiffness and damping, the viscoelastic laws young, poisson and dissipation, Walton and Braun's "
            "stiffness and unloading_stiffness.")
            .text("name", &Material::name, "referred to by grains and walls")
            .required()
            .number("density", &Material::density, Unit::density, positive(),
                    "density (body = \"disc\": times one metre of depth)")
            .number("stiffness", &Material::stiffness, Unit::stiffness, not_negative(),
                    "spring constant k (linear dashpot), or Y_l of loading (Walton-Braun)")
            .number("unloading_stiffness", &Material::unloading_stiffness, Unit::stiffness, not_negative(),
                    "spring constant Y_u of unloading, stiffness or more (Walton-Braun); the restitution "
                    "coefficient is sqrt(stiffness/unloading_stiffness)")
            .number("damping", &Material::damping, Unit::damping, not_negative(),
                    "damping constant gamma (linear dashpot)")
            .number("young", &Material::young, Unit::pressure, not_negative(),
                    "Young's modulus Y (viscoelastic)")
            .number("poisson", &Material::poisson, Unit::none, between(-0.99, 0.5),
                    "Poisson ratio (viscoelastic)")
            .number("dissipation", &Material::dissipation, Unit::time, not_negative(),
                    "dissipative constant A (viscoelastic)")
            .number("friction", &Material::friction, Unit::none, not_negative(),
                    "Coulomb friction coefficient mu of the tangential laws")
            .number("tangential_damping", &Material::tangential_damping, Unit::damping, not_negative(),
                    "tangential damping constant gamma_t (Haff-Werner: 0 is no friction; Cundall-Strack: "
                    "beside the spring)")
            .number("tangential_stiffness", &Material::tangential_stiffness, Unit::stiffness, not_negative(),
                    "tangential spring constant k_t (Cundall-Strack), or k_0 (Walton-Braun)")
            .number("cohesion", &Material::cohesion, Unit::pressure, not_negative(),
                    "pull over the area of contact 4 pi R_eff xi (cohesive-viscoelastic)")
            .number("rolling_friction", &Material::rolling_friction, Unit::none, not_negative(),
                    "coefficient mu_r: the couple against rolling is at most mu_r R_eff f_n; needs "
                    "rolling_damping or rolling_stiffness, and a tangential law")
            .number("rolling_damping", &Material::rolling_damping, Unit::rolling_damping, not_negative(),
                    "couple against slow rolling over its rate, gamma_r")
            .number("rolling_stiffness", &Material::rolling_stiffness, Unit::rolling_stiffness,
                    not_negative(),
                    "couple against rolling over its angle, k_r: grains stand still below mu_r; needs a "
                    "tangential law with a spring");
    return table;
}

const Table<MaterialPair>& pair_table() {
    static const Table<MaterialPair> table =
        Table<MaterialPair>(
            "Overrides the mixing rules for one pair of materials; negative values keep the rule.")
            .text("first", &MaterialPair::first, "a material")
            .required()
            .text("second", &MaterialPair::second, "a material")
            .required()
            .number("stiffness", &MaterialPair::stiffness, Unit::stiffness, any, "k or Y_l of the pair")
            .number("unloading_stiffness", &MaterialPair::unloading_stiffness, Unit::stiffness, any,
                    "Y_u of the pair")
            .number("damping", &MaterialPair::damping, Unit::damping, any, "gamma of the pair")
            .number("young", &MaterialPair::young, Unit::pressure, any, "Y/(1 - nu^2) of two equal partners")
            .number("dissipation", &MaterialPair::dissipation, Unit::time, any, "A of the pair")
            .number("friction", &MaterialPair::friction, Unit::none, any, "mu of the pair")
            .number("tangential_damping", &MaterialPair::tangential_damping, Unit::damping, any,
                    "gamma_t of the pair")
            .number("tangential_stiffness", &MaterialPair::tangential_stiffness, Unit::stiffness, any,
                    "k_t of the pair")
            .number("cohesion", &MaterialPair::cohesion, Unit::pressure, any, "cohesion of the pair")
            .number("rolling_friction", &MaterialPair::rolling_friction, Unit::none, any, "mu_r of the pair")
            .number("rolling_damping", &MaterialPair::rolling_damping, Unit::rolling_damping, any,
                    "gamma_r of the pair")
            .number("rolling_stiffness", &MaterialPair::rolling_stiffness, Unit::rolling_stiffness, any,
                    "k_r of the pair");
    return table;
}

const Table<Md>& md_table() {
    static const Table<Md> table =
        Table<Md>(
            "Force-based molecular dynamics. `neighbours = \"auto\"` picks the method of finding pairs that "
            "suits the scene, and says why in the plan; all methods give the same contacts.")
            .choice("normal", &Md::normal, normal_choices(),
                    "normal force: spring and dashpot; viscoelastic spheres (Hertz), also with cohesion; "
                    "springs of loading and unloading (Walton and Braun)")
            .flag("cut", &Md::cut,
                  "normal forces of dashpots end at zero; false: a contact pulls until its overlap is gone")
            .choice(
                "lever_arm", &Md::lever_arm, {"undeformed", "plane"},
                "lever arm of tangential forces: the radius, or the distance to the plane of the contact, "
                "which conserves the angular momentum of pairs")
            .flag("orientation", &Md::orientation,
                  "follows the orientations of the grains, as quaternions in trajectories that have them; no "
                  "force depends on them")
            .only(3, "the angle of the grains, which is always followed with friction")
            .flag(
                "freeze", &Md::freeze,
                "steps over regions in which nothing moves to the last bit; changes no result. With lists of "
                "pairs and without shear_rate")
            .choice("tangential", &Md::tangential, tangential_choices(), "tangential force")
            .choice("integrator", &Md::integrator, {"auto", "gear4", "gear5", "gear6", "velocity-verlet"},
                    "Gear predictor-corrector with 4, 5 or 6 values, or velocity Verlet; \"auto\": gear5, or "
                    "chosen by accuracy")
            .choice("contact_onset", &Md::contact_onset, {"auto", "step", "resolved"},
                    "contacts begin and end at a step, or at their moments inside it, to second order: for "
                    "linear-dashpot and viscoelastic, best with velocity-verlet")
            .choice("neighbours", &Md::neighbours, neighbour_choices(), "pair finding")
            .number("dt", &Md::dt, Unit::time, not_negative(),
                    "time step; 0: chosen from the stiffest contact (t_c/50), or by accuracy")
            .number(
                "accuracy", &Md::accuracy, Unit::none, between(0, 0.1),
                "largest error of a collision at max_speed, of its restitution coefficient (relative) and "
                "of its energy (of that of the impact): integrator and time step are the cheapest that "
                "meet it; 1e-8 or more, 0: not asked for")
            .flag("adaptive_dt", &Md::adaptive_dt,
                  "the time step follows the stiffest contact, from dt/4 to 4 dt, chosen every 256 steps or "
                  "so; steps are counted in twelfths of dt")
            .number("duration", &Md::duration, Unit::time, not_negative(), "simulated time; 0: no steps")
            .number("max_speed", &Md::max_speed, Unit::speed, positive(),
                    "largest impact speed expected; the time step is derived from it")
            .number("delta", &Md::delta, Unit::none, between(0, 0.9),
                    "lattice: largest overlap in units of the smaller radius")
            .only(2)
            .choice("inertia", &Md::inertia, {"disc", "sphere"},
                    "moment of inertia: m R^2/2 or 2/5 m R^2; 3D: always that of the sphere")
            .choice("body", &Md::body, {"sphere", "disc"},
                    "mass: 4/3 pi R^3 rho, or pi R^2 rho times one metre; 3D: always that of the sphere");
    return table;
}

const Table<AnalysisSpec>& analysis_table() {
    static const Choices kinds = {
#define ANALYSIS(name, choice) choice,
#include "scene/analyses.def"
    };
    static const Table<AnalysisSpec> table =
        Table<AnalysisSpec>(
            "What a run measures of its grains; each writes `NAME.csv`. flow, force-chains, mixing and "
            "stress add a row per frame; profile, pair-correlation and map average over frames: their tables "
            "are written with every checkpoint and at the end, maps as pictures `NAME-*.png` too. A pressure "
            "is a force per length in the plane, N/m, and in space a force per area, Pa.")
            .text("name", &AnalysisSpec::name, "name of the files")
            .required()
            .choice(
                "kind", &AnalysisSpec::kind, kinds,
                "strips across an axis; g(r); force chains; bins in the plane, in 3D columns along an axis; "
                "what crosses a line, in 3D a rectangle; stress tensor, contact number and packing fraction "
                "of a region; how well two populations are mixed")
            .required()
            .number("every", &AnalysisSpec::every, Unit::time, not_negative(),
                    "time between frames; 0: duration/100")
            .number("start", &AnalysisSpec::start, Unit::time, not_negative(),
                    "frames before it are left out")
            .vector(
                "from", &AnalysisSpec::from, Unit::length,
                "flow: where the line starts, in 3D a corner of the rectangle; else: a corner of the region")
            .vector(
                "to", &AnalysisSpec::to, Unit::length,
                "flow: where the line ends, from its left to its right counts positive; in 3D the opposite "
                "corner, with one coordinate equal to that of from: along this axis counts positive; else: "
                "the other corner, the same as from: the whole domain")
            .choice(
                "axis", &AnalysisSpec::axis, axis_choices(3),
                "profile: axis across the strips; 3D map: axis along the columns; mixing: axis across the "
                "sides; \"z\" in 3D only")
            .integer(
                "bins", &AnalysisSpec::bins, between(0, 4096),
                "profile: strips (0: 50); pair-correlation: distances (0: 100); map: columns (0: one "
                "mean diameter wide); mixing: cells along the longest side (0: three mean diameters wide)")
            .number("range", &AnalysisSpec::range, Unit::length, not_negative(),
                    "pair-correlation: largest distance; 0: half the shorter side")
            .number("threshold", &AnalysisSpec::threshold, Unit::none, not_negative(),
                    "force-chains, map: pressure that counts as load, in units of the mean over all grains")
            .choice(
                "populations", &AnalysisSpec::populations, {"sides", "materials", "sizes"},
                "mixing: the lower half along axis in the first frame, the first material, or the smaller "
                "grains, against the others");
    return table;
}

const Table<Output>& output_table() {
    static const Table<Output> table =
        Table<Output>("What a run writes, and how often in simulated time.")
            .number("log_every", &Output::log_every, Unit::time, any, "log.csv; 0: duration/200")
            .number("picture_every", &Output::picture_every, Unit::time, any,
                    "PNG pictures; 0: duration/20, negative: none")
            .number("trajectory_every", &Output::trajectory_every, Unit::time, any,
                    "trajectory; 0: duration/100, negative: none")
            .number("checkpoint_every", &Output::checkpoint_every, Unit::time, not_negative(),
                    "checkpoints; 0: only at the end")
            .choices("trajectory", &Output::trajectory, trajectory_choices(),
                     "LAMMPS dump, extended XYZ, VTK, or snapshots as in the book")
            .choice("colour", &Output::colour, colour_choices(), "colour of the grains")
            .integer("picture_width", &Output::picture_width, between(64, 16384),
                     "width of pictures in pixels")
            .vector(
                "view", &Output::view, Unit::none,
                "pictures: direction to the viewer, for example [0, -1, 0] from the front, [0, 0, 1] from "
                "above; [0, 0, 0]: from the front, turned a little and raised, with up against gravity")
            .only(3)
            .flag("movie", &Output::movie, "movie.mp4, if ffmpeg is installed")
            .flag("report", &Output::report, "report.html: plots and a replay");
    return table;
}

} // namespace sandlane::scene
