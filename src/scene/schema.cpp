#include "scene/fields.hpp"

namespace sandlane::scene {

namespace {

const Choices size_laws = {"constant", "uniform", "inverse-square", "lognormal"};

// radius = "5 mm", or radius = { law = "uniform", min = "4 mm", max = "6 mm" }.
void read_sizes(Grains& g, const Value& v, const std::string& path) {
    if (v.kind != Value::Kind::table) {
        g.sizes.law = SizeLaw::constant;
        g.sizes.min = g.sizes.max = read_number(v, path, Unit::length, positive());
        return;
    }
    for (const auto& [key, item] : v.members) {
        if (key == "law")
            g.sizes.law = static_cast<SizeLaw>(read_choice(item, path + ".law", size_laws));
        else if (key == "min")
            g.sizes.min = read_number(item, path + ".min", Unit::length, positive());
        else if (key == "max")
            g.sizes.max = read_number(item, path + ".max", Unit::length, positive());
        else
            fail_unknown(item, fmt::format("{}.{}", path, key), {"law", "min", "max"});
    }
    if (g.sizes.max == 0) g.sizes.max = g.sizes.min;
    if (g.sizes.min == 0 || g.sizes.max < g.sizes.min)
        fail_at(v, path,
                fmt::format("min = {} and max = {} m do not make a range; needed: 0 < min <= max",
                            g.sizes.min, g.sizes.max));
}

std::string write_sizes(const Grains& g) {
    if (g.sizes.law == SizeLaw::constant) return g.sizes.min > 0 ? written(g.sizes.min) : std::string();
    return fmt::format("{{ law = {}, min = {}, max = {} }}",
                       quoted(size_laws[static_cast<std::size_t>(g.sizes.law)]), written(g.sizes.min),
                       written(g.sizes.max));
}

void read_periodic(Domain& d, const Value& v, const std::string& path) {
    if (v.kind != Value::Kind::array)
        fail_at(v, path, "must be a list of axes, for example [\"x\", \"y\"] or []");
    d.periodic = {};
    for (const Value& axis : v.items)
        d.periodic[static_cast<std::size_t>(read_choice(axis, path, {"x", "y"}))] = true;
}

std::string write_periodic(const Domain& d) {
    std::vector<std::string> axes;
    if (d.periodic[0]) axes.emplace_back("\"x\"");
    if (d.periodic[1]) axes.emplace_back("\"y\"");
    return joined(axes);
}

void read_counts(Grains& g, const Value& v, const std::string& path) {
    if (v.kind != Value::Kind::array || v.items.size() != 2) fail_at(v, path, "must be [columns, rows]");
    g.counts.clear();
    for (const Value& n : v.items) g.counts.push_back(read_integer(n, path, between(0, 1e9)));
}

// A list of tables inside a table ([[grains.items]]).
template <class T> Field<T> items_field(std::vector<GrainItem> T::*member, std::string doc) {
    return {"items",
            "list of tables",
            "",
            "",
            std::move(doc),
            false,
            [=](T& t, const Value& v, const std::string& path) {
                if (v.kind != Value::Kind::array) fail_at(v, path, "must be a list of tables");
                for (std::size_t n = 0; n < v.items.size(); ++n)
                    item_table().read((t.*member).emplace_back(), v.items[n], fmt::format("{}[{}]", path, n));
            },
            [=](const T& t) {
                std::vector<std::string> items;
                for (const GrainItem& item : t.*member) {
                    std::string text;
                    for (const Field<GrainItem>& field : item_table().fields())
                        text +=
                            fmt::format("{}{} = {}", text.empty() ? "" : ", ", field.name, field.write(item));
                    items.push_back("{ " + text + " }");
                }
                return items.empty() ? std::string() : joined(items);
            }};
}

} // namespace

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
            .choice("method", &Scene::method, {"md"}, "engine: force-based molecular dynamics")
            .integer("seed", &Scene::seed, between(0, 9e15),
                     "seed of all random numbers; the same seed gives the same scene");
    return table;
}

