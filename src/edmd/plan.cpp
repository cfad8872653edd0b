#include "edmd/plan.hpp"

#include "analysis/gas_scene.hpp"
#include "core/error.hpp"
#include "edmd/reference/simple.hpp"
#include "edmd/simulation.hpp"
#include "laws/collision.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sandlane::edmd {

namespace {

Side side_of(const scene::GasSide& from) {
    Side side;
    side.kind = from.kind == scene::SideKind::heated ? Side::Kind::heated : Side::Kind::reflecting;
    side.eps_n = from.restitution;
    side.eps_t = from.tangential_restitution;
    side.temperature = from.temperature;
    side.accommodation = from.accommodation;
    analysis::copy(from.velocity, side.velocity);
    side.motion = analysis::oscillation_of(from);
    side.speed = from.speed;
    return side;
}

Curved curved_of(const scene::CurvedWall& from, int dimension) {
    Curved c;
    analysis::copy(from.center, c.center);
    c.radius = from.radius;
    c.axis = from.shape == scene::CurvedShape::cylinder ? static_cast<int>(from.axis) : -1;
    c.container = from.gas == scene::CurvedGas::inside;
    c.wall.kind = from.kind == scene::SideKind::heated ? Side::Kind::heated : Side::Kind::reflecting;
    c.wall.eps_n = from.restitution;
    c.wall.eps_t = from.tangential_restitution;
    c.wall.temperature = from.temperature;
    c.wall.accommodation = from.accommodation;
    if (dimension == 2) c.center[2] = 0;
    return c;
}

Setup setup_of(const scene::Scene& scene) {
    Setup s;
    s.dimension = static_cast<int>(scene.domain.dimension);
    analysis::copy(scene.domain.lower, s.lower);
    analysis::copy(scene.domain.upper, s.upper);
    analysis::copy(scene.domain.gravity, s.gravity);
    if (s.dimension == 2) s.lower[2] = 0, s.upper[2] = 1, s.gravity[2] = 0;
    const scene::Gas& gas = scene.gas;
    for (int d = 0; d < s.dimension; ++d) s.periodic[d] = scene.domain.periodic[static_cast<std::size_t>(d)];
    for (const scene::GasSide& side : scene.sides) {
        const auto n = static_cast<std::size_t>(side.side);
        s.side[n / 2][n % 2] = side_of(side);
    }
    for (const scene::CurvedWall& wall : scene.curved_walls) s.curved.push_back(curved_of(wall, s.dimension));
    s.kicks = scene.edmd.heating;
    s.kick_interval = scene.edmd.heating_interval;
    const double q = analysis::inertia_of(gas.body);
    s.classes = {{0.5 * gas.diameter, gas.mass, q}};
    for (const scene::Species& more : scene.species) s.classes.push_back({0.5 * more.diameter, more.mass, q});
    s.restitution = analysis::restitution_of(gas);
    for (std::size_t k = 0; !scene.gas_pairs.empty() && k < s.classes.size() * s.classes.size(); ++k)
        s.pairs.push_back(s.restitution);
    for (const scene::GasPair& pair : scene.gas_pairs) {
        const auto i = static_cast<std::size_t>(pair.between[0]),
                   j = static_cast<std::size_t>(pair.between[1]);
        for (const std::size_t at : {s.classes.size() * i + j, s.classes.size() * j + i}) {
            s.pairs[at].eps = pair.restitution;
            s.pairs[at].dissipation = pair.dissipation;
        }
    }
    s.rough = gas.tangential_restitution != 1;
    s.tangential = gas.tangential_restitution;
    s.friction = gas.friction;
    s.contact_time = scene.edmd.contact_time;
    s.elastic_speed = scene.edmd.elastic_speed;
    s.cell_edge = scene.edmd.cell_edge;
    s.shear = scene.domain.shear_rate;
    s.seed = static_cast<std::uint64_t>(scene.seed);
    return s;
}

// Of what moves the gas in the long run.
double highest_temperature(const scene::Scene& scene, const Setup& s) {
    double highest = scene.gas.temperature;
    for (const auto& axis : s.side)
        for (const Side& side : axis) {
            const double speed = 2 * std::numbers::pi * side.motion.frequency * side.motion.amplitude;
            highest = std::max({highest, side.temperature, scene.gas.mass * speed * speed});
        }
    for (const Curved& c : s.curved) highest = std::max(highest, c.wall.temperature);
    return highest;
}

// Where white noise and collisions balance, J; 0: they do not.
double steady_temperature(const analysis::HardGas& gas, const Setup& s) {
    const double loss = 1 - s.restitution.eps * s.restitution.eps;
    if (s.restitution.model != laws::Restitution::Model::constant || loss == 0) return 0;
    return std::pow(gas.mass * s.kicks * s.dimension / (analysis::collision_rate(gas, 1) * loss), 2.0 / 3);
}

void choose_kicks(const scene::Scene& scene, Plan& plan) {
    Setup& s = plan.setup;
    if (s.kicks == 0) return;
    const analysis::HardGas gas = gas_of(plan);
    const double hottest = std::max(highest_temperature(scene, s), steady_temperature(gas, s));
    const double rate = analysis::collision_rate(gas, hottest);
    if (s.kick_interval == 0) {
        s.kick_interval = 0.05 / rate;
        plan.chosen.push_back(fmt::format("a kick of the thermostat every {:.4g} s", s.kick_interval));
    } else if (s.kick_interval * rate > 0.1) {
        plan.warnings.push_back(
            fmt::format("edmd.heating_interval is {:.2g} of the time between two collisions, "
                        "more than 0.1: kicks are no white noise",
                        s.kick_interval * rate));
    }
}

void check_curved(const Plan& plan) {
    const Setup& s = plan.setup;
    const double most = s.dimension == 3 ? 0.7405 : 0.9069, volume = s.volume();
    if (s.curved.empty()) return;
    if (!(volume > 0) || packing_fraction(s, plan.amounts) > most)
        fail(Exit::invalid_input,
             "gas: curved walls leave {:.4g} m^{} for {} particles; the packing fraction may be up to {}. "
             "Take fewer or smaller ones, or a larger container",
             volume, s.dimension, plan.particles(), most);
}

// Events until the end: from theory where the gas is homogeneous and cools, else at the rate of the start.
void expect_events(const scene::Scene& scene, Plan& plan) {
    const analysis::HardGas gas = gas_of(plan);
    const auto n = static_cast<double>(plan.particles());
    const double hottest = highest_temperature(scene, plan.setup),
                 rate = analysis::collision_rate(gas, hottest);
    const double time = plan.homogeneous
                            ? analysis::collision_clock(gas, scene.gas.temperature, scene.edmd.duration)
                            : scene.edmd.duration;
    double events = 0.5 * n * rate * time;
    for (int d = 0; d < plan.setup.dimension; ++d) // n v/4 on each of two sides, about
        if (!plan.setup.periodic[d])
            events += n / plan.setup.length(d) * std::sqrt(hottest / plan.setup.classes[0].mass) * time;
    const auto most = static_cast<double>(scene.edmd.events);
    if (most > 0 && (scene.edmd.duration == 0 || most < events)) events = most;
    plan.events = std::max(1.0, events);
    plan.duration = scene.edmd.duration;
    if (plan.duration == 0) plan.duration = rate > 0 ? 2 * events / (n * rate) : 1;
    plan.first_output = rate > 0 ? std::min(1 / rate, plan.duration) : plan.duration;
}

// Outputs at equal distances are taken one by one, and two times closer than this may be the same number.
void check_intervals(const scene::Scene& scene, const Plan& plan) {
    using scene::EventSpacing;
    const auto check = [&](const char* key, double every) {
        const double least = 1e-9 * plan.duration;
        if (every > 0 && every < least)
            fail(Exit::invalid_input,
                 "{}: {} s is out of range in a run of about {:.4g} s; allowed: at least {:.4g} s, a "
                 "billionth "
                 "of it. Give a longer interval, or -1 for none",
                 key, every, plan.duration, least);
    };
    if (scene.edmd.output_spacing == EventSpacing::events) return; // at least one event
    check("output.checkpoint_every", scene.output.checkpoint_every);
    check("edmd.sample_every", scene.edmd.sample_every);
    check("edmd.structure_every", scene.edmd.structure_every);
    if (scene.edmd.output_spacing != EventSpacing::time) return; // ever longer ones
    check("output.log_every", scene.output.log_every);
    check("output.picture_every", scene.output.picture_every);
    check("output.trajectory_every", scene.output.trajectory_every);
}

void say_what_is_skipped(Plan& plan) {
    const Setup& s = plan.setup;
    const auto skip = [&](bool condition, const char* text) {
        if (condition) plan.skipped.push_back(text);
    };
    skip(!s.rough, "spins: the particles are smooth");
    skip(s.restitution.model == laws::Restitution::Model::constant,
         "restitution by impact speed: it is constant");
    skip(s.classes.size() == 1, "classes: all particles are equal");
    skip(!s.has_walls(), "walls: all sides are periodic");
    skip(!s.falls(), "gravity");
    skip(s.kicks == 0, "thermostat");
    skip(s.shear == 0, "shear of the periodic images");
    skip(s.contact_time == 0 && s.elastic_speed == 0, "rules against inelastic collapse");
}

void warn(const scene::Scene& scene, Plan& plan) {
    const Setup& s = plan.setup;
    const double rate = analysis::collision_rate(gas_of(plan), highest_temperature(scene, s));
    if (s.contact_time * rate > 0.01)
        plan.warnings.push_back(fmt::format("edmd.contact_time is {:.2g} of the time between two collisions, "
                                            "more than 0.01: it changes the gas",
                                            s.contact_time * rate));
    const double speed = std::sqrt(scene.gas.temperature / scene.gas.mass);
    if (s.elastic_speed > 0.1 * speed)
        plan.warnings.push_back(
            fmt::format("edmd.elastic_speed is {:.2g} of the thermal speed, more than 0.1: "
                        "it changes the gas",
                        s.elastic_speed / speed));
    if (!s.is_plain() && s.falls() && s.has_walls() && s.contact_time == 0 && s.elastic_speed == 0) {
        bool dissipates = s.restitution.model == laws::Restitution::Model::constant && s.dissipates();
        for (const auto& axis : s.side)
            for (const Side& side : axis) dissipates = dissipates || side.eps_n < 1;
        if (dissipates)
            plan.warnings.push_back(
                "particles come to rest on a wall by infinitely many bounces, which ends the "
                "run; edmd.contact_time or edmd.elastic_speed prevents that");
    }
    if (plan.simple && plan.particles() > 500)
        plan.warnings.push_back("the simple algorithm takes a time that grows as the square of the number of "
                                "particles, for every event");
}

} // namespace

