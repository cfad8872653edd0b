// Direct simulation Monte Carlo as an engine of the program.
#pragma once

#include "app/gas_engine.hpp"
#include "app/gas_watch.hpp"
#include "app/watcher.hpp"
#include "dsmc/plan.hpp"
#include "dsmc/simulation.hpp"

#include <memory>
#include <string>
#include <vector>

namespace sandlane::app {

class DsmcEngine final : public GasEngine {
public:
    DsmcEngine(std::shared_ptr<const scene::Scene> scene, std::shared_ptr<const dsmc::Plan> plan,
               simd::Isa isa);

    [[nodiscard]] const dsmc::Simulation& simulation() const { return simulation_; }
    [[nodiscard]] analysis::Snapshot snapshot() const override;
    [[nodiscard]] GasSampling sampling() const override;
    [[nodiscard]] analysis::GasSamples make_samples() const override;
    void sample(analysis::GasSamples& samples) const override;
    [[nodiscard]] analysis::GasVessel vessel() const override {
        return dsmc::vessel_of(plan_->setup, simulation_.time());
    }
    [[nodiscard]] analysis::GasStructure make_structure() const override;
    [[nodiscard]] std::vector<analysis::StructureParticle> structure_particles() const override;

    [[nodiscard]] const Words& words() const override;
    [[nodiscard]] const scene::Scene& scene() const override { return *scene_; }
    [[nodiscard]] simd::Isa isa() const override { return isa_; }
    [[nodiscard]] int threads() const override { return plan_->threads; }

    void run(std::int64_t steps) override;
    [[nodiscard]] std::int64_t step() const override { return simulation_.step(); }
    [[nodiscard]] std::int64_t steps() const override;
    [[nodiscard]] std::int64_t expected_steps() const override { return plan_->steps; }
    [[nodiscard]] bool finished() const override;
    [[nodiscard]] double time() const override { return simulation_.time(); }
    [[nodiscard]] double time_step() const override;
    [[nodiscard]] double duration() const override { return scene_->dsmc.duration; }
    [[nodiscard]] std::size_t size() const override { return simulation_.size(); }

    [[nodiscard]] Hash128 state_hash() const override { return simulation_.state_hash(); }
    void serialise(ByteWriter& out) const override {
        watcher_.serialise(out);
        out.put_bytes(simulation_.serialise());
    }
    void restore(const std::string& state, const std::string& origin) override;

    [[nodiscard]] std::vector<Difference> compare_state(const Engine& other) const override;
    [[nodiscard]] std::vector<Difference> compare_kernels(simd::Isa first, simd::Isa second) const override;
    [[nodiscard]] std::string kernels_compared() const override { return "One step from the initial state"; }

    bool keep_decisions() override {
        simulation_.keep_decisions();
        return true;
    }
    [[nodiscard]] std::vector<Decision> take_decisions() override;
    [[nodiscard]] std::string tell(const Decision& decision) const override;

    [[nodiscard]] std::vector<analysis::LogColumn> log_columns() const override;
    [[nodiscard]] std::vector<double> log_row() override;
    void judge() override { watcher_.judge(); }
    [[nodiscard]] std::vector<std::string> news() override;
    [[nodiscard]] std::unique_ptr<Recorder> recorder(const std::filesystem::path& folder,
                                                     const output::Checkpoint* resume) override;
    [[nodiscard]] std::string plan_json() const override;
    [[nodiscard]] std::string summary_json() const override;
    [[nodiscard]] std::vector<std::pair<std::string, std::string>> report_rows() const override;

private:
    [[nodiscard]] std::size_t kinds() const { return plan_->setup.kinds(); }
    [[nodiscard]] std::vector<dsmc::Particle> thermal_particles() const; // without the flow of a sheared gas
    void add_theory(std::vector<double>& row) const;
    [[nodiscard]] GasTotals totals(const dsmc::Observables& o) const;
    [[nodiscard]] bool adaptive() const { return plan_->setup.adaptive; }

    std::shared_ptr<const scene::Scene> scene_;
    std::shared_ptr<const dsmc::Plan> plan_;
    simd::Isa isa_;
    dsmc::Simulation simulation_;
    dsmc::Counts told_; // what the last warnings were about
    bool theory_;
    Watcher watcher_;
    GasTotals start_;
};

} // namespace sandlane::app
