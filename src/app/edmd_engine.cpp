// Event-driven dynamics as an engine of the program. A step is an event.
#include "app/edmd_log.hpp"
#include "app/gas_engine.hpp"
#include "app/gas_recorder.hpp"
#include "app/gas_watch.hpp"
#include "app/json.hpp"
#include "app/watcher.hpp"
#include "core/bytes.hpp"
#include "core/error.hpp"
#include "edmd/plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sandlane::app {

namespace {

std::vector<Difference> differences(const std::vector<edmd::Particle>& a,
                                    const std::vector<edmd::Particle>& b) {
    std::vector<Difference> found;
    std::vector<std::int64_t> ids(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) ids[i] = a[i].id;
    const auto add = [&](const char* name, const char* unit, std::array<double, 3> edmd::Particle::*values) {
        for (std::size_t d = 0; d < 3; ++d) {
            std::vector<double> first, second;
            for (const edmd::Particle& p : a) first.push_back((p.*values)[d]);
            for (const edmd::Particle& p : b) second.push_back((p.*values)[d]);
            found.push_back(difference(fmt::format("{} {}", name, "xyz"[d]), unit, ids, first, second));
        }
    };
    add("place", "m", &edmd::Particle::place);
    add("velocity", "m/s", &edmd::Particle::velocity);
    add("spin", "rad/s", &edmd::Particle::spin);
    return found;
}

// Of all replicas, one after the other.
std::vector<edmd::Particle> all_particles(const edmd::Ensemble& runs) {
    std::vector<edmd::Particle> all;
    for (std::size_t n = 0; n < runs.size(); ++n)
        for (edmd::Particle& p : runs[n].particles()) {
            p.id += static_cast<std::uint32_t>(n * runs.first().size());
            all.push_back(p);
        }
    return all;
}

class EdmdEngine final : public GasEngine {
public:
    EdmdEngine(std::shared_ptr<const scene::Scene> scene, std::shared_ptr<const edmd::Plan> plan,
               simd::Isa isa)
        : scene_(std::move(scene)), plan_(std::move(plan)), isa_(isa),
          runs_(edmd::start_all(*scene_, *plan_, isa)), log_(*plan_, scene_->gas.temperature),
          watcher_(scene_->watch), events_(runs_.size()) {
        for (std::size_t n = 0; n < runs_.size(); ++n)
            start_.push_back(totals(n, edmd::observe(plan_->setup, runs_[n].particles())));
    }

    [[nodiscard]] const Words& words() const override {
        static const Words words{"particle", "particles", "particles", "events", "events", "s"};
        return words;
    }
    [[nodiscard]] const scene::Scene& scene() const override { return *scene_; }
    [[nodiscard]] simd::Isa isa() const override { return isa_; }
    [[nodiscard]] int threads() const override { return plan_->threads; }

    void run(std::int64_t steps) override { run_until(steps, std::numeric_limits<double>::infinity()); }
    void run_until(std::int64_t steps, double until) override {
        const double end =
            scene_->edmd.duration > 0 ? scene_->edmd.duration : std::numeric_limits<double>::infinity();
        const double to = std::min(end, until);
        if (runs_.run(steps, to) == steps) return;
        reached_ = std::isfinite(to) ? to : time();
        ended_ = end <= until;
    }
    [[nodiscard]] double reached() const override { return reached_; }
    [[nodiscard]] std::int64_t step() const override {
        return static_cast<std::int64_t>(runs_.first().log().count());
    }
    [[nodiscard]] std::int64_t steps() const override {
        return scene_->edmd.events > 0 ? scene_->edmd.events : std::numeric_limits<std::int64_t>::max();
    }
    [[nodiscard]] std::int64_t expected_steps() const override {
        return static_cast<std::int64_t>(std::min(plan_->events, 9e18));
    }
    [[nodiscard]] bool finished() const override { return ended_; }
    [[nodiscard]] double work(std::int64_t steps) const override {
        return static_cast<double>(steps) * static_cast<double>(runs_.size()); // about
    }
    [[nodiscard]] double time() const override { return runs_.first().time(); }
    // Intervals that the scene does not give are parts of its duration, or else of its events.
    [[nodiscard]] Pace pace(bool asked) const override {
        using scene::EventSpacing;
        const EventSpacing spacing = scene_->edmd.output_spacing;
        const bool known = asked || scene_->edmd.duration > 0;
        if (spacing == EventSpacing::log_time) return {Pace::Kind::log_time, plan_->first_output};
        if (spacing == EventSpacing::time && known) return {Pace::Kind::time, 0};
        return {};
    }
    // On the average, where intervals are counted in events.
    [[nodiscard]] double time_step() const override { return plan_->duration / plan_->events; }
    [[nodiscard]] double duration() const override { return plan_->duration; }
    [[nodiscard]] std::size_t size() const override { return runs_.first().size(); }

