// Everything that a run leaves in its folder: log, trajectories, pictures, analyses, checkpoints, effective
// scene, report.
#pragma once

#include "app/run_analyses.hpp"
#include "core/progress.hpp"
#include "md/simulation.hpp"
#include "output/checkpoint.hpp"
#include "output/folder.hpp"
#include "output/log.hpp"
#include "output/picture_series.hpp"
#include "output/replay.hpp"
#include "output/writers.hpp"

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace sandlane::app {

class RunOutputs {
public:
    // resume: continue the files of the folder where the checkpoint says; null: a fresh folder.
    RunOutputs(const std::filesystem::path& folder, const md::Simulation& simulation, std::string plan_text,
               const output::Checkpoint* resume);

    // Next step after `step` at which something is due.
    [[nodiscard]] std::int64_t next_due(std::int64_t step) const;
    // Writes what is due at the present step; all = true writes every kind (start of a run).
    void write_due(const md::Simulation& simulation, bool all);
    // Last outputs, checkpoint, report, movie. Returns the path of the checkpoint.
    std::string finish(const md::Simulation& simulation, bool stopped, const std::string& summary,
                       double rate);
    void be_quiet(bool quiet) { quiet_ = quiet; } // no warnings
    // Wall time of the runs that this one continues, s.
    void spent_before(double seconds) { wall_before_ = seconds; }

private:
    void open_files(const output::Checkpoint* resume, std::int64_t stride);
    void write_log(const md::Simulation& simulation);
    void write_movie();
    void write_report(const md::Simulation& simulation, double rate);
    std::string write_checkpoint(const md::Simulation& simulation);
    void warn(const std::string& text);

    scene::Scene scene_;
    output::RunFolder folder_;
    std::string plan_text_;
    double dt_; // s
    std::int64_t log_steps_, picture_steps_, trajectory_steps_, checkpoint_steps_, replay_steps_;
    std::unique_ptr<output::LogWriter> log_;
    std::unique_ptr<output::PictureSeries> pictures_;
    std::map<std::string, std::unique_ptr<output::TrajectoryWriter>> trajectories_; // by name of bookmark
    std::unique_ptr<output::ReplayWriter> replay_;                                  // null without a report
    RunAnalyses analyses_;
    bool overlap_warned_ = false;
    std::size_t events_seen_ = 0;
    std::vector<std::filesystem::path> checkpoints_; // oldest first
    bool quiet_ = false;
    Stopwatch clock_;
    double wall_before_ = 0;
};

} // namespace sandlane::app
