#include "app/gas_recorder.hpp"

#include "app/interval.hpp"
#include "core/file.hpp"
#include "scene/schema.hpp"

#include <algorithm>

namespace sandlane::app {

namespace {

// Pictures and trajectories are for those who ask: a gas has many particles.
std::int64_t asked(double every, double duration, double dt) {
    return every > 0 ? interval(every, duration, 0, dt) : never;
}

} // namespace

GasRecorder::GasRecorder(const std::filesystem::path& folder, const GasEngine& engine,
                         const output::Checkpoint* resume)
    : engine_(engine), folder_(folder),
      sample_steps_(interval(engine.sampling().every, engine.duration(), 200, engine.time_step())),
      picture_steps_(asked(engine.scene().output.picture_every, engine.duration(), engine.time_step())),
      trajectory_steps_(asked(engine.scene().output.trajectory_every, engine.duration(), engine.time_step())),
      samples_(engine.make_samples()),
      pictures_(folder / "pictures", engine.scene(), output::bookmark_in(resume, "pictures")) {
    if (trajectory_steps_ != never)
        for (const scene::Trajectory kind : engine.scene().output.trajectory) {
            const std::string name(scene::trajectory_choices()[static_cast<std::size_t>(kind)]);
            trajectories_[name] = output::make_trajectory_writer(kind, folder, engine.scene(),
                                                                 output::bookmark_in(resume, name));
        }
    if (const std::string bookmark = output::bookmark_in(resume, "samples"); !bookmark.empty())
        samples_.restore(bookmark);
}

std::int64_t GasRecorder::next_due(std::int64_t step) const {
    return std::min({next_multiple(step, sample_steps_), next_multiple(step, picture_steps_),
                     next_multiple(step, trajectory_steps_)});
}

void GasRecorder::write_due(bool all) {
    const std::int64_t step = engine_.step();
    if (is_due(step, sample_steps_, false) && step > 0 && engine_.time() >= engine_.sampling().start)
        engine_.sample(samples_);
    const bool picture = is_due(step, picture_steps_, all), trajectory = is_due(step, trajectory_steps_, all);
    if (!(picture || trajectory)) return;
    const analysis::Snapshot snapshot = engine_.snapshot();
    if (picture) pictures_.write(snapshot);
    if (trajectory)
        for (auto& [name, writer] : trajectories_) writer->write(snapshot);
}

void GasRecorder::add_bookmarks(std::map<std::string, std::string>& bookmarks) {
    bookmarks["pictures"] = pictures_.bookmark();
    for (auto& [name, writer] : trajectories_) bookmarks[name] = writer->bookmark();
    bookmarks["samples"] = samples_.serialise();
    write_tables();
}

void GasRecorder::write_tables() const {
    if (samples_.frames() == 0) return;
    write_file_atomically(folder_ / "profile.csv", samples_.profile());
    write_file_atomically(folder_ / "distribution.csv", samples_.distribution());
}

} // namespace sandlane::app
