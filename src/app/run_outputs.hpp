// Everything that a run leaves in its folder: log, checkpoints, effective scene, plan, report, and what the
// recorder of its engine writes.
#pragma once

#include "app/engine.hpp"
#include "app/timer.hpp"
#include "core/progress.hpp"
#include "output/checkpoint.hpp"
#include "output/folder.hpp"
#include "output/log.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace sandlane::app {

class RunOutputs {
public:
    // resume: continue the files of the folder where the checkpoint says; null: a fresh folder.
    RunOutputs(const std::filesystem::path& folder, Engine& engine, std::string plan_text,
               const output::Checkpoint* resume);

    // Next step after `step` at which something is due.
    [[nodiscard]] std::int64_t next_due(std::int64_t step) const;
    // Next time at which something is due by time, s.
    [[nodiscard]] double next_time() const;
    // Writes what is due at the present step; all = true writes every kind (start of a run).
    void write_due(bool all);
    // Last outputs, checkpoint, report, movie. Returns the path of the checkpoint.
    std::string finish(bool stopped, const std::string& summary, double rate);
    void be_quiet(bool quiet) { quiet_ = quiet; } // no warnings
    // Wall time of the runs that this one continues, s.
    void spent_before(double seconds) { wall_before_ = seconds; }

private:
    void open_files(const output::Checkpoint* resume);
    void write_movie();
    void write_report(double rate);
    std::string write_checkpoint();
    void warn(const std::string& text);

    Engine& engine_;
    output::RunFolder folder_;
    std::string plan_text_;
    Timer log_timer_, checkpoint_timer_;
    std::unique_ptr<output::LogWriter> log_;
    std::unique_ptr<Recorder> recorder_;
    std::vector<std::filesystem::path> checkpoints_; // oldest first
    bool quiet_ = false;
    Stopwatch clock_;
    double wall_before_ = 0;
};

} // namespace sandlane::app
