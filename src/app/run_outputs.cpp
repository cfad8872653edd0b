#include "app/run_outputs.hpp"

#include "core/file.hpp"
#include "core/hash.hpp"
#include "output/picture.hpp"
#include "output/report.hpp"
#include "scene/reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace sandlane::app {

namespace fs = std::filesystem;

namespace {

std::string checkpoint_name(std::int64_t step) {
    return fmt::format("{:012}.checkpoint", step);
}

// Of a scene, as one word.
std::string hash_of(const scene::Scene& scene) {
    const std::string text = scene::write_scene(scene);
    return hash_bytes(text.data(), text.size()).hex();
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

RunOutputs::RunOutputs(const fs::path& folder, Engine& engine, std::string plan_text,
                       const output::Checkpoint* resume)
    : engine_(engine),
      folder_(folder, resume != nullptr ? output::RunFolder::Start::resume : output::RunFolder::Start::fresh,
              resume != nullptr ? output::bookmark_in(resume, "origin") : hash_of(engine.scene())),
      plan_text_(std::move(plan_text)) {
    const scene::Output& o = engine.scene().output;
    log_timer_ = Timer(o.log_every, 200, engine, Spacing::paced);
    checkpoint_timer_ = Timer(o.checkpoint_every, 0, engine, Spacing::even);
    try {
        open_files(resume);
    } catch (...) {
        if (resume == nullptr) folder_.discard();
        throw;
    }
    if (resume == nullptr) return;
    checkpoints_ = earlier_checkpoints(folder_.checkpoints(), resume->step);
    (void)engine.news(); // the run before has told them
}

void RunOutputs::open_files(const output::Checkpoint* resume) {
    write_file_atomically(folder_.path() / "scene.toml", scene::write_scene(engine_.scene()));
    write_file_atomically(folder_.path() / "plan.txt", plan_text_);
    log_ = std::make_unique<output::LogWriter>(folder_.path() / "log.csv", engine_.log_columns(),
                                               output::bookmark_in(resume, "log"));
    recorder_ = engine_.recorder(folder_.path(), resume);
}

std::int64_t RunOutputs::next_due(std::int64_t step) const {
    return std::min(
        {log_timer_.next_step(step), checkpoint_timer_.next_step(step), recorder_->next_due(step)});
}

double RunOutputs::next_time() const {
    return std::min({log_timer_.next_time(), checkpoint_timer_.next_time(), recorder_->next_time()});
}

void RunOutputs::write_due(bool all) {
    const bool log = log_timer_.is_due(engine_, all);
    if (log) log_->write(std::vector<std::vector<double>>{engine_.log_row()});
    recorder_->write_due(all);
    if (checkpoint_timer_.is_due(engine_, all) && engine_.step() > 0) write_checkpoint();
    for (const std::string& text : engine_.news()) warn(text);
    if (log) engine_.judge();
}

// Keeps the two newest: one of them is whole whatever happens while the other is written.
std::string RunOutputs::write_checkpoint() {
    output::Progress c;
    c.scene = scene::write_scene(engine_.scene());
    c.step = engine_.step();
    c.wall_seconds = wall_before_ + clock_.seconds();
    c.bookmarks["log"] = log_->bookmark();
    c.bookmarks["origin"] = folder_.origin();
    recorder_->add_bookmarks(c.bookmarks);
    const fs::path path = folder_.checkpoints() / checkpoint_name(engine_.step());
    output::write_checkpoint(path, c, [&](ByteWriter& out) { engine_.serialise(out); });
    if (checkpoints_.empty() || checkpoints_.back() != path) checkpoints_.push_back(path);
    while (checkpoints_.size() > 2) {
        std::error_code ignored;
        fs::remove(checkpoints_.front(), ignored);
        checkpoints_.erase(checkpoints_.begin());
    }
    return path.string();
}

std::string RunOutputs::finish(bool stopped, const std::string& summary, double rate) {
    std::string checkpoint = write_checkpoint();
    write_file_atomically(folder_.path() / "summary.json", summary + "\n");
    recorder_->finish();
    if (stopped) return checkpoint;
    const scene::Output& o = engine_.scene().output;
    if (recorder_->pictures() > 0 && o.movie) write_movie();
    if (o.report) write_report(rate);
    return checkpoint;
}

void RunOutputs::write_movie() {
    const std::string hint = output::write_movie(folder_.path());
    if (!hint.empty()) warn("no movie: ffmpeg is not installed or failed; the command is: " + hint);
}

void RunOutputs::write_report(double rate) {
    output::ReportInput input;
    input.scene = engine_.scene();
    input.summary = engine_.report_rows();
    std::string rate_label = engine_.words().work + " per second";
    rate_label[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(rate_label[0])));
    input.summary.insert(input.summary.end(),
                         {{"Instruction set", std::string(simd::isa_name(engine_.isa()))},
                          {"Threads", std::to_string(engine_.threads())},
                          {rate_label, fmt::format("{:.3g}", rate)},
                          {"State hash", engine_.state_hash().hex()}});
    input.plan = plan_text_;
    input.scene_text = scene::write_scene(engine_.scene());
    input.log = output::read_log(folder_.path() / "log.csv");
    recorder_->add_to_report(input);
    output::write_report(folder_.path() / "report.html", input);
}

void RunOutputs::warn(const std::string& text) {
    if (!quiet_) tell(fmt::format("warning: {}\n", text));
}

} // namespace sandlane::app
