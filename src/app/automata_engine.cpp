// Cellular automata as engines of the program: sandpile, heap, ripples, lattice gas and pipe flow. Time is
// counted in steps.
#include "app/commands.hpp"
#include "app/engine.hpp"
#include "app/interval.hpp"
#include "app/json.hpp"
#include "automata/model.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "output/field_picture.hpp"
#include "output/log.hpp"
#include "output/npy.hpp"
#include "output/plot.hpp"
#include "scene/schema.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <numeric>

namespace sandlane::app {

namespace {

namespace fs = std::filesystem;
using automata::Model;

// What the table of the engine says about the length of the run; 0: as long as something happens.
std::int64_t steps_of(const scene::Scene& s) {
    switch (s.method) {
    case scene::Engine::sandpile:
        return s.sandpile.steps;
    case scene::Engine::heap:
        return s.heap.steps;
    case scene::Engine::ripples:
        return s.ripples.steps;
    case scene::Engine::lattice_gas:
        return s.lattice_gas.steps;
    case scene::Engine::pipe_flow:
        return s.pipe_flow.steps;
    default:
        return 0;
    }
}

bool drops_grains(const scene::Scene& s) {
    return s.method == scene::Engine::sandpile && s.sandpile.drive != scene::PileDrive::none;
}

Words words_of(const scene::Scene& s) {
    if (s.method == scene::Engine::heap) return {"heap", "heaps", "heaps", "grains", "grains", ""};
    if (drops_grains(s)) return {"pile", "piles", "piles", "grains", "grains", ""};
    const bool sweeps = s.method == scene::Engine::sandpile;
    return {"site", "sites", "sites", "site-updates", sweeps ? "sweeps" : "steps", ""};
}

// About; times of outputs are parts of it. The constants are those of large lattices.
double sweeps_until_quiet(const scene::Sandpile& s) {
    const double side = static_cast<double>(std::max(s.columns, s.rows));
    if (s.start == scene::PileStart::doubled) return 20 * side;
    if (s.start == scene::PileStart::identity) return 0.6 * side * side;
    const double spreading = 0.2 * static_cast<double>(s.centre),
                 sinking = s.height > 3 ? 0.1 * side * side : 0;
    return 10 * side + spreading + sinking;
}

std::string step_name(const Words& words) {
    return words.steps.substr(0, words.steps.size() - 1);
}

// Pictures of the first field, all fields as .npy, and at the end the tables and maps of the whole run.
class AutomataRecorder final : public Recorder {
public:
    AutomataRecorder(fs::path folder, const Model& model, const scene::Scene& scene, const Words& words,
                     double duration, const output::Checkpoint* resume)
        : folder_(std::move(folder)), model_(model), words_(words),
          width_(static_cast<int>(scene.output.picture_width)),
          picture_steps_(interval(scene.output.picture_every, duration, 20, 1)),
          map_steps_(interval(scene.output.trajectory_every, duration, 10, 1)),
          pictures_(folder_ / "pictures", width_, output::bookmark_in(resume, "pictures")) {}

    [[nodiscard]] std::int64_t next_due(std::int64_t step) const override {
        return std::min(next_multiple(step, picture_steps_), next_multiple(step, map_steps_));
    }
    void write_due(bool all) override {
        const std::int64_t step = model_.step();
        const bool picture = is_due(step, picture_steps_, all), maps = is_due(step, map_steps_, all);
        if ((!picture && !maps) || step == written_) return;
        written_ = step;
        const std::vector<analysis::Field> fields = model_.fields();
        if (picture && !fields.empty()) pictures_.write(fields.front(), caption());
        if (maps) {
            write_maps(fields);
            mapped_ = step;
        }
    }
    void add_bookmarks(std::map<std::string, std::string>& bookmarks) override {
        bookmarks["pictures"] = pictures_.bookmark();
    }
    void finish() override {
        for (const analysis::Field& field : model_.final_fields()) {
            output::write_npy(folder_ / (field.name + ".npy"), field);
            add_figure(field.name, field.label,
                       output::draw_field(field, field.caption, output::scale_of(field), width_));
        }
        for (const analysis::Table& table : model_.final_tables()) {
            write_file_atomically(folder_ / (table.name + ".csv"),
                                  output::log_text({table.columns, table.rows}));
            if (table.x < 0) continue;
            const std::string png = output::draw_plot(table, width_);
            if (!png.empty()) add_figure(table.name, table.name, png);
        }
        const std::vector<analysis::Field> fields = model_.fields();
        if (map_steps_ != never && model_.step() != mapped_) write_maps(fields); // the end
        if (fields.empty()) return;
        const analysis::Field& shown = fields.front();
        const std::string png = output::draw_field(shown, caption(), output::scale_of(shown), width_);
        write_file_atomically(folder_ / "end.png", png);
        figures_.insert(figures_.begin(), {fmt::format("{} at the end", shown.label), png});
    }
    [[nodiscard]] std::int64_t pictures() const override { return pictures_.count(); }
    void add_to_report(output::ReportInput& report) const override { report.figures = figures_; }

private:
    [[nodiscard]] std::string caption() const {
        return fmt::format("{} {}", step_name(words_), model_.step());
    }
    void write_maps(const std::vector<analysis::Field>& fields) const {
        const fs::path maps = folder_ / "maps";
        std::error_code status;
        fs::create_directories(maps, status);
        if (status) fail(Exit::io, "{}: cannot create the folder: {}", maps.string(), status.message());
        for (const analysis::Field& field : fields)
            output::write_npy(maps / fmt::format("{}-{:012}.npy", field.name, model_.step()), field);
    }
    void add_figure(const std::string& name, const std::string& caption, const std::string& png) {
        write_file_atomically(folder_ / (name + ".png"), png);
        figures_.push_back({caption, png});
    }