    [[nodiscard]] Hash128 state_hash() const override { return runs_.state_hash(); }
    void serialise(ByteWriter& out) const override {
        log_.serialise(out);
        watcher_.serialise(out);
        out.put_text(runs_.serialise());
        out.put(reached_);
    }
    void restore(const std::string& state, const std::string& origin) override {
        try {
            ByteReader in(state);
            log_.restore(in);
            watcher_.restore(in);
            runs_.restore(in.get_text());
            reached_ = in.get<double>();
        } catch (const Error& e) {
            fail(e.code(),
                 "{}: {}. Overrides by --set must keep gas, species, domain, sides, cells, heating and "
                 "replicas.",
                 origin, e.what());
        }
    }

    [[nodiscard]] std::vector<Difference> compare_state(const Engine& other) const override {
        return differences(all_particles(runs_), all_particles(dynamic_cast<const EdmdEngine&>(other).runs_));
    }
    [[nodiscard]] std::vector<Difference> compare_kernels(simd::Isa first, simd::Isa second) const override {
        const auto after = [&](simd::Isa isa) {
            const std::unique_ptr<edmd::Algorithm> run = edmd::start(*scene_, *plan_, isa);
            run->restore(runs_.first().serialise());
            run->run(100);
            return run->particles();
        };
        return differences(after(first), after(second));
    }
    [[nodiscard]] std::string kernels_compared() const override {
        return "100 events from the present state";
    }

    bool keep_decisions() override {
        for (std::size_t n = 0; n < runs_.size(); ++n) runs_[n].log().record(&events_[n]);
        return true;
    }
    [[nodiscard]] std::vector<Decision> take_decisions() override;
    [[nodiscard]] std::string tell(const Decision& decision) const override;

