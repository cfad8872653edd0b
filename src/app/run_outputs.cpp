#include "app/run_outputs.hpp"

#include "app/interval.hpp"
#include "app/run_log.hpp"
#include "core/file.hpp"
#include "output/picture.hpp"
#include "output/report.hpp"
#include "scene/reader.hpp"
#include "scene/schema.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace sandlane::app {

namespace fs = std::filesystem;

namespace {

std::string checkpoint_name(std::int64_t step) {
    return fmt::format("{:012}.checkpoint", step);
}

// Those of the run before, up to the one it goes on from. Later ones will be written again.
std::vector<fs::path> earlier_checkpoints(const fs::path& folder, std::int64_t step) {
    std::vector<fs::path> found;
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(folder, ignored)) {
        const fs::path name = entry.path().filename();
        if (name.extension() == ".checkpoint" && name.string() <= checkpoint_name(step))
            found.push_back(folder / name);
    }
    std::sort(found.begin(), found.end());
    return found;
}

} // namespace

RunOutputs::RunOutputs(const fs::path& folder, const md::Simulation& sim, std::string plan_text,
                       const output::Checkpoint* resume)
    : scene_(sim.scene()),
      folder_(folder, resume != nullptr ? output::RunFolder::Start::resume : output::RunFolder::Start::fresh),
      plan_text_(std::move(plan_text)), dt_(sim.plan().tick) {
    const scene::Output& o = scene_.output;
    const double duration = scene_.md.duration;
    const std::int64_t stride = sim.plan().largest_stride;
    const auto every = [&](double seconds, double parts) {
        return interval(seconds, duration, parts, dt_, stride);
    };
    log_steps_ = every(o.log_every, 200);
    picture_steps_ = every(o.picture_every, 20);
    trajectory_steps_ = every(o.trajectory_every, 100);
    checkpoint_steps_ = every(o.checkpoint_every, 0);
    replay_steps_ = o.report ? every(0, 200) : never;
    try {
        open_files(resume, stride);
    } catch (...) {
        if (resume == nullptr) folder_.discard();
        throw;
    }
    if (resume == nullptr) return;
    checkpoints_ = earlier_checkpoints(folder_.checkpoints(), resume->step);
    events_seen_ = sim.events().size(); // the run before has told them
}

void RunOutputs::open_files(const output::Checkpoint* resume, std::int64_t stride) {
    write_file_atomically(folder_.path() / "scene.toml", scene::write_scene(scene_));
    write_file_atomically(folder_.path() / "plan.txt", plan_text_);
    log_ = std::make_unique<output::LogWriter>(folder_.path() / "log.csv", log_columns(scene_),
                                               output::bookmark_in(resume, "log"));
    pictures_ = std::make_unique<output::PictureSeries>(folder_.path() / "pictures", scene_,
                                                        output::bookmark_in(resume, "pictures"));
    scene::Scene resolved = scene_;
    resolved.md.dt = dt_;
    if (trajectory_steps_ != never)
        for (const scene::Trajectory kind : scene_.output.trajectory) {
            const std::string name(scene::trajectory_choices()[static_cast<std::size_t>(kind)]);
            trajectories_[name] = output::make_trajectory_writer(kind, folder_.path(), resolved,
                                                                 output::bookmark_in(resume, name));
        }
    analyses_.open(folder_.path(), resolved, stride, resume);
    if (replay_steps_ != never)
        replay_ =
            std::make_unique<output::ReplayWriter>(folder_.path(), output::bookmark_in(resume, "replay"));
}

std::int64_t RunOutputs::next_due(std::int64_t step) const {
    std::int64_t next = analyses_.next_due(step);
    for (const std::int64_t every :
         {log_steps_, picture_steps_, trajectory_steps_, checkpoint_steps_, replay_steps_})
        next = std::min(next, next_multiple(step, every));
    return next;
}