std::size_t Plan::particles() const {
    std::size_t sum = 0;
    for (const std::uint32_t n : amounts) sum += n;
    return sum;
}

analysis::HardGas gas_of(const Plan& plan) {
    const Setup& s = plan.setup;
    analysis::HardGas gas;
    gas.dimension = s.dimension;
    gas.density = static_cast<double>(plan.particles()) / s.volume();
    gas.correlation = laws::contact_correlation(s.dimension, packing_fraction(s, plan.amounts));
    gas.mass = s.classes[0].mass;
    gas.diameter = 2 * s.classes[0].radius;
    gas.restitution = s.restitution;
    gas.kicks = s.kicks;
    return gas;
}

analysis::GasFrame frame_of(const Plan& plan) {
    const Setup& s = plan.setup;
    analysis::GasFrame f;
    f.dimension = s.dimension;
    for (int d = 0; d < 3; ++d) { // with the room that a receding piston makes
        f.lower[d] = s.lower[d] + std::min(s.side[d][0].speed, 0.0) * plan.duration;
        f.upper[d] = s.upper[d] - std::min(s.side[d][1].speed, 0.0) * plan.duration;
    }
    f.particle_volume =
        packing_fraction(s, plan.amounts) * s.volume() / static_cast<double>(plan.particles());
    f.mass = s.classes[0].mass;
    f.rough = s.rough;
    f.moment = s.classes[0].moment();
    return f;
}