    [[nodiscard]] std::vector<analysis::LogColumn> log_columns() const override {
        auto columns = log_.columns();
        watcher_.add_columns(columns);
        return columns;
    }
    [[nodiscard]] std::vector<double> log_row() override;
    void judge() override { watcher_.judge(); }
    [[nodiscard]] std::vector<std::string> news() override {
        std::vector<std::string> news = watcher_.take_news();
        if (step() == 0) news.insert(news.end(), plan_->warnings.begin(), plan_->warnings.end());
        return news;
    }
    [[nodiscard]] std::unique_ptr<Recorder> recorder(const std::filesystem::path& folder,
                                                     const output::Checkpoint* resume) override {
        return std::make_unique<GasRecorder>(folder, *this, resume);
    }
    [[nodiscard]] analysis::Snapshot snapshot() const override;
    [[nodiscard]] GasSampling sampling() const override {
        return {scene_->edmd.sample_every, scene_->edmd.sample_start, scene_->edmd.structure_every};
    }
    [[nodiscard]] analysis::GasSamples make_samples() const override {
        return {edmd::frame_of(*plan_), static_cast<int>(scene_->edmd.profile_axis),
                static_cast<std::size_t>(scene_->edmd.profile_bins)};
    }
    void sample(analysis::GasSamples& samples) const override {
        std::vector<analysis::GasRatio> ratio;
        for (const edmd::Class& c : plan_->setup.classes)
            ratio.push_back(
                {c.mass / plan_->setup.classes[0].mass, c.moment() / plan_->setup.classes[0].moment()});
        for (std::size_t n = 0; n < runs_.size(); ++n)
            samples.add(edmd::thermal_particles(plan_->setup, runs_[n].particles()), vessel(),
                        [&](const edmd::Particle& p) { return ratio[p.kind]; });
    }
    [[nodiscard]] analysis::GasVessel vessel() const override {
        return edmd::vessel_of(plan_->setup, time());
    }
    [[nodiscard]] analysis::GasStructure make_structure() const override {
        const edmd::Setup& s = plan_->setup;
        analysis::StructurePlan plan;
        plan.gas = edmd::frame_of(*plan_);
        std::copy(std::begin(s.periodic), std::end(s.periodic), plan.periodic);
        plan.reach = scene_->edmd.cluster_reach;
        const analysis::HardGas gas = edmd::gas_of(*plan_);
        const double speed = std::sqrt(scene_->gas.temperature / gas.mass);
        const double rate = analysis::collision_rate(gas, scene_->gas.temperature);
        plan.cell = counting_cell(1.5 * speed / rate, s.volume(), size(), s.dimension);
        return analysis::GasStructure(plan);
    }
    [[nodiscard]] std::vector<analysis::StructureParticle> structure_particles() const override {
        std::vector<analysis::StructureParticle> all;
        for (const edmd::Particle& p : edmd::thermal_particles(plan_->setup, runs_.first().particles())) {
            const edmd::Class& c = plan_->setup.classes[p.kind];
            all.push_back({p.place, p.velocity, c.mass, c.radius});
        }
        return all;
    }
    [[nodiscard]] std::string plan_json() const override {
        return fmt::format(R"({{"engine": "edmd", "algorithm": "{}", "rough": {}, "classes": {}}})",
                           plan_->simple ? "simple" : "improved", plan_->setup.rough,
                           plan_->setup.classes.size());
    }
    [[nodiscard]] std::string summary_json() const override {
        const edmd::Tally t = tally();
        return fmt::format(R"("collisions": {}, "wall_hits": {}, "elastic": {}, "smallest_gap": {}, )"
                           R"("event_log_hash": "{:016x}", )",
                           t.collisions, t.wall_hits, t.elastic, json_number(t.smallest_gap),
                           runs_.log_hash()) +
               watcher_.json();
    }
    [[nodiscard]] std::vector<std::pair<std::string, std::string>> report_rows() const override;

private:
    [[nodiscard]] GasTotals totals(std::size_t run, const edmd::Observables& o) const {
        const edmd::Tally& t = runs_[run].tally();
        double mass = 0;
        for (std::size_t k = 0; k < plan_->amounts.size(); ++k)
            mass += static_cast<double>(plan_->amounts[k]) * plan_->setup.classes[k].mass;
        return {mass, o.energy, t.wall_energy, o.drift, -t.smallest_gap / plan_->setup.smallest_radius()};
    }
    // Of all replicas.
    [[nodiscard]] edmd::Tally tally() const {
        edmd::Tally sum;
        for (std::size_t n = 0; n < runs_.size(); ++n) sum.add(runs_[n].tally());
        return sum;
    }