    fs::path folder_;
    const Model& model_;
    Words words_;
    int width_;
    std::int64_t picture_steps_, map_steps_, written_ = -1, mapped_ = -1;
    output::FieldSeries pictures_;
    std::vector<output::Figure> figures_;
};

class AutomataEngine final : public Engine {
public:
    AutomataEngine(const scene::Scene& scene, const automata::Means& means, std::unique_ptr<Model> model)
        : scene_(scene), means_(means), words_(words_of(scene)), model_(std::move(model)) {}

    [[nodiscard]] const Words& words() const override { return words_; }
    [[nodiscard]] const scene::Scene& scene() const override { return scene_; }
    [[nodiscard]] simd::Isa isa() const override { return means_.isa; }
    [[nodiscard]] int threads() const override { return means_.threads; }

    void run(std::int64_t steps) override { model_->run(steps); }
    [[nodiscard]] std::int64_t step() const override { return model_->step(); }
    [[nodiscard]] std::int64_t steps() const override {
        const std::int64_t steps = steps_of(scene_);
        return steps > 0 || scene_.method != scene::Engine::sandpile ? steps : most_steps;
    }
    [[nodiscard]] std::int64_t expected_steps() const override {
        return std::max(step(), static_cast<std::int64_t>(duration()));
    }
    [[nodiscard]] bool finished() const override { return model_->finished(); }
    [[nodiscard]] double time() const override { return static_cast<double>(step()); }
    [[nodiscard]] double time_step() const override { return 1; }
    [[nodiscard]] double duration() const override {
        const std::int64_t steps = steps_of(scene_);
        return steps > 0 ? static_cast<double>(steps) : sweeps_until_quiet(scene_.sandpile);
    }
    // A grain is dropped on one pile, whatever its size.
    [[nodiscard]] std::size_t size() const override { return drops_grains(scene_) ? 1 : model_->sites(); }

    [[nodiscard]] Hash128 state_hash() const override { return model_->state_hash(); }
    void serialise(ByteWriter& out) const override { out.put_bytes(model_->serialise()); }
    void restore(const std::string& state, const std::string& origin) override {
        try {
            model_->restore(state);
        } catch (const Error& e) {
            fail(e.code(), "{}: {}. Overrides by --set must keep the lattice and the model.", origin,
                 e.what());
        }
    }

    [[nodiscard]] std::vector<Difference> compare_state(const Engine& other) const override {
        return differences(*model_, *dynamic_cast<const AutomataEngine&>(other).model_);
    }
    [[nodiscard]] std::vector<Difference> compare_kernels(simd::Isa first, simd::Isa second) const override {
        const std::unique_ptr<Model> a = one_step_later(first), b = one_step_later(second);
        return differences(*a, *b);
    }
    [[nodiscard]] std::string kernels_compared() const override {
        return fmt::format("One {} from the initial state", step_name(words_));
    }

