#include "app/dsmc_engine.hpp"

#include "app/gas_recorder.hpp"
#include "app/json.hpp"
#include "core/error.hpp"
#include "dsmc/theory.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sandlane::app {

namespace {

void add_kinds(std::vector<analysis::LogColumn>& columns, const char* name, std::size_t kinds) {
    for (std::size_t k = 0; k < kinds && kinds > 1; ++k)
        columns.push_back({fmt::format("{}_{}", name, k), "J"});
}

std::vector<dsmc::Particle> start_of(const scene::Scene& scene, const dsmc::Plan& plan) {
    return dsmc::maxwellian(plan.setup, static_cast<std::uint32_t>(dsmc::all_particles(scene)),
                            scene.gas.temperature, scene.gas.spin_temperature);
}

// Particle by particle, one quantity after the other.
std::vector<Difference> differences(const std::vector<dsmc::Particle>& a,
                                    const std::vector<dsmc::Particle>& b) {
    std::vector<Difference> found;
    if (a.size() != b.size())
        return {{"particles", "", std::numeric_limits<double>::infinity(),
                 std::numeric_limits<double>::infinity(), 0, -1}};
    std::vector<std::int64_t> ids(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) ids[i] = a[i].id;
    const auto add = [&](const char* name, const char* unit, std::array<double, 3> dsmc::Particle::*values) {
        for (std::size_t d = 0; d < 3; ++d) {
            std::vector<double> first, second;
            for (const dsmc::Particle& p : a) first.push_back((p.*values)[d]);
            for (const dsmc::Particle& p : b) second.push_back((p.*values)[d]);
            found.push_back(difference(fmt::format("{} {}", name, "xyz"[d]), unit, ids, first, second));
        }
    };
    add("place", "m", &dsmc::Particle::place);
    add("velocity", "m/s", &dsmc::Particle::velocity);
    add("spin", "rad/s", &dsmc::Particle::spin);
    return found;
}

} // namespace

DsmcEngine::DsmcEngine(std::shared_ptr<const scene::Scene> scene, std::shared_ptr<const dsmc::Plan> plan,
                       simd::Isa isa)
    : scene_(std::move(scene)), plan_(std::move(plan)), isa_(isa),
      simulation_(plan_->setup, start_of(*scene_, *plan_), isa, plan_->threads),
      theory_(dsmc::is_homogeneous(plan_->setup)), watcher_(scene_->watch),
      start_(totals(simulation_.observe())) {}

GasTotals DsmcEngine::totals(const dsmc::Observables& o) const {
    const dsmc::Setup& s = plan_->setup;
    double mass = 0;
    for (std::size_t k = 0; k < kinds(); ++k) mass += s.kind(k).fraction * s.kind(k).mass;
    return {mass * s.weight * static_cast<double>(size()), o.energy, simulation_.wall_energy(), o.drift, 0};
}

const Words& DsmcEngine::words() const {
    static const Words words{"particle", "particles", "particles", "particle-steps", "steps", "s"};
    return words;
}

void DsmcEngine::run(std::int64_t steps) {
    simulation_.run(steps, adaptive() ? duration() : std::numeric_limits<double>::infinity());
}

// The number of steps of an adaptive run is known at its end only.
std::int64_t DsmcEngine::steps() const {
    return adaptive() ? std::numeric_limits<std::int64_t>::max() : plan_->steps;
}

bool DsmcEngine::finished() const {
    return adaptive() && time() >= duration();
}

double DsmcEngine::time_step() const {
    return adaptive() && plan_->steps > 0 ? duration() / static_cast<double>(plan_->steps) : plan_->setup.dt;
}

void DsmcEngine::restore(const std::string& state, const std::string& origin) {
    try {
        ByteReader in(state);
        watcher_.restore(in);
        simulation_.restore(in.rest());
    } catch (const Error& e) {
        fail(e.code(),
             "{}: {}. Overrides by --set must keep gas, species, domain, sides, cells and time step.", origin,
             e.what());
    }
}