analysis::GasVessel vessel_of(const Setup& s, double time) {
    analysis::GasVessel v;
    v.dimension = s.dimension;
    for (int d = 0; d < 3; ++d) {
        const auto moved = [&](int upper) {
            const Side& side = s.side[d][upper];
            return side.oscillates() ? side.motion.displacement(time) : side.speed * time;
        };
        v.lower[d] = s.lower[d] + moved(0);
        v.upper[d] = s.upper[d] - moved(1);
    }
    for (const Curved& c : s.curved)
        v.round.push_back({{c.center[0], c.center[1], c.center[2]}, c.radius, c.axis, c.container});
    return v;
}

Plan make_plan(const scene::Scene& scene, simd::Isa isa, const ThreadChoice& threads) {
    Plan plan;
    plan.setup = setup_of(scene);
    plan.isa = isa;
    plan.threads = threads.count;
    plan.amounts.push_back(static_cast<std::uint32_t>(scene.gas.particles));
    for (const scene::Species& more : scene.species)
        plan.amounts.push_back(static_cast<std::uint32_t>(more.particles));
    const Setup& s = plan.setup;
    const bool room = s.has_room_for_cells();
    using scene::EventAlgorithm;
    if (scene.edmd.algorithm == EventAlgorithm::improved && !room)
        fail(Exit::invalid_input,
             "edmd.algorithm = \"improved\": the domain must have room for three cells of a diameter each "
             "where it is periodic, for four along a shear flow; use \"auto\" or \"simple\"");
    plan.simple = scene.edmd.algorithm == EventAlgorithm::simple || !room;
    if (plan.simple && !room)
        plan.chosen.push_back(
            "the simple algorithm: the box is too small for three cells in a periodic direction, or four "
            "along a shear flow");
    if (plan.simple && plan.particles() > 20000)
        fail(Exit::invalid_input,
             "edmd.algorithm: the simple algorithm keeps all pairs; allowed: up to 20000 particles, here {}",
             plan.particles());
    plan.replicas = static_cast<int>(scene.edmd.replicas);
    if (plan.replicas > 1)
        plan.threads = std::min(plan.threads, plan.replicas);
    else if (threads.automatic && plan.particles() < 10000)
        plan.threads = 1;
    plan.homogeneous = s.classes.size() == 1 && !s.rough && !s.has_walls() && !s.falls() && s.shear == 0;
    check_curved(plan);
    choose_kicks(scene, plan);
    expect_events(scene, plan);
    check_intervals(scene, plan);
    say_what_is_skipped(plan);
    warn(scene, plan);
    return plan;
}