    [[nodiscard]] std::vector<analysis::LogColumn> log_columns() const override {
        return model_->log_columns();
    }
    [[nodiscard]] std::vector<double> log_row() override { return model_->log_row(); }
    [[nodiscard]] std::unique_ptr<Recorder> recorder(const fs::path& folder,
                                                     const output::Checkpoint* resume) override {
        return std::make_unique<AutomataRecorder>(folder, *model_, scene_, words_, duration(), resume);
    }
    void draw(const fs::path& png, const Look& look) const override {
        if (!look.view.empty() || !look.colour.empty())
            fail(Exit::invalid_input, "--view and --colour go with scenes of grains only");
        const std::vector<analysis::Field> fields = model_->fields();
        const int width = look.width > 0 ? look.width : static_cast<int>(scene_.output.picture_width);
        write_file_atomically(png, output::draw_field(fields.front(),
                                                      fmt::format("{} {}", step_name(words_), step()),
                                                      output::scale_of(fields.front()), width));
    }
    [[nodiscard]] std::string plan_json() const override {
        return fmt::format(R"({{"engine": {}}})",
                           json_text(scene::engine_choices()[static_cast<std::size_t>(scene_.method)]));
    }
    [[nodiscard]] std::vector<std::pair<std::string, std::string>> report_rows() const override {
        std::string things = words_.things;
        things[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(things[0])));
        return {{things, std::to_string(size())}, {"Steps", fmt::format("{} {}", step(), words_.steps)}};
    }

private:
    static constexpr std::int64_t most_steps = std::int64_t{1} << 53;

    [[nodiscard]] std::unique_ptr<Model> one_step_later(simd::Isa isa) const {
        std::unique_ptr<Model> model = automata::make_model(scene_, {isa, means_.threads});
        model->restore(model_->serialise());
        model->run(1);
        return model;
    }
    static std::vector<Difference> differences(const Model& a, const Model& b) {
        std::vector<Difference> found;
        const std::vector<automata::Quantity> first = a.quantities(), second = b.quantities();
        for (std::size_t n = 0; n < first.size(); ++n) {
            std::vector<std::int64_t> ids(first[n].values.size());
            std::iota(ids.begin(), ids.end(), std::int64_t{0});
            found.push_back(difference(first[n].name, first[n].unit, ids, first[n].values, second[n].values));
        }
        return found;
    }

    scene::Scene scene_;
    automata::Means means_;
    Words words_;
    std::unique_ptr<Model> model_;
};

class AutomataSetup final : public Setup {
public:
    AutomataSetup(scene::Scene scene, const Machine& machine)
        : scene_(std::move(scene)), machine_(machine), means_{machine.isa, machine.threads.count} {}

    [[nodiscard]] double memory_bytes() const override { return automata::memory_bytes(scene_); }
    [[nodiscard]] std::string description() const override {
        if (facts_.empty()) facts_ = automata::make_model(scene_, means_)->facts();
        const Words words = words_of(scene_);
        std::string text = fmt::format("{}\n\nPlan\n", scene_.title.empty() ? "(untitled)" : scene_.title);
        const auto line = [&](const std::string& label, const std::string& value) {
            text += fmt::format("  {:<26}{}\n", label, value);
        };
        line("engine", std::string(scene::engine_choices()[static_cast<std::size_t>(scene_.method)]));
        for (const auto& [label, value] : facts_) line(label, value);
        const std::int64_t steps = steps_of(scene_);
        line(words.steps, steps > 0 ? std::to_string(steps) : "until nothing changes");
        line("memory", fmt::format("about {:.3g} MB", memory_bytes() / 1e6));
        line("kernels by", fmt::format("{}; threads: {} ({})", simd::isa_name(means_.isa), means_.threads,
                                       machine_.threads.reason));
        return text;
    }
    [[nodiscard]] std::string json() const override {
        return fmt::format(R"({{"engine": {}, "steps": {}, "memory_bytes": {}, "isa": "{}", "threads": {}}})",
                           json_text(scene::engine_choices()[static_cast<std::size_t>(scene_.method)]),
                           steps_of(scene_), memory_bytes(), simd::isa_name(means_.isa), means_.threads);
    }
    [[nodiscard]] std::unique_ptr<Engine> start() override { return start(means_.isa); }
    [[nodiscard]] std::unique_ptr<Engine> start(simd::Isa isa) override {
        const automata::Means means{isa, means_.threads};
        std::unique_ptr<Model> model = automata::make_model(scene_, means);
        facts_ = model->facts();
        return std::make_unique<AutomataEngine>(scene_, means, std::move(model));
    }

private:
    scene::Scene scene_;
    mutable automata::Facts facts_; // for description(), once a model was made
    Machine machine_;
    automata::Means means_;
};

} // namespace

#define PREPARE(engine)                                                                                      \
    std::unique_ptr<Setup> prepare_##engine(scene::Scene scene, const Machine& machine) {                    \
        return std::make_unique<AutomataSetup>(std::move(scene), machine);                                   \
    }
PREPARE(sandpile)
PREPARE(heap)
PREPARE(ripples)
PREPARE(lattice_gas)
PREPARE(pipe_flow)

} // namespace sandlane::app
