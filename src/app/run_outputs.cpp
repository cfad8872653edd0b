#include "app/run_outputs.hpp"

#include "core/file.hpp"
#include "output/picture.hpp"
#include "scene/reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace sandlane::app {

namespace fs = std::filesystem;

namespace {

constexpr std::int64_t never = std::numeric_limits<std::int64_t>::max();

// Steps between outputs: every <seconds>, by default duration/parts, negative: never.
std::int64_t interval(double seconds, double duration, double parts, double dt) {
    if (seconds < 0) return never;
    if (seconds == 0) seconds = parts > 0 ? duration / parts : -1;
    if (seconds <= 0) return never;
    const double steps = seconds / dt;
    return steps < 1e15 ? std::max<std::int64_t>(1, std::llround(steps)) : never;
}

const char* trajectory_name(scene::Trajectory kind) {
    switch (kind) {
    case scene::Trajectory::dump:
        return "dump";
    case scene::Trajectory::xyz:
        return "xyz";
    case scene::Trajectory::vtp:
        return "vtp";
    case scene::Trajectory::book:
        return "book";
    }
    return "";
}

const std::vector<analysis::LogColumn>& log_columns() {
    static const std::vector<analysis::LogColumn> columns = {{"time", "s"},
                                                             {"step", "1"},
                                                             {"grains", "1"},
                                                             {"kinetic_energy", "J"},
                                                             {"rotational_energy", "J"},
                                                             {"elastic_energy", "J"},
                                                             {"potential_energy", "J"},
                                                             {"total_energy", "J"},
                                                             {"momentum_x", "kg m/s"},
                                                             {"momentum_y", "kg m/s"},
                                                             {"contacts", "1"},
                                                             {"wall_contacts", "1"},
                                                             {"largest_overlap", "R_min"},
                                                             {"largest_speed", "m/s"},
                                                             {"removed", "1"}};
    return columns;
}

// A scale that does not flicker: the largest value seen so far, rounded up to 1, 2 or 5 times a power of ten.
double rounded_up(double value) {
    if (!(value > 0)) return 1;
    const double base = std::pow(10.0, std::floor(std::log10(value)));
    for (const double step : {1.0, 2.0, 5.0})
        if (value <= step * base) return step * base;
    return 10 * base;
}

double largest_of(const analysis::Snapshot& s, scene::Colour colour) {
    double largest = 0;
    for (std::size_t i = 0; i < s.size(); ++i) {
        double value = 0;
        switch (colour) {
        case scene::Colour::speed:
            value = std::hypot(s.vx[i], s.vy[i]);
            break;
        case scene::Colour::pressure:
            value = s.pressure[i];
            break;
        case scene::Colour::spin:
            value = std::abs(s.omega[i]);
            break;
        case scene::Colour::radius:
            value = s.radius[i];
            break;
        }
        largest = std::max(largest, value);
    }
    return largest;
}

} // namespace

RunOutputs::RunOutputs(const fs::path& folder, const md::Simulation& sim, std::string plan_text,
                       const output::Checkpoint* resume)
    : scene_(sim.scene()),
      folder_(folder, resume != nullptr ? output::RunFolder::Start::resume : output::RunFolder::Start::fresh),
      plan_text_(std::move(plan_text)), dt_(sim.plan().dt) {
    const scene::Output& o = scene_.output;
    const double dt = dt_, duration = scene_.md.duration;
    log_steps_ = interval(o.log_every, duration, 200, dt);
    picture_steps_ = interval(o.picture_every, duration, 20, dt);
    trajectory_steps_ = interval(o.trajectory_every, duration, 100, dt);
    checkpoint_steps_ = interval(o.checkpoint_every, duration, 0, dt);
    replay_steps_ = o.report ? interval(0, duration, 200, dt) : never;
    try {
        open_files(resume);
    } catch (...) {
        if (resume == nullptr) folder_.discard();
        throw;
    }
}

void RunOutputs::open_files(const output::Checkpoint* resume) {
    const scene::Output& o = scene_.output;
    const auto bookmark = [&](const std::string& name) {
        return resume != nullptr && resume->bookmarks.contains(name) ? resume->bookmarks.at(name)
                                                                     : std::string();
    };
    write_file_atomically(folder_.path() / "scene.toml", scene::write_scene(scene_));
    write_file_atomically(folder_.path() / "plan.txt", plan_text_);
    log_ = std::make_unique<output::LogWriter>(folder_.path() / "log.csv", log_columns(), bookmark("log"));
    history_.columns = log_columns();
    if (resume != nullptr) history_ = output::read_log(folder_.path() / "log.csv");
    scene::Scene resolved = scene_;
    resolved.md.dt = dt_;
    if (trajectory_steps_ != never)
        for (const scene::Trajectory kind : o.trajectory) {
            const std::string name = trajectory_name(kind);
            trajectories_.emplace_back(
                name, output::make_trajectory_writer(kind, folder_.path(), resolved, bookmark(name)));
        }
    if (!bookmark("pictures").empty()) pictures_ = std::stoll(bookmark("pictures"));
}

