// The keys of grains, walls and their motions.
#include "scene/fields.hpp"
#include "scene/space.hpp"

namespace sandlane::scene {

namespace {

const Choices size_laws = {"constant", "uniform", "inverse-square", "lognormal"};

// radius = "5 mm", or radius = { law = "uniform", min = "4 mm", max = "6 mm" }.
void read_sizes(Grains& g, const Value& v, const std::string& path, std::int64_t) {
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

std::string write_sizes(const Grains& g, std::int64_t) {
    if (g.sizes.law == SizeLaw::constant) return g.sizes.min > 0 ? written(g.sizes.min) : std::string();
    return fmt::format("{{ law = {}, min = {}, max = {} }}",
                       quoted(size_laws[static_cast<std::size_t>(g.sizes.law)]), written(g.sizes.min),
                       written(g.sizes.max));
}

constexpr const char *counts_in_plane = "[columns, rows]", *counts_in_space = "[columns, rows, layers]";

void read_counts(Grains& g, const Value& v, const std::string& path, std::int64_t dimension) {
    if (v.kind != Value::Kind::array || v.items.size() != static_cast<std::size_t>(dimension))
        fail_at(v, path, fmt::format("must be {}", dimension == 3 ? counts_in_space : counts_in_plane));
    g.counts = {0, 0, 1};
    for (std::size_t n = 0; n < v.items.size(); ++n)
        g.counts[n] = read_integer(v.items[n], path, between(0, 1e9));
}

std::string write_counts(const Grains& g, std::int64_t dimension) {
    std::vector<std::string> counts;
    for (std::size_t n = 0; n < static_cast<std::size_t>(dimension); ++n)
        counts.push_back(fmt::format("{}", g.counts[n]));
    return joined(counts);
}

// A list of tables inside a table ([[grains.items]]).
template <class T> Field<T> items_field(std::vector<GrainItem> T::*member, std::string doc) {
    return {"items",
            "list of tables",
            "",
            "",
            std::move(doc),
            false,
            [=](T& t, const Value& v, const std::string& path, std::int64_t dimension) {
                if (v.kind != Value::Kind::array) fail_at(v, path, "must be a list of tables");
                for (std::size_t n = 0; n < v.items.size(); ++n)
                    item_table().read((t.*member).emplace_back(), v.items[n], fmt::format("{}[{}]", path, n),
                                      dimension);
            },
            [=](const T& t, std::int64_t dimension) {
                std::vector<std::string> items;
                for (const GrainItem& item : t.*member)
                    items.push_back(item_table().write_inline(item, dimension));
                return items.empty() ? std::string() : joined(items);
            }};
}

} // namespace

const Choices& wall_choices() {
    static const Choices choices = {"plane", "segment",  "polyline", "arc", "grains",
                                    "box",   "cylinder", "cone",     "mesh"};
    return choices;
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
            .only(2, "angular_velocity = [x, y, z]")
            .vector("angular_velocity", &GrainItem::angular_velocity, Unit::angular_speed, "angular velocity")
            .only(3, "omega")
            .number("angle", &GrainItem::angle, Unit::angle, any, "orientation")
            .only(2)
            .number("mass", &GrainItem::mass, Unit::mass, not_negative(),
                    "above 0: instead of the density's");
    return table;
}

const Table<Sink>& sink_table() {
    static const Table<Sink> table =
        Table<Sink>(
            "Boxes that grains vanish in: every 256 steps those whose centre lies inside are removed, and "
            "counted as those that leave the domain.")
            .text("name", &Sink::name, "shown in messages")
            .vector("lower", &Sink::lower, Unit::length, "lower left corner")
            .required()
            .vector("upper", &Sink::upper, Unit::length, "upper right corner")
            .required()
            .number("start", &Sink::start, Unit::time, not_negative(), "closed before this time");
    return table;
}

const Table<Grains>& grains_table() {
    static const Table<Grains> table =
        Table<Grains>("Populations of free grains, in the order of their ids.")
            .text("name", &Grains::name, "shown in messages")
            .text("material", &Grains::material, "name of a material; may be left out if there is one")
            .choice("kind", &Grains::kind, {"lattice", "random", "pour", "factory", "list", "file"},
                    "lattice: columns and rows (and layers); random: anywhere in the region without "
                    "overlaps; pour: one after the other while the run goes on, each at its place as soon as "
                    "there is room; factory: the same, but each attempt draws a new place in the region; "
                    "list: as given in items; file: from a file")
            .custom({"radius", "number or `{ law, min, max }`", "m", "above 0",
                     "radius, or a distribution: law `\"uniform\"`, `\"inverse-square\"` (pdf ~ 1/R^2) or "
                     "`\"lognormal\"` between min and max",
                     false, read_sizes, write_sizes})
            .vector("lower", &Grains::lower, Unit::length,
                    "region of the centres, lower left corner; lattice: first centre")
            .vector("upper", &Grains::upper, Unit::length,
                    "region of the centres, upper right corner; the same as lower: the whole domain")
            .custom({"counts", counts_in_plane, "", "0 or more", "lattice: number of grains", false,
                     read_counts, write_counts, counts_in_space})
            .vector("spacing", &Grains::spacing, Unit::length, "lattice: distance of centres")
            .flag("triangular", &Grains::triangular, "lattice: every second row is shifted by half a spacing")
            .only(2, "staggered")
            .flag(
                "staggered", &Grains::staggered,
                "lattice: every second layer is shifted by half a spacing along x and y; face-centred cubic "
                "with a spacing of [a, a, 0.7071 a], body-centred cubic with [a, a, 0.5 a]")
            .only(3, "triangular")
            .number("jitter", &Grains::jitter, Unit::none, between(0, 1),
                    "lattice: random displacement in units of the spacing")
            .integer("count", &Grains::count, between(0, 1e9), "random, pour, factory: number of grains")
            .number("packing_fraction", &Grains::packing_fraction, Unit::none, between(0, 0.9),
                    "random: covered part of the region, in 3D of its volume, instead of count; spheres can "
                    "be packed up to about 0.6")
            .number("start", &Grains::start, Unit::time, not_negative(),
                    "pour, factory: time of the first grain")
            .number("rate", &Grains::rate, Unit::rate, not_negative(), "pour, factory: grains per second")
            .vector("velocity", &Grains::velocity, Unit::speed, "initial velocity")
            .number("thermal_speed", &Grains::thermal_speed, Unit::speed, not_negative(),
                    "standard deviation of each velocity component")
            .number("omega", &Grains::omega, Unit::angular_speed, any, "initial spin")
            .only(2, "angular_velocity = [x, y, z]")
            .vector("angular_velocity", &Grains::angular_velocity, Unit::angular_speed,
                    "initial angular velocity")
            .only(3, "omega")
            .number("density", &Grains::density, Unit::density, not_negative(),
                    "above 0: instead of the material's")
            .text("file", &Grains::file,
                  "file: CSV with a header line of column names: x, y, vx, vy, angle, omega, radius, mass, "
                  "material, or the book's 25 columns; 3D: x, y, z, vx, vy, vz, omega_x, omega_y, omega_z, "
                  "radius, mass, material")
            .custom(items_field(&Grains::items, "list: the grains"));
    return table;
}

const Table<Wall>& wall_table() {
    static const Table<Wall> table =
        Table<Wall>(
            "Walls act on grains by the same laws as grains do, and move as prescribed. In two dimensions "
            "segments and arcs act on both sides, a plane on the side its normal points to, wall grains like "
            "fixed grains. In three dimensions there are planes, boxes (their six faces act on the inside), "
            "and surfaces that act on both sides: cylinders, cones and meshes of triangles. A cylinder or "
            "cone is a mantle between two ends, open unless closed.")
            .text("name", &Wall::name, "shown in messages and outputs")
            .text("material", &Wall::material, "name of a material; may be left out if there is one")
            .text("motion", &Wall::motion, "name of a motion; empty: fixed")
            .choice("kind", &Wall::kind, wall_choices(),
                    "infinite line or plane; 2D: line between two points, chain of lines, part of a circle, "
                    "row or ring of grains; 3D: box, cylinder, cone, triangles of an STL file")
            .vectors("points", &Wall::points, Unit::length,
                     "plane: a point on it; segment, polyline: corners; grains: ends of the row; box: two "
                     "opposite corners; cylinder, cone: ends of the axis")
            .flag("closed", &Wall::closed,
                  "polyline: joins the last point to the first; cylinder, cone: adds the end faces")
            .vector("normal", &Wall::normal, Unit::none, "plane: points to the free side")
            .vector("centre", &Wall::centre, Unit::length,
                    "arc, ring of grains: centre; mesh: where the origin of its coordinates is put")
            .number("radius", &Wall::radius, Unit::length, not_negative(),
                    "arc, cylinder: radius; cone: radius at the first end; grains: radius of each wall grain")
            .number("radius_to", &Wall::radius_to, Unit::length, not_negative(),
                    "cone: radius at the second end")
            .only(3)
            .text("file", &Wall::file, "mesh: STL file, text or binary")
            .only(3)
            .number("scale", &Wall::scale, Unit::none, positive(),
                    "mesh: factor on its coordinates, 0.001 if they are in mm")
            .only(3)
            .number("ring_radius", &Wall::ring_radius, Unit::length, not_negative(),
                    "grains: above 0 puts them on a circle")
            .only(2)
            .number("angle_from", &Wall::angle_from, Unit::angle, any, "arc, ring: first angle")
            .only(2)
            .number("angle_to", &Wall::angle_to, Unit::angle, any, "arc, ring: last angle, counter-clockwise")
            .only(2)
            .number("spacing", &Wall::spacing, Unit::length, not_negative(),
                    "grains: distance of centres; 0: touching")
            .only(2)
            .number("omega", &Wall::omega, Unit::angular_speed, any,
                    "grains: spin of each in addition to the motion")
            .only(2)
            .custom(items_field(&Wall::items, "grains: explicit wall grains"))
            .only(2);
    return table;
}

const Table<Motion>& motion_table() {
    static const Table<Motion> table =
        Table<Motion>("Prescribed rigid motions of walls, functions of absolute time.")
            .text("name", &Motion::name, "referred to by walls")
            .required()
            .choice("kind", &Motion::kind, {"fixed", "linear", "oscillate", "rotate", "planetary"},
                    "fixed; along a line; to and fro; turning about centre (3D: about an axis through it); "
                    "turning while the centre goes round on an orbit (3D: across the axis)")
            .vector("velocity", &Motion::velocity, Unit::speed, "linear: velocity of the wall")
            .vector("amplitude", &Motion::amplitude, Unit::length,
                    "oscillate: displacement = amplitude wave(omega t + phase)")
            .number("omega", &Motion::omega, Unit::angular_speed, any,
                    "oscillate, rotate: angular velocity; planetary: spin")
            .number("phase", &Motion::phase, Unit::angle, any, "oscillate, planetary: phase")
            .choice("wave", &Motion::wave, {"sine", "cosine"}, "oscillate: wave form")
            .vector("centre", &Motion::centre, Unit::length, "rotate, planetary: centre")
            .vector(
                "axis", &Motion::axis, Unit::none,
                "rotate, planetary: direction of the axis through centre; omega > 0 turns by the right-hand "
                "rule")
            .only(3)
            .number("orbit_radius", &Motion::orbit_radius, Unit::length, not_negative(),
                    "planetary: radius of the orbit")
            .number("orbit_omega", &Motion::orbit_omega, Unit::angular_speed, any,
                    "planetary: angular velocity on the orbit")
            .number("start", &Motion::start, Unit::time, any, "reference time of the given positions");
    return table;
}

} // namespace sandlane::scene