std::vector<Difference> DsmcEngine::compare_state(const Engine& other) const {
    return differences(simulation_.particles(),
                       dynamic_cast<const DsmcEngine&>(other).simulation().particles());
}

std::vector<Difference> DsmcEngine::compare_kernels(simd::Isa first, simd::Isa second) const {
    dsmc::Simulation a = simulation_, b = simulation_;
    a.use(first);
    b.use(second);
    a.run(1);
    b.run(1);
    return differences(a.particles(), b.particles());
}

std::vector<Decision> DsmcEngine::take_decisions() {
    std::vector<Decision> all;
    for (const auto& [step, of] : simulation_.take_decisions())
        all.push_back({step, 0, of.cell, of.candidate, of.first, of.second, of.accepted ? 1U : 0U});
    return all;
}

std::string DsmcEngine::tell(const Decision& d) const {
    return fmt::format("step {}, cell {}, candidate {}: particles {} and {} {}", d.step, d.place, d.number,
                       d.first, d.second, d.outcome == 1 ? "collide" : "do not collide");
}

std::vector<analysis::LogColumn> DsmcEngine::log_columns() const {
    std::vector<analysis::LogColumn> columns = {{"time", "s"}, {"step", "1"}, {"temperature", "J"}};
    add_kinds(columns, "temperature", kinds());
    columns.insert(
        columns.end(),
        {{"a2", "1"}, {"energy", "J"}, {"wall_energy", "J"}, {"velocity_x", "m/s"}, {"velocity_y", "m/s"}});
    if (scene_->domain.dimension == 3) columns.push_back({"velocity_z", "m/s"});
    if (plan_->setup.rough) columns.push_back({"spin_temperature", "J"});
    if (plan_->setup.shear != 0)
        columns.push_back({"shear_stress", plan_->setup.dimension == 3 ? "Pa" : "N/m"});
    if (theory_) {
        columns.push_back({"theory_temperature", "J"});
        add_kinds(columns, "theory_temperature", kinds());
    }
    columns.push_back({"collisions_per_particle", "1"});
    columns.push_back({"acceptance", "1"});
    columns.push_back({"dt", "s"});
    watcher_.add_columns(columns);
    return columns;
}

void DsmcEngine::add_theory(std::vector<double>& row) const {
    const dsmc::Setup& s = plan_->setup;
    if (kinds() == 1) {
        row.push_back(dsmc::cooling_curve(s, size(), scene_->gas.temperature, {time()}).front());
        return;
    }
    const std::vector<double> of_kind = dsmc::kind_temperatures(s, size(), scene_->gas.temperature, time());
    double mean = 0;
    for (std::size_t k = 0; k < kinds(); ++k) mean += s.kind(k).fraction * of_kind[k];
    row.push_back(mean);
    row.insert(row.end(), of_kind.begin(), of_kind.end());
}

std::vector<double> DsmcEngine::log_row() {
    const dsmc::Observables o = simulation_.observe();
    const dsmc::Counts& counts = simulation_.counts();
    std::vector<double> row = {time(), static_cast<double>(step()), o.temperature};
    if (kinds() > 1) row.insert(row.end(), o.of_kind.begin(), o.of_kind.end());
    row.insert(row.end(), {o.fourth, o.energy, simulation_.wall_energy(), o.drift[0], o.drift[1]});
    if (scene_->domain.dimension == 3) row.push_back(o.drift[2]);
    if (plan_->setup.rough) row.push_back(o.spin_temperature);
    if (plan_->setup.shear != 0) row.push_back(o.shear_stress);
    if (theory_) add_theory(row);
    // Two particles in each.
    row.push_back(2 * static_cast<double>(counts.collisions) / static_cast<double>(size()));
    row.push_back(counts.candidates > 0
                      ? static_cast<double>(counts.collisions) / static_cast<double>(counts.candidates)
                      : 0.0);
    row.push_back(simulation_.dt());
    watcher_.see(watch_gas(start_, totals(o), time()), step(), time());
    watcher_.add_row(row);
    return row;
}

