// Molecular dynamics as an engine of the program.
#pragma once

#include "app/engine.hpp"
#include "app/watcher.hpp"
#include "md/simulation.hpp"
#include "scene/initial_state.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sandlane::app {

class MdEngine final : public Engine {
public:
    // grains: hash of those that the scene describes.
    MdEngine(md::Simulation simulation, Hash128 grains)
        : simulation_(std::move(simulation)), grains_(grains), watcher_(simulation_.scene().watch) {}

    [[nodiscard]] const md::Simulation& simulation() const { return simulation_; }

    [[nodiscard]] const Words& words() const override;
    [[nodiscard]] const scene::Scene& scene() const override { return simulation_.scene(); }
    [[nodiscard]] simd::Isa isa() const override { return simulation_.plan().isa; }
    [[nodiscard]] int threads() const override { return simulation_.plan().threads; }

    void run(std::int64_t steps) override { simulation_.run(steps); }
    [[nodiscard]] std::int64_t step() const override { return simulation_.step(); }
    [[nodiscard]] std::int64_t steps() const override { return simulation_.plan().steps; }
    [[nodiscard]] double time() const override { return simulation_.time(); }
    [[nodiscard]] std::int64_t stride() const override { return simulation_.plan().largest_stride; }
    [[nodiscard]] std::int64_t taken() const override { return simulation_.taken(); }
    [[nodiscard]] double time_step() const override { return simulation_.plan().tick; }
    [[nodiscard]] double duration() const override { return scene().md.duration; }
    [[nodiscard]] std::size_t size() const override { return simulation_.state().size(); }

    [[nodiscard]] Hash128 state_hash() const override { return simulation_.state_hash(); }
    void serialise(ByteWriter& out) const override;
    void restore(const std::string& state, const std::string& origin) override;

    [[nodiscard]] std::vector<Difference> compare_state(const Engine& other) const override;
    [[nodiscard]] std::vector<Difference> compare_kernels(simd::Isa first, simd::Isa second) const override;
    [[nodiscard]] std::string kernels_compared() const override { return "Forces of the initial state"; }

    [[nodiscard]] std::vector<analysis::LogColumn> log_columns() const override;
    [[nodiscard]] std::vector<double> log_row() override;
    void judge() override { watcher_.judge(); }
    [[nodiscard]] std::vector<std::string> news() override;
    [[nodiscard]] std::unique_ptr<Recorder> recorder(const std::filesystem::path& folder,
                                                     const output::Checkpoint* resume) override;
    void draw(const std::filesystem::path& png, const Look& look) const override;
    [[nodiscard]] std::string plan_json() const override;
    [[nodiscard]] std::string summary_json() const override;
    [[nodiscard]] std::vector<std::pair<std::string, std::string>> report_rows() const override;

private:
    md::Simulation simulation_;
    Hash128 grains_;
    std::vector<std::string> warnings_; // not told yet
    bool overlap_warned_ = false;
    Watcher watcher_;
    std::size_t events_seen_ = 0;
};

} // namespace sandlane::app