const Table<Domain>& domain_table() {
    static const Table<Domain> table =
        Table<Domain>(
            "The rectangle that holds everything. Its sides are open or periodic; they are no walls.")
            .vector("lower", &Domain::lower, Unit::length, "lower left corner")
            .vector("upper", &Domain::upper, Unit::length, "upper right corner")
            .required()
            .custom({"periodic", "list of `\"x\"`, `\"y\"`", "", "",
                     "directions in which a grain that leaves comes back on the other side", false,
                     read_periodic, write_periodic})
            .vector("gravity", &Domain::gravity, Unit::acceleration, "acceleration of gravity")
            .choice(
                "outside", &Domain::outside, {"error", "remove"},
                "a grain whose centre leaves through an open side ends the run, or is removed and counted");
    return table;
}

const Table<Material>& material_table() {
    static const Table<Material> table =
        Table<Material>(
            "Materials of grains and walls. A law reads only its own coefficients: the linear dashpot "
            "stiffness and damping, the viscoelastic law young, poisson and dissipation.")
            .text("name", &Material::name, "referred to by grains and walls")
            .required()
            .number("density", &Material::density, Unit::density, positive(),
                    "density (body = \"disc\": times one metre of depth)")
            .number("stiffness", &Material::stiffness, Unit::stiffness, not_negative(),
                    "spring constant k (linear dashpot)")
            .number("damping", &Material::damping, Unit::damping, not_negative(),
                    "damping constant gamma (linear dashpot)")
            .number("young", &Material::young, Unit::pressure, not_negative(),
                    "Young's modulus Y (viscoelastic)")
            .number("poisson", &Material::poisson, Unit::none, between(-0.99, 0.5),
                    "Poisson ratio (viscoelastic)")
            .number("dissipation", &Material::dissipation, Unit::time, not_negative(),
                    "dissipative constant A (viscoelastic)")
            .number("friction", &Material::friction, Unit::none, not_negative(),
                    "Coulomb friction coefficient mu (Haff-Werner)")
            .number("tangential_damping", &Material::tangential_damping, Unit::damping, not_negative(),
                    "tangential damping constant gamma_t (Haff-Werner: 0 is no friction; Cundall-Strack: "
                    "beside the spring)")
            .number("tangential_stiffness", &Material::tangential_stiffness, Unit::stiffness, not_negative(),
                    "tangential spring constant k_t (Cundall-Strack)");
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
            .number("stiffness", &MaterialPair::stiffness, Unit::stiffness, any, "k of the pair")
            .number("damping", &MaterialPair::damping, Unit::damping, any, "gamma of the pair")
            .number("young", &MaterialPair::young, Unit::pressure, any, "Y/(1 - nu^2) of two equal partners")
            .number("dissipation", &MaterialPair::dissipation, Unit::time, any, "A of the pair")
            .number("friction", &MaterialPair::friction, Unit::none, any, "mu of the pair")
            .number("tangential_damping", &MaterialPair::tangential_damping, Unit::damping, any,
                    "gamma_t of the pair")
            .number("tangential_stiffness", &MaterialPair::tangential_stiffness, Unit::stiffness, any,
                    "k_t of the pair");
    return table;
}

const Table<GrainItem>& item_table() {
    static const Table<GrainItem> table =
        Table<GrainItem>("One grain given explicitly.")
            .vector("position", &GrainItem::position, Unit::length, "centre")
            .required()
            .vector("velocity", &GrainItem::velocity, Unit::speed, "velocity")
            .number("radius", &GrainItem::radius, Unit::length, positive(), "radius")
            .required()
            .number("omega", &GrainItem::omega, Unit::angular_speed, any, "spin")
            .number("angle", &GrainItem::angle, Unit::angle, any, "orientation")
            .number("mass", &GrainItem::mass, Unit::mass, not_negative(),
                    "above 0: instead of the density's");
    return table;
}