std::vector<std::string> DsmcEngine::news() {
    std::vector<std::string> news = watcher_.take_news();
    if (step() == 0) {
        news.insert(news.end(), plan_->warnings.begin(), plan_->warnings.end());
        return news;
    }
    const dsmc::Counts& now = simulation_.counts();
    const auto violations = static_cast<double>(now.violations),
               candidates = static_cast<double>(now.candidates);
    if (told_.violations == 0 && violations > 1e-6 * candidates && violations > 20) {
        news.push_back(
            fmt::format("t = {:.4g} s: {:.2g} of the candidates are faster than the majorant, more than "
                        "1e-6; shorten the time step",
                        time(), violations / candidates));
        told_.violations = now.violations;
    }
    if (told_.stuck == 0 && now.stuck > 0) {
        news.push_back(
            fmt::format("t = {:.4g} s: a particle met walls more than {} times in one flight and was "
                        "laid to rest there",
                        time(), simd::most_hits));
        told_.stuck = now.stuck;
    }
    return news;
}

std::unique_ptr<Recorder> DsmcEngine::recorder(const std::filesystem::path& folder,
                                               const output::Checkpoint* resume) {
    return std::make_unique<GasRecorder>(folder, *this, resume);
}

analysis::Snapshot DsmcEngine::snapshot() const {
    analysis::Snapshot s = snapshot_of_box(*scene_);
    s.step = step();
    s.time = time();
    for (const dsmc::Particle& p : simulation_.particles()) {
        const dsmc::Kind kind = plan_->setup.kind(p.kind);
        add_particle(s, p, 0.5 * kind.diameter, kind.mass, static_cast<std::int32_t>(p.kind));
    }
    return s;
}

GasSampling DsmcEngine::sampling() const {
    return {scene_->dsmc.sample_every, scene_->dsmc.sample_start, scene_->dsmc.structure_every};
}

analysis::GasSamples DsmcEngine::make_samples() const {
    const scene::Dsmc& d = scene_->dsmc;
    const auto axis = static_cast<std::size_t>(d.profile_axis);
    const std::int64_t bins = d.profile_bins > 0 ? d.profile_bins : plan_->setup.cells[axis];
    return {dsmc::frame_of(plan_->setup), static_cast<int>(axis), static_cast<std::size_t>(bins)};
}

std::vector<dsmc::Particle> DsmcEngine::thermal_particles() const {
    std::vector<dsmc::Particle> all = simulation_.particles();
    if (plan_->setup.shear != 0)
        for (dsmc::Particle& p : all) p.velocity[0] -= plan_->setup.flow(p.place[1]);
    return all;
}

void DsmcEngine::sample(analysis::GasSamples& samples) const {
    const dsmc::Setup& s = plan_->setup;
    std::vector<analysis::GasRatio> ratio;
    for (std::size_t k = 0; k < kinds(); ++k) {
        const dsmc::Kind kind = s.kind(k);
        const double mass = kind.mass / s.mass, size = kind.diameter / s.diameter;
        ratio.push_back({mass, mass * size * size});
    }
    samples.add(thermal_particles(), vessel(), [&](const dsmc::Particle& p) { return ratio[p.kind]; });
}

analysis::GasStructure DsmcEngine::make_structure() const {
    const dsmc::Setup& s = plan_->setup;
    analysis::StructurePlan plan;
    plan.gas = dsmc::frame_of(s);
    std::copy(std::begin(s.walls.periodic), std::end(s.walls.periodic), plan.periodic);
    plan.reach = scene_->dsmc.cluster_reach;
    plan.cell = counting_cell(dsmc::scales(s, size(), scene_->gas.temperature).free_path, s.volume(), size(),
                              s.dimension);
    return analysis::GasStructure(plan);
}