    std::shared_ptr<const scene::Scene> scene_;
    std::shared_ptr<const edmd::Plan> plan_;
    simd::Isa isa_;
    edmd::Ensemble runs_;
    bool ended_ = false; // nothing is left to happen until the end
    double reached_ = 0; // s
    EdmdLog log_;
    Watcher watcher_;
    std::vector<GasTotals> start_;                 // of each
    std::vector<std::vector<edmd::Event>> events_; // of each, since they were taken the last time
};

std::vector<Decision> EdmdEngine::take_decisions() {
    std::vector<Decision> all;
    for (std::size_t n = 0; n < runs_.size(); ++n) {
        auto number = static_cast<std::int64_t>(runs_[n].log().count() - events_[n].size());
        for (const edmd::Event& e : events_[n])
            all.push_back({++number, e.time, static_cast<std::uint32_t>(n), 0, e.first, e.second,
                           static_cast<std::uint32_t>(e.kind)});
        events_[n].clear();
    }
    return all;
}

std::string EdmdEngine::tell(const Decision& d) const {
    const bool pair = d.outcome == static_cast<std::uint32_t>(edmd::Event::Kind::pair);
    return fmt::format("{}event {} at {} s of its epoch: particle {} {}",
                       runs_.size() > 1 ? fmt::format("replica {}, ", d.place) : "", d.step, d.time, d.first,
                       pair ? fmt::format("and particle {}", d.second)
                       : d.second > 5
                           ? fmt::format("at curved_walls[{}]", d.second - 6)
                           : fmt::format("at side {}{}", "-+"[d.second % 2], "xyz"[d.second / 2 % 3]));
}

std::vector<double> EdmdEngine::log_row() {
    std::vector<edmd::Observables> seen;
    analysis::Watched worst;
    for (std::size_t n = 0; n < runs_.size(); ++n) {
        seen.push_back(edmd::observe(plan_->setup, runs_[n].particles()));
        const analysis::Watched w = watch_gas(start_[n], totals(n, seen[n]), time());
        for (std::size_t q = 0; q < analysis::watched::count; ++q) {
            worst.value[q] = std::max(worst.value[q], w.value[q]);
            worst.time[q] = w.time[q];
        }
    }
    std::vector<double> row = log_.row(runs_, seen);
    watcher_.see(worst, step(), time());
    watcher_.add_row(row);
    return row;
}

analysis::Snapshot EdmdEngine::snapshot() const {
    analysis::Snapshot s = snapshot_of_box(*scene_);
    s.step = step();
    s.time = time();
    for (const edmd::Particle& p : runs_.first().particles()) {
        const edmd::Class& c = plan_->setup.classes[p.kind];
        add_particle(s, p, c.radius, c.mass, static_cast<std::int32_t>(p.kind));
    }
    return s;
}

std::vector<std::pair<std::string, std::string>> EdmdEngine::report_rows() const {
    const edmd::Tally t = tally();
    std::vector<double> temperature;
    for (std::size_t n = 0; n < runs_.size(); ++n)
        temperature.push_back(edmd::observe(plan_->setup, runs_[n].particles()).temperature);
    const edmd::MeanError mean = edmd::mean_of(temperature);
    const auto particles = static_cast<double>(size() * runs_.size());
    std::vector<std::pair<std::string, std::string>> rows;
    const analysis::HardGas gas = edmd::gas_of(*plan_);
    if (plan_->homogeneous && plan_->setup.kicks == 0 &&
        gas.restitution.model == laws::Restitution::Model::constant && gas.restitution.eps < 1) {
        const analysis::CriticalLengths l =
            analysis::critical_lengths(gas.dimension, gas.restitution.eps, gas.density, gas.diameter);
        rows.push_back({"Critical length of vortices, of clusters",
                        fmt::format("{:.4g} m, {:.4g} m (dilute gas)", l.shear, l.cluster)});
    }
    rows.insert(
        rows.begin(),
        {{"Particles", runs_.size() > 1 ? fmt::format("{} in each of {} replicas", size(), runs_.size())
                                        : std::to_string(size())},
         {"Simulated time", fmt::format("{:.4g} s", time())},
         {"Collisions", std::to_string(t.collisions)},
         {"Hits of walls", std::to_string(t.wall_hits)},
         {"Collisions per particle",
          fmt::format("{:.4g}", 2 * static_cast<double>(t.collisions) / particles)},
         {"Temperature", runs_.size() > 1 ? fmt::format("{:.4g} ± {:.2g} J", mean.mean, mean.error)
                                          : fmt::format("{:.4g} J", temperature.front())},
         {"Smallest gap at a contact", fmt::format("{:.2g} m", t.smallest_gap)}});
    return rows;
}

class EdmdSetup final : public Setup {
public:
    EdmdSetup(scene::Scene scene, const Machine& machine)
        : scene_(std::make_shared<const scene::Scene>(std::move(scene))),
          plan_(std::make_shared<const edmd::Plan>(edmd::make_plan(*scene_, machine.isa, machine.threads))) {}

    [[nodiscard]] double memory_bytes() const override { return edmd::memory_bytes(*plan_); }
    [[nodiscard]] std::string description() const override { return edmd::describe(*scene_, *plan_); }
    [[nodiscard]] std::string json() const override {
        return fmt::format(
            R"({{"particles": {}, "packing_fraction": {}, "collision_rate": {}, "events": {}, "algorithm": "{}", )"
            R"("warnings": {}, "memory_bytes": {}, "isa": "{}", "threads": {}}})",
            plan_->particles(), json_number(edmd::packing_fraction(plan_->setup, plan_->amounts)),
            json_number(analysis::collision_rate(edmd::gas_of(*plan_), scene_->gas.temperature)),
            json_number(plan_->events), plan_->simple ? "simple" : "improved", plan_->warnings.size(),
            memory_bytes(), simd::isa_name(plan_->isa), plan_->threads);
    }
    [[nodiscard]] std::unique_ptr<Engine> start() override { return start(plan_->isa); }
    [[nodiscard]] std::unique_ptr<Engine> start(simd::Isa isa) override {
        return std::make_unique<EdmdEngine>(scene_, plan_, isa);
    }

private:
    std::shared_ptr<const scene::Scene> scene_;
    std::shared_ptr<const edmd::Plan> plan_;
};

} // namespace

std::unique_ptr<Setup> prepare_edmd(scene::Scene scene, const Machine& machine) {
    return std::make_unique<EdmdSetup>(std::move(scene), machine);
}

} // namespace sandlane::app
