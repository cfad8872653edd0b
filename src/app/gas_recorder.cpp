#include "app/gas_recorder.hpp"

#include "core/file.hpp"
#include "scene/schema.hpp"

#include <algorithm>

namespace sandlane::app {

namespace {

// Pictures and trajectories are for those who ask: a gas has many particles.
Timer asked(double every, const GasEngine& engine) {
    return every > 0 ? Timer(every, 0, engine, Spacing::paced) : Timer();
}

} // namespace

GasRecorder::GasRecorder(const std::filesystem::path& folder, const GasEngine& engine,
                         const output::Checkpoint* resume)
    : engine_(engine), folder_(folder),
      // Averages over time need frames at equal distances.
      sample_timer_(engine.sampling().every, 200, engine, Spacing::even),
      picture_timer_(asked(engine.scene().output.picture_every, engine)),
      trajectory_timer_(asked(engine.scene().output.trajectory_every, engine)),
      samples_(engine.make_samples()),
      pictures_(folder / "pictures", engine.scene(), output::bookmark_in(resume, "pictures")) {
    if (trajectory_timer_.is_on())
        for (const scene::Trajectory kind : engine.scene().output.trajectory) {
            const std::string name(scene::trajectory_choices()[static_cast<std::size_t>(kind)]);
            trajectories_[name] = output::make_trajectory_writer(kind, folder, engine.scene(),
                                                                 output::bookmark_in(resume, name));
        }
    if (const std::string bookmark = output::bookmark_in(resume, "samples"); !bookmark.empty())
        samples_.restore(bookmark);
}

std::int64_t GasRecorder::next_due(std::int64_t step) const {
    return std::min(
        {sample_timer_.next_step(step), picture_timer_.next_step(step), trajectory_timer_.next_step(step)});
}

double GasRecorder::next_time() const {
    return std::min({sample_timer_.next_time(), picture_timer_.next_time(), trajectory_timer_.next_time()});
}

void GasRecorder::write_due(bool all) {
    if (sample_timer_.is_due(engine_, false) && engine_.time() > 0 &&
        engine_.time() >= engine_.sampling().start)
        engine_.sample(samples_);
    const bool picture = picture_timer_.is_due(engine_, all),
               trajectory = trajectory_timer_.is_due(engine_, all);
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
