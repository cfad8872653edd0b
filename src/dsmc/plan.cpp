#include "dsmc/plan.hpp"

#include "analysis/gas_scene.hpp"
#include "core/error.hpp"
#include "dsmc/theory.hpp"
#include "dsmc/tiling.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sandlane::dsmc {

std::size_t all_particles(const scene::Scene& scene) {
    auto sum = static_cast<std::size_t>(scene.gas.particles);
    for (const scene::Species& more : scene.species) sum += static_cast<std::size_t>(more.particles);
    return sum;
}

namespace {

simd::GasSide side_of(const scene::GasSide& from, double mass) {
    simd::GasSide side;
    side.kind =
        from.kind == scene::SideKind::heated ? simd::GasSide::Kind::heated : simd::GasSide::Kind::reflecting;
    side.eps_n = from.restitution;
    side.eps_t = from.tangential_restitution;
    side.thermal_speed = std::sqrt(from.temperature / mass);
    side.accommodation = from.accommodation;
    analysis::copy(from.velocity, side.velocity);
    side.motion = analysis::oscillation_of(from);
    return side;
}

Setup setup_of(const scene::Scene& scene) {
    Setup s;
    s.dimension = static_cast<int>(scene.domain.dimension);
    analysis::copy(scene.domain.lower, s.lower);
    analysis::copy(scene.domain.upper, s.upper);
    if (s.dimension == 2) s.lower[2] = 0, s.upper[2] = 1;
    const scene::Gas& gas = scene.gas;
    for (int d = 0; d < s.dimension; ++d)
        s.walls.periodic[d] = scene.domain.periodic[static_cast<std::size_t>(d)];
    for (const scene::GasSide& side : scene.sides) {
        const auto n = static_cast<std::size_t>(side.side);
        s.walls.side[n / 2][n % 2] = side_of(side, gas.mass);
    }
    s.shear = scene.domain.shear_rate;
    const Vec& gravity = scene.domain.gravity;
    s.gravity[0] = gravity.x;
    s.gravity[1] = gravity.y;
    if (s.dimension == 3) s.gravity[2] = gravity.z;
    s.mass = gas.mass;
    s.diameter = gas.diameter;
    s.weight = gas.weight;
    s.rough = gas.tangential_restitution != 1;
    s.tangential = gas.tangential_restitution;
    s.friction = gas.friction;
    s.inertia = analysis::inertia_of(gas.body);
    s.restitution = analysis::restitution_of(gas);
    const auto n = static_cast<double>(all_particles(scene));
    for (const scene::Species& more : scene.species)
        s.others.push_back({more.mass, more.diameter, static_cast<double>(more.particles) / n});
    for (const scene::GasPair& pair : scene.gas_pairs)
        s.pairs.push_back({static_cast<std::size_t>(pair.between[0]),
                           static_cast<std::size_t>(pair.between[1]), pair.restitution, pair.dissipation});
    s.scheme = scene.dsmc.scheme;
    s.enskog = scene.dsmc.enskog;
    s.partners = static_cast<std::int32_t>(scene.dsmc.near_partners);
    s.dt = scene.dsmc.dt;
    s.adaptive = scene.dsmc.adaptive;
    s.kicks = scene.dsmc.heating;
    s.seed = static_cast<std::uint64_t>(scene.seed);
    return s;
}

// Of what moves the gas: the initial temperature, walls, noise in the long run.
double highest_temperature(const scene::Scene& scene, const Setup& s) {
    double highest = scene.gas.temperature;
    for (const auto& axis : s.walls.side)
        for (const simd::GasSide& side : axis) {
            const double speed = 2 * std::numbers::pi * side.motion.frequency * side.motion.amplitude;
            highest =
                std::max({highest, s.mass * side.thermal_speed * side.thermal_speed, s.mass * speed * speed});
        }
    return highest;
}

void choose_cells(const scene::Scene& scene, Plan& plan) {
    Setup& s = plan.setup;
    const double l = scales(s, all_particles(scene), scene.gas.temperature).free_path;
    double given = 1, volume = 1;
    int open = 0;
    for (int d = 0; d < s.dimension; ++d) {
        const auto cells = scene.dsmc.cells[static_cast<std::size_t>(d)];
        s.cells[d] = static_cast<std::int32_t>(std::max<std::int64_t>(1, cells));
        given *= s.cells[d];
        if (cells != 0) continue;
        ++open;
        volume *= s.upper[d] - s.lower[d];
    }
    if (open == 0) return;
    const double most = std::max(1.0, static_cast<double>(all_particles(scene)) / 10 / given);
    const double edge = std::pow(volume / most, 1.0 / open);
    const bool by_number = edge > l / 3;
    const double wanted = std::max(edge, l / 3);
    for (int d = 0; d < s.dimension; ++d) {
        if (scene.dsmc.cells[static_cast<std::size_t>(d)] != 0) continue;
        const double length = s.upper[d] - s.lower[d];
        s.cells[d] = static_cast<std::int32_t>(
            std::clamp(by_number ? std::floor(length / wanted) : std::ceil(length / wanted), 1.0, 1e6));
    }
    plan.chosen.push_back(
        by_number ? "cells hold about 10 particles; a third of the mean free path would be shorter"
                  : "cells are a third of the mean free path long");
}

void choose_dt(const scene::Scene& scene, Plan& plan, double hottest) {
    Setup& s = plan.setup;
    if (s.dt > 0) return;
    const Scales scale = scales(s, all_particles(scene), hottest);
    double dt = scale.collision_rate > 0 ? 0.1 / scale.collision_rate : 1e300;
    const char* reason = "0.1 collisions per particle";
    double lightest = s.mass;
    for (const Kind& k : s.others) lightest = std::min(lightest, k.mass);
    const double speed = 2 * std::sqrt(2 * hottest / lightest);
    for (int d = 0; d < s.dimension; ++d) {
        if (s.cells[d] == 1) continue;
        const double crossing = 0.5 * s.edge(d) / speed;
        if (crossing < dt) dt = crossing, reason = "fast particles cross half a cell";
    }
    if (s.adaptive && scale.cooling * dt > 0.02)
        dt = 0.02 / scale.cooling, reason = "2 % of the temperature are lost";
    for (const auto& axis : s.walls.side)
        for (const simd::GasSide& side : axis)
            if (side.moves() && 0.05 / side.motion.frequency < dt)
                dt = 0.05 / side.motion.frequency, reason = "a twentieth of an oscillation of a wall";
    s.dt = dt;
    plan.chosen.push_back(fmt::format("time step: {}", reason));
}

void check_cells(const Setup& s) {
    const Tiling tiling(s.cells, s.walls.periodic, 10);
    if (static_cast<double>(tiling.numbers()) > 2e9)
        fail(Exit::invalid_input, "dsmc.cells: too many cells ({} x {} x {})", s.cells[0], s.cells[1],
             s.cells[2]);
}

void say_what_is_skipped(Plan& plan) {
    const Setup& s = plan.setup;
    const auto skip = [&](bool condition, const char* text) {
        if (condition) plan.skipped.push_back(text);
    };
    skip(!s.rough, "spins: the particles are smooth");
    skip(s.others.empty(), "kinds of particles: all are equal");
    skip(s.restitution.model == laws::Restitution::Model::constant,
         "restitution by impact speed: it is constant");
    skip(!s.enskog, "pair correlation at contact");
    skip(s.partners == 1, "near partners");
    skip(s.kicks == 0, "thermostat");
    bool walls = false, falls = false;
    for (int d = 0; d < s.dimension; ++d) {
        walls = walls || !s.walls.periodic[d];
        falls = falls || s.gravity[d] != 0;
    }
    skip(!walls, "walls: all sides are periodic");
    skip(!falls, "gravity");
    skip(s.shear == 0, "shear of the periodic images");
}

} // namespace