const Table<Grains>& grains_table() {
    static const Table<Grains> table =
        Table<Grains>("Populations of free grains, in the order of their ids.")
            .text("name", &Grains::name, "shown in messages")
            .text("material", &Grains::material, "name of a material; may be left out if there is one")
            .choice("kind", &Grains::kind, {"lattice", "random", "pour", "list", "file"},
                    "lattice: rows and columns; random: anywhere in the region without overlaps; pour: one "
                    "after the other "
                    "while the run goes on, each as soon as there is room; list: as given in items; file: "
                    "from a file")
            .custom({"radius", "number or `{ law, min, max }`", "m", "above 0",
                     "radius, or a distribution: law `\"uniform\"`, `\"inverse-square\"` (pdf ~ 1/R^2) or "
                     "`\"lognormal\"` between min and max",
                     false, read_sizes, write_sizes})
            .vector("lower", &Grains::lower, Unit::length,
                    "region of the centres, lower left corner; lattice: first centre")
            .vector("upper", &Grains::upper, Unit::length,
                    "region of the centres, upper right corner; the same as lower: the whole domain")
            .custom({"counts", "[columns, rows]", "", "0 or more", "lattice: number of grains", false,
                     read_counts,
                     [](const Grains& g) { return fmt::format("[{}, {}]", g.counts[0], g.counts[1]); }})
            .vector("spacing", &Grains::spacing, Unit::length, "lattice: distance of centres")
            .flag("triangular", &Grains::triangular, "lattice: every second row is shifted by half a spacing")
            .number("jitter", &Grains::jitter, Unit::none, between(0, 1),
                    "lattice: random displacement in units of the spacing")
            .integer("count", &Grains::count, between(0, 1e9), "random, pour: number of grains")
            .number("packing_fraction", &Grains::packing_fraction, Unit::none, between(0, 0.9),
                    "random: covered part of the region, instead of count")
            .number("start", &Grains::start, Unit::time, not_negative(), "pour: time of the first grain")
            .number("rate", &Grains::rate, Unit::rate, not_negative(), "pour: grains per second")
            .vector("velocity", &Grains::velocity, Unit::speed, "initial velocity")
            .number("thermal_speed", &Grains::thermal_speed, Unit::speed, not_negative(),
                    "standard deviation of each velocity component")
            .number("omega", &Grains::omega, Unit::angular_speed, any, "initial spin")
            .number("density", &Grains::density, Unit::density, not_negative(),
                    "above 0: instead of the material's")
            .text("file", &Grains::file, "file: CSV with a header line, or the book's 25 columns")
            .custom(items_field(&Grains::items, "list: the grains"));
    return table;
}

const Table<Wall>& wall_table() {
    static const Table<Wall> table =
        Table<Wall>("Walls act on grains by the same laws as grains do, and move as prescribed. Segments and "
                    "arcs act on "
                    "both sides, a plane on the side its normal points to, wall grains like fixed grains.")
            .text("name", &Wall::name, "shown in messages and outputs")
            .text("material", &Wall::material, "name of a material; may be left out if there is one")
            .text("motion", &Wall::motion, "name of a motion; empty: fixed")
            .choice("kind", &Wall::kind, {"plane", "segment", "polyline", "arc", "grains"},
                    "infinite line, line between two points, chain of lines, part of a circle, row or ring "
                    "of grains")
            .vectors("points", &Wall::points, Unit::length,
                     "plane: a point on it; segment, polyline: corners; grains: ends of the row")
            .flag("closed", &Wall::closed, "polyline: joins the last point to the first")
            .vector("normal", &Wall::normal, Unit::none, "plane: points to the free side")
            .vector("centre", &Wall::centre, Unit::length, "arc, ring of grains: centre")
            .number("radius", &Wall::radius, Unit::length, not_negative(),
                    "arc: radius; grains: radius of each wall grain")
            .number("ring_radius", &Wall::ring_radius, Unit::length, not_negative(),
                    "grains: above 0 puts them on a circle")
            .number("angle_from", &Wall::angle_from, Unit::angle, any, "arc, ring: first angle")
            .number("angle_to", &Wall::angle_to, Unit::angle, any, "arc, ring: last angle, counter-clockwise")
            .number("spacing", &Wall::spacing, Unit::length, not_negative(),
                    "grains: distance of centres; 0: touching")
            .number("omega", &Wall::omega, Unit::angular_speed, any,
                    "grains: spin of each in addition to the motion")
            .custom(items_field(&Wall::items, "grains: explicit wall grains"));
    return table;
}