std::vector<analysis::StructureParticle> DsmcEngine::structure_particles() const {
    std::vector<analysis::StructureParticle> all;
    const dsmc::Setup& s = plan_->setup;
    const double larger = std::pow(s.weight, 1.0 / s.dimension);
    for (const dsmc::Particle& p : thermal_particles()) {
        const dsmc::Kind kind = s.kind(p.kind);
        all.push_back({p.place, p.velocity, kind.mass, 0.5 * larger * kind.diameter});
    }
    return all;
}

std::string DsmcEngine::plan_json() const {
    const dsmc::Setup& s = plan_->setup;
    return fmt::format(
        R"({{"engine": "dsmc", "cells": [{}, {}, {}], "rough": {}, "dt": {}, "adaptive": {}}})", s.cells[0],
        s.cells[1], s.cells[2], s.rough, json_number(s.dt), s.adaptive);
}

std::string DsmcEngine::summary_json() const {
    const dsmc::Counts& counts = simulation_.counts();
    return fmt::format(R"("collisions": {}, "candidates": {}, "violations": {}, )", counts.collisions,
                       counts.candidates, counts.violations) +
           watcher_.json();
}

std::vector<std::pair<std::string, std::string>> DsmcEngine::report_rows() const {
    const dsmc::Observables o = simulation_.observe();
    std::vector<std::pair<std::string, std::string>> rows = {
        {"Particles", std::to_string(size())},
        {"Simulated time", fmt::format("{:.4g} s", time())},
        {"Steps", std::to_string(step())},
        {"Time step", fmt::format("{:.4g} s", simulation_.dt())},
        {"Collisions per particle",
         fmt::format("{:.4g}",
                     2 * static_cast<double>(simulation_.counts().collisions) / static_cast<double>(size()))},
        {"Temperature", fmt::format("{:.4g} J", o.temperature)},
        {"Second Sonine coefficient", fmt::format("{:.4f}", o.fourth)}};
    watcher_.add_report_rows(rows);
    return rows;
}

namespace {

class DsmcSetup final : public Setup {
public:
    DsmcSetup(scene::Scene scene, const Machine& machine)
        : scene_(std::make_shared<const scene::Scene>(std::move(scene))),
          plan_(std::make_shared<const dsmc::Plan>(dsmc::make_plan(*scene_, machine.isa, machine.threads))) {}

    [[nodiscard]] double memory_bytes() const override { return dsmc::memory_bytes(*scene_, *plan_); }
    [[nodiscard]] std::string description() const override { return dsmc::describe(*scene_, *plan_); }
    [[nodiscard]] std::string json() const override {
        const dsmc::Setup& s = plan_->setup;
        const auto n = dsmc::all_particles(*scene_);
        const dsmc::Scales scale = dsmc::scales(s, n, scene_->gas.temperature);
        return fmt::format(
            R"({{"particles": {}, "cells": [{}, {}, {}], "dt": {}, "steps": {}, "collision_rate": {}, )"
            R"("mean_free_path": {}, "warnings": {}, "memory_bytes": {}, "isa": "{}", "threads": {}}})",
            n, s.cells[0], s.cells[1], s.cells[2], json_number(s.dt), plan_->steps,
            json_number(scale.collision_rate), json_number(scale.free_path), plan_->warnings.size(),
            memory_bytes(), simd::isa_name(plan_->isa), plan_->threads);
    }
    [[nodiscard]] std::unique_ptr<Engine> start() override { return start(plan_->isa); }
    [[nodiscard]] std::unique_ptr<Engine> start(simd::Isa isa) override {
        return std::make_unique<DsmcEngine>(scene_, plan_, isa);
    }

private:
    std::shared_ptr<const scene::Scene> scene_;
    std::shared_ptr<const dsmc::Plan> plan_;
};

} // namespace

std::unique_ptr<Setup> prepare_dsmc(scene::Scene scene, const Machine& machine) {
    return std::make_unique<DsmcSetup>(std::move(scene), machine);
}

} // namespace sandlane::app
