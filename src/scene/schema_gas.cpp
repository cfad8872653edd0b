// The keys of gases: particles, sides, and the Monte Carlo method.
#include "scene/fields.hpp"

namespace sandlane::scene {

namespace {

void read_cells(Dsmc& d, const Value& v, const std::string& path, std::int64_t dimension) {
    if (v.kind != Value::Kind::array || v.items.size() != static_cast<std::size_t>(dimension))
        fail_at(v, path, dimension == 3 ? "must be [columns, rows, layers]" : "must be [columns, rows]");
    for (std::size_t n = 0; n < v.items.size(); ++n)
        d.cells[n] = read_integer(v.items[n], path, between(0, 1e6));
}

std::string write_cells(const Dsmc& d, std::int64_t dimension) {
    std::vector<std::string> counts;
    for (std::size_t n = 0; n < static_cast<std::size_t>(dimension); ++n)
        counts.push_back(fmt::format("{}", d.cells[n]));
    return joined(counts);
}

void read_between(GasPair& p, const Value& v, const std::string& path, std::int64_t) {
    if (v.kind != Value::Kind::array || v.items.size() != 2)
        fail_at(v, path, "must be [kind, kind], numbers: 0 is [gas], 1 the first of [[species]]");
    for (std::size_t n = 0; n < 2; ++n) p.between[n] = read_integer(v.items[n], path, between(0, 65000));
}

std::string write_between(const GasPair& p, std::int64_t) {
    return fmt::format("[{}, {}]", p.between[0], p.between[1]);
}

} // namespace

const Table<Gas>& gas_table() {
    static const Table<Gas> table =
        Table<Gas>("A gas of equal hard discs or spheres, uniform in the domain and Maxwellian at the start. "
                   "Temperatures are energies, m <v^2> of a component without the mean.")
            .integer("particles", &Gas::particles, between(1, 2e9), "number of simulated particles")
            .required()
            .number("temperature", &Gas::temperature, Unit::energy, positive(), "at the start, exactly")
            .required()
            .number("mass", &Gas::mass, Unit::mass, positive(), "of a particle")
            .number("diameter", &Gas::diameter, Unit::length, positive(), "of a particle")
            .number("weight", &Gas::weight, Unit::none, positive(),
                    "real particles that a simulated one stands for")
            .choice("model", &Gas::model, {"constant", "viscoelastic", "saturating"},
                    "normal restitution eps: constant; viscoelastic spheres, eps(dissipation g^{1/5}) of the "
                    "impact speed g; 1 - (1 - restitution) min(1, g/critical_speed)^exponent")
            .number("restitution", &Gas::restitution, Unit::none, between(0, 1),
                    "eps, or that of fast impacts")
            .number(
                "dissipation", &Gas::dissipation, Unit::none, not_negative(),
                "viscoelastic: A rho^{2/5} in (s/m)^{1/5}, with rho = 2 Y sqrt(R_eff)/(3 (1 - nu^2) m_eff)")
            .number("critical_speed", &Gas::critical_speed, Unit::speed, positive(), "saturating")
            .number("exponent", &Gas::exponent, Unit::none, between(0.01, 10), "saturating")
            .number("tangential_restitution", &Gas::tangential_restitution, Unit::none, between(-1, 1),
                    "1: smooth particles, which do not spin; 0: tangential motion stops; -1: perfectly rough")
            .number("friction", &Gas::friction, Unit::none, not_negative(),
                    "Coulomb's bound of the tangential impulse, which raises the tangential restitution of "
                    "grazing collisions; 0: no bound")
            .choice("body", &Gas::body, {"sphere", "disc", "hollow-sphere", "ring"},
                    "rough particles: moment of inertia 2/5, 1/2, 2/3 or 1 m R^2")
            .number("spin_temperature", &Gas::spin_temperature, Unit::energy, not_negative(),
                    "rough particles: J <w^2> of a component at the start");
    return table;
}

const Table<GasSide>& side_table() {
    static const Table<GasSide> table =
        Table<GasSide>(
            "Sides of the domain that are not periodic. Those that are not listed reflect elastically.")
            .choice("side", &GasSide::side, {"-x", "+x", "-y", "+y", "-z", "+z"},
                    "lower and upper side of each axis")
            .required()
            .choice("kind", &GasSide::kind, {"reflecting", "heated"},
                    "a heated wall sends particles back with the flux of a gas at its temperature")
            .number("restitution", &GasSide::restitution, Unit::none, between(0, 1), "reflecting: normal")
            .number("tangential_restitution", &GasSide::tangential_restitution, Unit::none, between(-1, 1),
                    "reflecting, rough particles: tangential")
            .number("temperature", &GasSide::temperature, Unit::energy, not_negative(), "heated: above 0")
            .number("accommodation", &GasSide::accommodation, Unit::none, between(0, 1),
                    "heated: fraction that takes its temperature; the others are reflected elastically")
            .vector("velocity", &GasSide::velocity, Unit::speed, "of the wall along itself")
            .number("amplitude", &GasSide::amplitude, Unit::length, not_negative(),
                    "oscillates along its normal, towards the gas first")
            .number("frequency", &GasSide::frequency, Unit::rate, not_negative(), "of the oscillation")
            .number("phase", &GasSide::phase, Unit::angle, any, "of the oscillation")
            .number("speed", &GasSide::speed, Unit::speed, any,
                    "edmd: a piston that moves steadily along its normal, towards the gas where positive");
    return table;
}

const Table<CurvedWall>& curved_wall_table() {
    static const Table<CurvedWall> table =
        Table<CurvedWall>(
            "Walls at rest that enclose the gas or stand in it. They must lie in the domain, and not "
            "across a periodic direction.")
            .choice("shape", &CurvedWall::shape, {"sphere", "cylinder"}, "in the plane a sphere is a circle")
            .choice("gas", &CurvedWall::gas, {"inside", "outside"}, "a container, or an obstacle")
            .vector("center", &CurvedWall::center, Unit::length, "of a cylinder any point of its axis")
            .required()
            .number("radius", &CurvedWall::radius, Unit::length, positive(), "of the wall")
            .required()
            .choice("axis", &CurvedWall::axis, {"x", "y", "z"}, "of a cylinder")
            .choice("kind", &CurvedWall::kind, {"reflecting", "heated"}, "as for sides")
            .number("restitution", &CurvedWall::restitution, Unit::none, between(0, 1), "reflecting: normal")
            .number("tangential_restitution", &CurvedWall::tangential_restitution, Unit::none, between(-1, 1),
                    "reflecting, rough particles: tangential")
            .number("temperature", &CurvedWall::temperature, Unit::energy, not_negative(), "heated: above 0")
            .number("accommodation", &CurvedWall::accommodation, Unit::none, between(0, 1),
                    "heated: fraction that takes its temperature; the others are reflected elastically");
    return table;
}

const Table<Dsmc>& dsmc_table() {
    static const Table<Dsmc> table =
        Table<Dsmc>("Direct simulation Monte Carlo. Pictures and trajectories are written only where their "
                    "intervals are given.")
            .custom(
                {"cells", "[columns, rows]", "", "0 or more",
                 "cells; 0: as many as are at most a third of the mean free path long, but not fewer than 10 "
                 "particles each; 1 in directions in which the gas is uniform",
                 false, read_cells, write_cells, "[columns, rows, layers]"})
            .choice("scheme", &Dsmc::scheme,
                    {"no-time-counter", "direction-first", "nanbu-babovsky", "majorant-frequency",
                     "bernoulli", "maxwell"},
                    "how pairs are chosen. Those after the first are oracles without vector kernels; but "
                    "\"maxwell\" lets all pairs collide at the rate of the start, whatever their speed: a "
                    "gas with exact solutions")
            .flag("enskog", &Dsmc::enskog,
                  "more collisions by the pair correlation at contact of the cell's density")
            .integer("near_partners", &Dsmc::near_partners, between(1, 5),
                     "a particle that may collide takes the nearest of so many partners drawn from its cell: "
                     "pairs are closer, and cells that are too long falsify gradients less")
            .number("dt", &Dsmc::dt, Unit::time, not_negative(),
                    "time step; 0: 0.1 collisions per particle, and fast particles cross half a cell at most")
            .flag("adaptive", &Dsmc::adaptive, "the time step grows as 1/sqrt(T)")
            .number("duration", &Dsmc::duration, Unit::time, not_negative(), "simulated time; 0: no steps")
            .number("heating", &Dsmc::heating, Unit::heating, not_negative(),
                    "white noise xi^2: random kicks of variance xi^2 dt to each velocity component")
            .number("sample_every", &Dsmc::sample_every, Unit::time, any,
                    "frames of profile.csv and distribution.csv, averages over time; 0: duration/200, "
                    "negative: none")
            .number("sample_start", &Dsmc::sample_start, Unit::time, not_negative(),
                    "frames before it are left out")
            .choice("profile_axis", &Dsmc::profile_axis, {"x", "y", "z"},
                    "axis across the bins of profile.csv")
            .integer("profile_bins", &Dsmc::profile_bins, between(0, 100000), "0: the cells along it")
            .number("structure_every", &Dsmc::structure_every, Unit::time, any,
                    "frames of structure.csv, clusters.csv and cluster_sizes.csv: spectra of density and "
                    "transverse momentum, clusters; 0 or negative: none")
            .number("cluster_reach", &Dsmc::cluster_reach, Unit::none, between(1, 100),
                    "particles closer than this times the sum of their radii are of one cluster; a simulated "
                    "one is as large as all that it stands for");
    return table;
}

const Table<Species>& species_table() {
    static const Table<Species> table =
        Table<Species>(
            "Particles of another size or mass in the gas. Restitution, friction and body are those "
            "of [gas], and so is the temperature at the start.")
            .integer("particles", &Species::particles, between(1, 2e9), "number of them")
            .required()
            .number("mass", &Species::mass, Unit::mass, positive(), "of one")
            .number("diameter", &Species::diameter, Unit::length, positive(), "of one");
    return table;
}

const Table<GasPair>& gas_pair_table() {
    static const Table<GasPair> table =
        Table<GasPair>("Restitution of two kinds of particles where it is not that of [gas].")
            .custom({"between", "[kind, kind]", "", "0 or more",
                     "0: the particles of [gas]; 1 and so on: those of [[species]], in their order", false,
                     read_between, write_between})
            .required()
            .number("restitution", &GasPair::restitution, Unit::none, between(0, 1),
                    "as that of [gas]; constant and saturating models")
            .number("dissipation", &GasPair::dissipation, Unit::none, not_negative(),
                    "as that of [gas]; viscoelastic model");
    return table;
}

const Table<Edmd>& edmd_table() {
    static const Table<Edmd> table =
        Table<Edmd>(
            "Event-driven dynamics. Steps are events: collisions and hits of walls. The start is random "
            "where there is room for that, else a lattice. Pictures and trajectories are written only where "
            "their intervals are given.")
            .choice("algorithm", &Edmd::algorithm, {"auto", "improved", "simple"},
                    "cells and a queue, or every pair after every event: the same events. \"auto\" takes the "
                    "second for boxes of fewer than three cells")
            .number("duration", &Edmd::duration, Unit::time, not_negative(),
                    "simulated time; 0: no end by time")
            .integer("events", &Edmd::events, between(0, 9e15),
                     "the run ends after so many; 0: by its duration")
            .integer(
                "replicas", &Edmd::replicas, between(1, 10000),
                "independent runs, of this seed and those after it, which threads take on at the same time: "
                "log.csv has means and their standard errors, columns NAME_error; profile.csv and "
                "distribution.csv average over all. Events count in the first one, which pictures show")
            .choice(
                "start", &Edmd::start, {"auto", "random", "lattice", "growth"},
                "\"growth\": small particles placed at random that grow while they collide, for dense gases "
                "without order; \"auto\": random where there is room, else a lattice")
            .number("growth_rate", &Edmd::growth_rate, Unit::none, between(1e-4, 10),
                    "growth: of the radius, in units of the thermal speed; slow growth lets dense particles "
                    "crystallise, fast growth jams them sooner")
            .number(
                "heating", &Edmd::heating, Unit::heating, not_negative(),
                "white noise xi^2: random kicks of variance xi^2 heating_interval to each velocity component")
            .number(
                "heating_interval", &Edmd::heating_interval, Unit::time, not_negative(),
                "time between the kicks, each of which costs as much as a collision of every particle; 0: a "
                "twentieth of the time between two collisions of a particle")
            .number("contact_time", &Edmd::contact_time, Unit::time, not_negative(),
                    "against inelastic collapse: a particle whose last collision was less than this ago "
                    "collides elastically; 0: never")
            .number("elastic_speed", &Edmd::elastic_speed, Unit::speed, not_negative(),
                    "against inelastic collapse: slower impacts are elastic")
            .number("cell_edge", &Edmd::cell_edge, Unit::length, not_negative(),
                    "least edge of the cells; 0: chosen. Results do not depend on it")
            .choice(
                "output_spacing", &Edmd::output_spacing, {"time", "log-time", "events"},
                "intervals of outputs are counted in time, and so are those chosen as parts of the duration; "
                "\"log-time\": log, pictures and trajectories come first after their interval (0: the mean "
                "time between two collisions of a particle at the start), then twenty times while the time "
                "grows tenfold; \"events\": as many events as an interval takes on the average")
            .number("sample_every", &Edmd::sample_every, Unit::time, any,
                    "frames of profile.csv and distribution.csv, averages over time; 0: duration/200, "
                    "negative: none")
            .number("sample_start", &Edmd::sample_start, Unit::time, not_negative(),
                    "frames before it are left out")
            .choice("profile_axis", &Edmd::profile_axis, {"x", "y", "z"},
                    "axis across the bins of profile.csv")
            .integer("profile_bins", &Edmd::profile_bins, between(1, 100000), "of profile.csv")
            .number("structure_every", &Edmd::structure_every, Unit::time, any,
                    "frames of structure.csv, clusters.csv and cluster_sizes.csv: spectra of density and "
                    "transverse momentum, clusters; 0 or negative: none")
            .number("cluster_reach", &Edmd::cluster_reach, Unit::none, between(1, 100),
                    "particles closer than this times the sum of their radii are of one cluster; a simulated "
                    "one is as large as all that it stands for");
    return table;
}

} // namespace sandlane::scene