const Table<Motion>& motion_table() {
    static const Table<Motion> table =
        Table<Motion>("Prescribed rigid motions of walls, functions of absolute time.")
            .text("name", &Motion::name, "referred to by walls")
            .required()
            .choice("kind", &Motion::kind, {"fixed", "linear", "oscillate", "rotate", "planetary"},
                    "fixed; along a line; to and fro; turning about centre; turning while the centre goes "
                    "round on an orbit")
            .vector("velocity", &Motion::velocity, Unit::speed, "linear: velocity of the wall")
            .vector("amplitude", &Motion::amplitude, Unit::length,
                    "oscillate: displacement = amplitude wave(omega t + phase)")
            .number("omega", &Motion::omega, Unit::angular_speed, any,
                    "oscillate, rotate: angular velocity; planetary: spin")
            .number("phase", &Motion::phase, Unit::angle, any, "oscillate, planetary: phase")
            .choice("wave", &Motion::wave, {"sine", "cosine"}, "oscillate: wave form")
            .vector("centre", &Motion::centre, Unit::length, "rotate, planetary: centre")
            .number("orbit_radius", &Motion::orbit_radius, Unit::length, not_negative(),
                    "planetary: radius of the orbit")
            .number("orbit_omega", &Motion::orbit_omega, Unit::angular_speed, any,
                    "planetary: angular velocity on the orbit")
            .number("start", &Motion::start, Unit::time, any, "reference time of the given positions");
    return table;
}

const Table<Md>& md_table() {
    static const Table<Md> table =
        Table<Md>(
            "Force-based molecular dynamics. `neighbours = \"auto\"` picks the method of finding pairs that "
            "suits the scene, and says why in the plan; all methods give the same contacts.")
            .choice("normal", &Md::normal, {"linear-dashpot", "viscoelastic"},
                    "normal force: spring and dashpot, or viscoelastic spheres (Hertz)")
            .choice("tangential", &Md::tangential, tangential_choices(), "tangential force")
            .choice("integrator", &Md::integrator, {"gear4", "gear5", "gear6", "velocity-verlet"},
                    "Gear predictor-corrector with 4, 5 or 6 values, or velocity Verlet")
            .choice("neighbours", &Md::neighbours, neighbour_choices(), "pair finding")
            .number("dt", &Md::dt, Unit::time, not_negative(),
                    "time step; 0: chosen from the stiffest contact (t_c/50)")
            .number("duration", &Md::duration, Unit::time, not_negative(), "simulated time; 0: no steps")
            .number("max_speed", &Md::max_speed, Unit::speed, positive(),
                    "largest impact speed expected; the time step is derived from it")
            .number("delta", &Md::delta, Unit::none, between(0, 0.9),
                    "lattice: largest overlap in units of the smaller radius")
            .choice("inertia", &Md::inertia, {"disc", "sphere"}, "moment of inertia: m R^2/2 or 2/5 m R^2")
            .choice("body", &Md::body, {"sphere", "disc"},
                    "mass: 4/3 pi R^3 rho, or pi R^2 rho times one metre");
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
            "stress "
            "add a row "
            "per frame; profile, pair-correlation and map average over frames: their tables are written with "
            "every checkpoint and at the end, maps as pictures `NAME-*.png` too. A pressure is a force per "
            "length in the plane, N/m.")
            .text("name", &AnalysisSpec::name, "name of the files")
            .required()
            .choice("kind", &AnalysisSpec::kind, kinds,
                    "strips across an axis; g(r); force chains; bins in the plane; what crosses a line; "
                    "stress tensor, contact number and packing fraction of a region; how well two "
                    "populations are "
                    "mixed")
            .required()
            .number("every", &AnalysisSpec::every, Unit::time, not_negative(),
                    "time between frames; 0: duration/100")
            .number("start", &AnalysisSpec::start, Unit::time, not_negative(),
                    "frames before it are left out")
            .vector("from", &AnalysisSpec::from, Unit::length,
                    "flow: where the line starts; else: a corner of the region")
            .vector("to", &AnalysisSpec::to, Unit::length,
                    "flow: where the line ends, from its left to its right counts positive; else: the other "
                    "corner, the same as from: the whole domain")
            .choice("axis", &AnalysisSpec::axis, {"x", "y"},
                    "profile: axis across the strips; mixing: axis across the sides")
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
            .flag("movie", &Output::movie, "movie.mp4, if ffmpeg is installed")
            .flag("report", &Output::report, "report.html: plots and a replay");
    return table;
}

} // namespace sandlane::scene
