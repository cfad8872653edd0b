#include "app/md_recorder.hpp"

#include "app/interval.hpp"
#include "scene/schema.hpp"

#include <algorithm>

namespace sandlane::app {

MdRecorder::MdRecorder(const std::filesystem::path& folder, const md::Simulation& simulation,
                       const output::Checkpoint* resume)
    : simulation_(simulation), folder_(folder),
      pictures_(folder / "pictures", simulation.scene(), output::bookmark_in(resume, "pictures")) {
    scene::Scene resolved = simulation.scene();
    const scene::Output& o = resolved.output;
    const double dt = simulation.plan().tick, duration = resolved.md.duration;
    const std::int64_t stride = simulation.plan().largest_stride;
    resolved.md.dt = dt;
    picture_steps_ = interval(o.picture_every, duration, 20, dt, stride);
    trajectory_steps_ = interval(o.trajectory_every, duration, 100, dt, stride);
    replay_steps_ = o.report ? interval(0, duration, 200, dt, stride) : never;
    if (trajectory_steps_ != never)
        for (const scene::Trajectory kind : o.trajectory) {
            const std::string name(scene::trajectory_choices()[static_cast<std::size_t>(kind)]);
            trajectories_[name] =
                output::make_trajectory_writer(kind, folder, resolved, output::bookmark_in(resume, name));
        }
    analyses_.open(folder, resolved, stride, resume);
    if (replay_steps_ != never)
        replay_ = std::make_unique<output::ReplayWriter>(folder, output::bookmark_in(resume, "replay"));
}

std::int64_t MdRecorder::next_due(std::int64_t step) const {
    std::int64_t next = analyses_.next_due(step);
    for (const std::int64_t every : {picture_steps_, trajectory_steps_, replay_steps_})
        next = std::min(next, next_multiple(step, every));
    return next;
}

void MdRecorder::write_due(bool all) {
    const std::int64_t step = simulation_.step();
    const auto due = [&](std::int64_t every) { return is_due(step, every, all); };
    const bool picture = due(picture_steps_), trajectory = due(trajectory_steps_),
               replay = due(replay_steps_), analysis = analyses_.due(step, all);
    if (!(picture || trajectory || replay || analysis)) return;
    const analysis::Snapshot snapshot = simulation_.snapshot();
    if (picture) pictures_.write(snapshot);
    if (trajectory)
        for (auto& [name, writer] : trajectories_) writer->write(snapshot);
    if (replay) replay_->write(snapshot);
    if (analysis) analyses_.write_due(simulation_, snapshot, all);
}

void MdRecorder::add_bookmarks(std::map<std::string, std::string>& bookmarks) {
    bookmarks["pictures"] = pictures_.bookmark();
    if (replay_ != nullptr) bookmarks["replay"] = replay_->bookmark();
    for (auto& [name, writer] : trajectories_) bookmarks[name] = writer->bookmark();
    analyses_.add_bookmarks(bookmarks);
}

void MdRecorder::add_to_report(output::ReportInput& report) const {
    if (replay_ != nullptr) report.replay = output::read_replay(folder_ / "replay.bin");
}

} // namespace sandlane::app