Plan make_plan(const scene::Scene& scene, simd::Isa isa, const ThreadChoice& threads) {
    Plan plan;
    plan.setup = setup_of(scene);
    plan.isa = isa;
    choose_cells(scene, plan);
    const double hottest = highest_temperature(scene, plan.setup);
    choose_dt(scene, plan, hottest);
    const Setup& s = plan.setup;
    check_cells(s);
    const auto n = all_particles(scene);
    const double steps = s.adaptive ? adaptive_steps(s, n, scene.gas.temperature, scene.dsmc.duration)
                                    : scene.dsmc.duration / s.dt;
    if (steps > 9e15)
        fail(Exit::invalid_input, "dsmc.duration = {} s: {:.3g} steps of {} s are too many; shorten it",
             scene.dsmc.duration, steps, s.dt);
    plan.steps = static_cast<std::int64_t>(std::ceil(steps - 1e-9 * steps));
    double count = 1;
    for (int d = 0; d < s.dimension; ++d) count *= s.cells[d];
    const Tiling tiling(s.cells, s.walls.periodic, static_cast<double>(n) / count);
    plan.threads = threads.count;
    if (threads.automatic && tiling.tiles() < threads.count) {
        plan.threads = std::max(1, tiling.tiles());
        plan.chosen.push_back("fewer threads than CPUs: there are not more tiles of cells");
    }
    if (s.scheme == laws::CollisionScheme::maxwell)
        plan.chosen.push_back("collisions at the rate of the start, whatever the relative speed");
    else if (s.scheme != laws::CollisionScheme::no_time_counter)
        plan.chosen.push_back("collisions without vector kernels: this scheme is an oracle");
    plan.warnings = warnings(s, n, scene.gas.temperature);
    for (const auto& axis : s.walls.side)
        for (const simd::GasSide& side : axis)
            if (side.moves() && 10 * s.dt * side.motion.frequency > 1)
                plan.warnings.push_back(
                    fmt::format("a wall oscillates {:.2g} times in a step", s.dt * side.motion.frequency));
    say_what_is_skipped(plan);
    return plan;
}