double memory_bytes(const Plan& plan) {
    const auto n = static_cast<double>(plan.particles()), replicas = static_cast<double>(plan.replicas);
    if (plan.simple) return replicas * (n * n / 2 * 64 + n * 600);
    // Beside the state, what a checkpoint or an output holds, and a second copy where storage is sorted.
    return replicas * n * (200 + (plan.setup.rough ? 24 : 0) + 400);
}

std::unique_ptr<Algorithm> start(const scene::Scene& scene, const Plan& plan, simd::Isa isa, int replica) {
    const int threads = plan.replicas > 1 ? 1 : plan.threads;
    const Start start{static_cast<Start::Kind>(scene.edmd.start), scene.edmd.growth_rate, threads, isa};
    Setup setup = plan.setup;
    setup.seed += static_cast<std::uint64_t>(replica);
    const std::vector<Particle> particles =
        make_particles(setup, plan.amounts, scene.gas.temperature, scene.gas.spin_temperature, start);
    if (plan.simple) return std::make_unique<SimpleAlgorithm>(setup, particles);
    return std::make_unique<Simulation>(setup, particles, isa, threads);
}

Ensemble start_all(const scene::Scene& scene, const Plan& plan, simd::Isa isa) {
    std::vector<std::unique_ptr<Algorithm>> runs;
    runs.reserve(static_cast<std::size_t>(plan.replicas));
    for (int n = 0; n < plan.replicas; ++n) runs.push_back(start(scene, plan, isa, n));
    return {std::move(runs), plan.threads};
}