std::int64_t RunOutputs::next_due(std::int64_t step) const {
    std::int64_t next = never;
    for (const std::int64_t every :
         {log_steps_, picture_steps_, trajectory_steps_, checkpoint_steps_, replay_steps_})
        if (every != never) next = std::min(next, (step / every + 1) * every);
    return next;
}

void RunOutputs::write_due(const md::Simulation& sim, bool all) {
    const auto due = [&](std::int64_t every) { return every != never && (all || sim.step() % every == 0); };
    if (due(log_steps_)) write_log(sim);
    const bool picture = due(picture_steps_), trajectory = due(trajectory_steps_),
               replay = due(replay_steps_);
    if (picture || trajectory || replay) {
        const analysis::Snapshot snapshot = sim.snapshot();
        if (picture) write_picture(snapshot);
        if (trajectory)
            for (auto& [name, writer] : trajectories_) writer->write(snapshot);
        if (replay) replay_.add(snapshot);
    }
    if (due(checkpoint_steps_) && sim.step() > 0) write_checkpoint(sim);
    for (; events_seen_ < sim.events().size(); ++events_seen_) warn(sim.events()[events_seen_]);
}

void RunOutputs::write_log(const md::Simulation& sim) {
    const md::Observables o = sim.observe();
    const std::vector<std::vector<double>> row = {
        {sim.time(), static_cast<double>(sim.step()), static_cast<double>(o.grains), o.kinetic, o.rotational,
         o.elastic, o.potential, o.kinetic + o.rotational + o.elastic + o.potential, o.momentum_x,
         o.momentum_y, static_cast<double>(o.contacts), static_cast<double>(o.wall_contacts),
         o.largest_overlap, o.largest_speed, static_cast<double>(sim.removed())}};
    log_->write(row);
    history_.rows.push_back(row[0]);
    if (o.largest_overlap > 0.05 && !overlap_warned_) {
        overlap_warned_ = true;
        warn(fmt::format(
            "t = {:.4g} s: largest overlap {:.3g} R_min is above 0.05; the material is soft for this load",
            sim.time(), o.largest_overlap));
    }
}

void RunOutputs::write_picture(const analysis::Snapshot& snapshot) {
    colour_max_ = std::max(colour_max_, rounded_up(largest_of(snapshot, scene_.output.colour)));
    const output::PictureStyle style{scene_.output.colour, static_cast<int>(scene_.output.picture_width),
                                     colour_max_};
    output::write_picture(folder_.pictures() / fmt::format("{:06}.png", pictures_++), snapshot, style);
}

// Keeps the two newest: one of them is whole whatever happens while the other is written.
std::string RunOutputs::write_checkpoint(const md::Simulation& sim) {
    output::Checkpoint c;
    c.scene = scene::write_scene(scene_);
    c.engine_state = sim.serialise();
    c.step = sim.step();
    c.wall_seconds = wall_before_ + clock_.seconds();
    c.bookmarks["log"] = log_->bookmark();
    c.bookmarks["pictures"] = std::to_string(pictures_);
    for (auto& [name, writer] : trajectories_) c.bookmarks[name] = writer->bookmark();
    const fs::path path = folder_.checkpoints() / fmt::format("{:012}.checkpoint", sim.step());
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
    const std::string checkpoint = write_checkpoint(sim);
    write_file_atomically(folder_.path() / "summary.json", summary + "\n");
    if (stopped) return checkpoint;
    if (pictures_ > 0 && scene_.output.movie) {
        const std::string hint = output::write_movie(folder_.path());
        if (!hint.empty()) warn("no movie: ffmpeg is not installed; with it: " + hint);
    }
    if (scene_.output.report) {
        output::ReportInput input;
        input.title = scene_.title;
        input.description = scene_.description;
        input.summary = {{"grains", std::to_string(sim.state().size())},
                         {"steps", std::to_string(sim.step())},
                         {"time", fmt::format("{:.4g} s", sim.time())},
                         {"time step", fmt::format("{:.4g} s", sim.plan().dt)},
                         {"instruction set", std::string(simd::isa_name(sim.plan().isa))},
                         {"threads", std::to_string(sim.plan().threads)},
                         {"particle-steps per second", fmt::format("{:.3g}", rate)},
                         {"state hash", sim.state_hash().hex()}};
        input.plan = plan_text_;
        input.scene_text = scene::write_scene(scene_);
        input.log = history_;
        output::write_report(folder_.path() / "report.html", input, replay_);
    }
    return checkpoint;
}

void RunOutputs::warn(const std::string& text) {
    if (!quiet_) tell(fmt::format("warning: {}\n", text));
}

} // namespace sandlane::app