double memory_bytes(const scene::Scene& scene, const Plan& plan) {
    const double row = plan.setup.rough ? 96 : 64;
    // Beside the rows, one list of particles for outputs and what a checkpoint holds; a gas of one cell is
    // sorted whole.
    const bool whole = plan.setup.cells[0] * plan.setup.cells[1] * plan.setup.cells[2] == 1;
    return static_cast<double>(all_particles(scene)) * ((whole ? 4 : 2.4) * row + sizeof(Particle)) +
           plan.threads * 1e6;
}

std::string describe(const scene::Scene& scene, const Plan& plan) {
    const Setup& s = plan.setup;
    const auto n = all_particles(scene);
    const Scales scale = scales(s, n, scene.gas.temperature);
    std::string text;
    const auto line = [&](const char* label, const std::string& value) {
        text += fmt::format("  {:<26}{}\n", label, value);
    };
    double count = 1, edge = 0;
    for (int d = 0; d < s.dimension; ++d) {
        count *= s.cells[d];
        if (s.cells[d] > 1) edge = std::max(edge, s.edge(d));
    }
    text += fmt::format("{}\n\nScene\n", scene.title.empty() ? "(untitled)" : scene.title);
    line("particles", fmt::format("{} of {} kind{}, each for {:.4g} real ones", n, s.kinds(),
                                  s.kinds() == 1 ? "" : "s", s.weight));
    line("density, packing fraction",
         fmt::format("{:.4g} 1/m^{}, {:.4g}", scale.density, s.dimension, scale.packing));
    line("temperature", fmt::format("{:.4g} J at the start", scene.gas.temperature));
    text += "\nDerived, at the start\n";
    line("collisions", fmt::format("{:.4g} 1/s per particle, {:.3g} per step", scale.collision_rate,
                                   scale.collision_rate * s.dt));
    line("mean free path", fmt::format("{:.4g} m", scale.free_path));
    line("contact correlation", fmt::format("{:.4g}", scale.correlation));
    line("cooling", fmt::format("{:.4g} 1/s", scale.cooling));
    if (is_homogeneous(s) && s.others.empty() && s.kicks == 0 &&
        s.restitution.model == laws::Restitution::Model::constant && s.restitution.eps < 1) {
        const analysis::CriticalLengths l =
            analysis::critical_lengths(s.dimension, s.restitution.eps, scale.density, s.diameter);
        line("critical lengths",
             fmt::format("{:.4g} m of vortices, {:.4g} m of clusters", l.shear, l.cluster));
    }
    if (is_homogeneous(s) && !s.others.empty() && s.kicks == 0) {
        std::string ratios;
        for (const double ratio : analysis::temperature_ratios(mixture_gas(s, n)))
            ratios += fmt::format("{}{:.4g}", ratios.empty() ? "" : " : ", ratio);
        line("temperatures of the kinds", ratios + " in the long run");
    }
    line("cells", fmt::format("{} x {}{}, {:.3g} particles each, {:.3g} mean free paths long", s.cells[0],
                              s.cells[1], s.dimension == 3 ? fmt::format(" x {}", s.cells[2]) : "",
                              static_cast<double>(n) / count, edge / scale.free_path));
    line("time step", fmt::format("{:.4g} s{}", s.dt, s.adaptive ? ", grows as 1/sqrt(T)" : ""));
    line("steps",
         fmt::format("{}{} ({:.4g} s)", s.adaptive ? "about " : "", plan.steps, scene.dsmc.duration));
    line("memory", fmt::format("about {:.3g} MB", memory_bytes(scene, plan) / 1e6));
    text += "\nPlan\n";
    line("engine", fmt::format("dsmc, {} dimensions", s.dimension == 3 ? "three" : "two"));
    line("kernels", std::string(simd::isa_name(plan.isa)));
    line("threads", std::to_string(plan.threads));
    for (const std::string& reason : plan.chosen) text += "  " + reason + "\n";
    text += "\nSkipped, because the scene does not need it\n";
    for (const std::string& reason : plan.skipped) text += "  " + reason + "\n";
    for (const std::string& warning : plan.warnings) text += "\nWarning: " + warning + "\n";
    return text;
}

} // namespace sandlane::dsmc
