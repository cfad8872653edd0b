// What only a run of grains leaves in its folder: trajectories, pictures, analyses, replay.
#pragma once

#include "app/engine.hpp"
#include "app/md_analyses.hpp"
#include "md/simulation.hpp"
#include "output/picture_series.hpp"
#include "output/replay.hpp"
#include "output/writers.hpp"

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

namespace sandlane::app {

class MdRecorder final : public Recorder {
public:
    MdRecorder(const std::filesystem::path& folder, const md::Simulation& simulation,
               const output::Checkpoint* resume);

    [[nodiscard]] std::int64_t next_due(std::int64_t step) const override;
    void write_due(bool all) override;
    void add_bookmarks(std::map<std::string, std::string>& bookmarks) override;
    void finish() override { analyses_.draw(simulation_); }
    [[nodiscard]] std::int64_t pictures() const override { return pictures_.count(); }
    void add_to_report(output::ReportInput& report) const override;

private:
    const md::Simulation& simulation_;
    std::filesystem::path folder_;
    std::int64_t picture_steps_, trajectory_steps_, replay_steps_;
    output::PictureSeries pictures_;
    std::map<std::string, std::unique_ptr<output::TrajectoryWriter>> trajectories_; // by name of bookmark
    std::unique_ptr<output::ReplayWriter> replay_;                                  // null without a report
    MdAnalyses analyses_;
};

} // namespace sandlane::app