std::string describe(const scene::Scene& scene, const Plan& plan) {
    const Setup& s = plan.setup;
    const analysis::HardGas gas = gas_of(plan);
    const double rate = analysis::collision_rate(gas, scene.gas.temperature);
    std::string text;
    const auto line = [&](const char* label, const std::string& value) {
        text += fmt::format("  {:<26}{}\n", label, value);
    };
    text += fmt::format("{}\n\nScene\n", scene.title.empty() ? "(untitled)" : scene.title);
    line("particles", fmt::format("{} of {} kind{}", plan.particles(), s.classes.size(),
                                  s.classes.size() == 1 ? "" : "s"));
    line("density, packing fraction",
         fmt::format("{:.4g} 1/m^{}, {:.4g}", gas.density, s.dimension, packing_fraction(s, plan.amounts)));
    line("temperature", fmt::format("{:.4g} J at the start", scene.gas.temperature));
    text += "\nDerived, at the start\n";
    line("collisions", fmt::format("{:.4g} 1/s per particle", rate));
    line("contact correlation", fmt::format("{:.4g}", gas.correlation));
    line("events", fmt::format("about {:.4g}", plan.events));
    line("memory", fmt::format("about {:.3g} MB", memory_bytes(plan) / 1e6));
    text += "\nPlan\n";
    line("engine", fmt::format("edmd, {} dimensions, {} algorithm", s.dimension == 3 ? "three" : "two",
                               plan.simple ? "simple" : "improved"));
    static constexpr const char* starts[] = {"random where there is room, else a lattice", "random",
                                             "a lattice", "by growth of the radii"};
    line("start", starts[static_cast<std::size_t>(scene.edmd.start)]);
    if (!s.curved.empty()) line("curved walls", fmt::format("{}", s.curved.size()));
    if (s.shear != 0) line("shear flow", fmt::format("{:.4g} 1/s, periodic images glide along x", s.shear));
    if (s.kicks > 0) line("thermostat", fmt::format("white noise, kicks every {:.4g} s", s.kick_interval));
    line("kernels", plan.simple ? "none" : std::string(simd::isa_name(plan.isa)));
    if (plan.replicas > 1)
        line("replicas", fmt::format("{}, of seeds {} to {}", plan.replicas, s.seed,
                                     s.seed + static_cast<std::uint64_t>(plan.replicas) - 1));
    line("threads",
         plan.replicas > 1
             ? fmt::format("{}, each for one replica at a time", plan.threads)
             : fmt::format("{}, to predict all events at once; events are taken one by one", plan.threads));
    for (const std::string& reason : plan.chosen) text += "  " + reason + "\n";
    text += "\nSkipped, because the scene does not need it\n";
    for (const std::string& reason : plan.skipped) text += "  " + reason + "\n";
    for (const std::string& warning : plan.warnings) text += "\nWarning: " + warning + "\n";
    return text;
}

} // namespace sandlane::edmd