void RunOutputs::write_due(const md::Simulation& sim, bool all) {
    const auto due = [&](std::int64_t every) { return every != never && (all || sim.step() % every == 0); };
    if (due(log_steps_)) write_log(sim);
    const bool picture = due(picture_steps_), trajectory = due(trajectory_steps_),
               replay = due(replay_steps_), analysis = analyses_.due(sim.step(), all);
    if (picture || trajectory || replay || analysis) {
        const analysis::Snapshot snapshot = sim.snapshot();
        if (picture) pictures_->write(snapshot);
        if (trajectory)
            for (auto& [name, writer] : trajectories_) writer->write(snapshot);
        if (replay) replay_->write(snapshot);
        if (analysis) analyses_.write_due(sim, snapshot, all);
    }
    if (due(checkpoint_steps_) && sim.step() > 0) write_checkpoint(sim);
    for (; events_seen_ < sim.events().size(); ++events_seen_) warn(sim.events()[events_seen_]);
}

void RunOutputs::write_log(const md::Simulation& sim) {
    const md::Observables o = sim.observe();
    log_->write(std::vector<std::vector<double>>{log_row(sim, o)});
    if (o.largest_overlap > 0.05 && !overlap_warned_) {
        overlap_warned_ = true;
        warn(fmt::format(
            "t = {:.4g} s: largest overlap {:.3g} R_min is above 0.05; the material is soft for this load",
            sim.time(), o.largest_overlap));
    }
}

// Keeps the two newest: one of them is whole whatever happens while the other is written.
std::string RunOutputs::write_checkpoint(const md::Simulation& sim) {
    output::Checkpoint c;
    c.scene = scene::write_scene(scene_);
    c.engine_state = sim.serialise();
    c.step = sim.step();
    c.wall_seconds = wall_before_ + clock_.seconds();
    c.bookmarks["log"] = log_->bookmark();
    c.bookmarks["pictures"] = pictures_->bookmark();
    if (replay_ != nullptr) c.bookmarks["replay"] = replay_->bookmark();
    for (auto& [name, writer] : trajectories_) c.bookmarks[name] = writer->bookmark();
    analyses_.add_bookmarks(c.bookmarks);
    const fs::path path = folder_.checkpoints() / checkpoint_name(sim.step());
    output::write_checkpoint(path, c);
    if (checkpoints_.empty() || checkpoints_.back() != path) checkpoints_.push_back(path);
    while (checkpoints_.size() > 2) {
        std::error_code ignored;
        fs::remove(checkpoints_.front(), ignored);
        checkpoints_.erase(checkpoints_.begin());
    }
    return path.string();
}

std::string RunOutputs::finish(const md::Simulation& sim, bool stopped, const std::string& summary,
                               double rate) {
    std::string checkpoint = write_checkpoint(sim);
    write_file_atomically(folder_.path() / "summary.json", summary + "\n");
    analyses_.draw(sim);
    if (stopped) return checkpoint;
    if (pictures_->count() > 0 && scene_.output.movie) write_movie();
    if (scene_.output.report) write_report(sim, rate);
    return checkpoint;
}

void RunOutputs::write_movie() {
    const std::string hint = output::write_movie(folder_.path());
    if (!hint.empty()) warn("no movie: ffmpeg is not installed or failed; the command is: " + hint);
}

void RunOutputs::write_report(const md::Simulation& sim, double rate) {
    output::ReportInput input;
    input.scene = scene_;
    input.summary = {{"Grains", std::to_string(sim.state().size())},
                     {"Simulated time", fmt::format("{:.4g} s", sim.time())},
                     {"Steps", std::to_string(sim.step())},
                     {"Time step", fmt::format("{:.4g} s", sim.plan().tick)},
                     {"Instruction set", std::string(simd::isa_name(sim.plan().isa))},
                     {"Threads", std::to_string(sim.plan().threads)},
                     {"Particle-steps per second", fmt::format("{:.3g}", rate)},
                     {"State hash", sim.state_hash().hex()}};
    input.plan = plan_text_;
    input.scene_text = scene::write_scene(scene_);
    input.log = output::read_log(folder_.path() / "log.csv");
    if (replay_ != nullptr) input.replay = output::read_replay(folder_.path() / "replay.bin");
    output::write_report(folder_.path() / "report.html", input);
}

void RunOutputs::warn(const std::string& text) {
    if (!quiet_) tell(fmt::format("warning: {}\n", text));
}

} // namespace sandlane::app
