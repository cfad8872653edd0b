#include "app/md_engine.hpp"

#include "app/commands.hpp"
#include "app/json.hpp"
#include "app/md_difference.hpp"
#include "app/md_log.hpp"
#include "app/md_recorder.hpp"
#include "core/error.hpp"
#include "md/accuracy.hpp"
#include "output/picture.hpp"
#include "scene/schema.hpp"

#include <algorithm>
#include <utility>

namespace sandlane::app {

const Words& MdEngine::words() const {
    static const Words words;
    return words;
}

namespace {

// Of what the start of a grain tells of its later states. Files of grains may change between two runs.
Hash128 hash_of(const std::vector<scene::GrainState>& grains) {
    Hasher hasher;
    for (const scene::GrainState& g : grains) {
        const double values[] = {g.radius, g.mass, static_cast<double>(g.material)};
        hasher.add({reinterpret_cast<const char*>(values), sizeof values});
    }
    return hasher.result();
}

const md::Simulation& simulation_of(const Engine& engine) {
    return dynamic_cast<const MdEngine&>(engine).simulation();
}

} // namespace

void MdEngine::serialise(ByteWriter& out) const {
    out.put(grains_.high);
    out.put(grains_.low);
    watcher_.serialise(out);
    simulation_.serialise(out);
}

void MdEngine::restore(const std::string& state, const std::string& origin) {
    try {
        ByteReader in(state);
        const auto high = in.get<std::uint64_t>(), low = in.get<std::uint64_t>();
        if (Hash128{high, low} != grains_)
            fail(Exit::io,
                 "its grains are not those that its scene describes now; a file of grains has changed");
        watcher_.restore(in);
        simulation_.restore(in.rest());
    } catch (const Error& e) {
        fail(e.code(), "{}: {}. Overrides by --set must keep grains, domain, walls, laws and time step.",
             origin, e.what());
    }
}

std::vector<Difference> MdEngine::compare_state(const Engine& other) const {
    return compare_snapshots(simulation_.snapshot(), simulation_of(other).snapshot());
}

std::vector<Difference> MdEngine::compare_kernels(simd::Isa first, simd::Isa second) const {
    return compare_forces(simulation_, first, second);
}

std::vector<analysis::LogColumn> MdEngine::log_columns() const {
    return app::log_columns(scene(), watcher_);
}

std::vector<double> MdEngine::log_row() {
    const md::Observables o = simulation_.observe();
    if (o.largest_overlap > 0.05 && !overlap_warned_) {
        overlap_warned_ = true;
        warnings_.push_back(fmt::format(
            "t = {:.4g} s: largest overlap {:.3g} R_min is above 0.05; the material is soft for this load",
            time(), o.largest_overlap));
    }
    watcher_.see(simulation_.watch(o), step(), time());
    return app::log_row(simulation_, o, watcher_);
}

std::vector<std::string> MdEngine::news() {
    std::vector<std::string> news = std::exchange(warnings_, {});
    for (std::string& warning : watcher_.take_news()) news.push_back(std::move(warning));
    const std::vector<std::string>& events = simulation_.events();
    for (; events_seen_ < events.size(); ++events_seen_) news.push_back(events[events_seen_]);
    return news;
}

std::unique_ptr<Recorder> MdEngine::recorder(const std::filesystem::path& folder,
                                             const output::Checkpoint* resume) {
    return std::make_unique<MdRecorder>(folder, simulation_, resume);
}

void MdEngine::draw(const std::filesystem::path& png, const Look& look) const {
    const scene::Choices& colours = scene::colour_choices();
    const auto colour = std::find(colours.begin(), colours.end(), look.colour);
    output::PictureStyle style = output::picture_style(scene());
    if (!look.view.empty()) {
        if (scene().domain.dimension != 3)
            fail(Exit::invalid_input, "--view goes with three-dimensional scenes only");
        scene::Scene turned = scene();
        turned.output.view = {look.view[0], look.view[1], look.view[2]};
        style.camera = output::camera_of(turned);
    }
    if (look.width > 0) style.width = look.width;
    if (colour != colours.end()) style.colour = static_cast<scene::Colour>(colour - colours.begin());
    output::write_picture(png, simulation_.snapshot(), style);
}

std::string MdEngine::plan_json() const {
    const md::Plan& plan = simulation_.plan();
    return fmt::format(
        R"({{"engine": "md", "neighbours": "{}", "order": {}, "contact_onset": "{}", "spin": {}, "dt": {}}})",
        scene::neighbour_choices()[static_cast<std::size_t>(plan.neighbours)], plan.order,
        plan.resolved ? "resolved" : "step", md::turns(plan), json_number(plan.dt));
}

std::string MdEngine::summary_json() const {
    return fmt::format(R"("removed": {}, )", simulation_.removed()) + watcher_.json();
}

std::vector<std::pair<std::string, std::string>> MdEngine::report_rows() const {
    std::vector<std::pair<std::string, std::string>> rows = {
        {"Grains", std::to_string(size())},
        {"Simulated time", fmt::format("{:.4g} s", time())},
        {stride() > 1 ? "Shortest units of the time step" : "Steps", std::to_string(step())},
        {"Time step", fmt::format("{:.4g} s", simulation_.plan().dt)}};
    watcher_.add_report_rows(rows);
    return rows;
}

namespace {

class MdSetup final : public Setup {
public:
    MdSetup(scene::Scene scene, const Machine& machine)
        : scene_(std::move(scene)), grains_(scene::initial_grains(scene_)),
          needs_(md::analyse(scene_, grains_)) {
        scene::Scene resolved = scene_;
        if (scene_.md.accuracy > 0) {
            accuracy_ = md::choose_by_accuracy(scene_, needs_);
            resolved = md::with_choice(scene_, accuracy_);
        }
        derived_ = md::derive(resolved, needs_);
        plan_ = md::make_plan(resolved, needs_, derived_, machine.isa, machine.threads);
        plan_.chosen.insert(plan_.chosen.end(), accuracy_.reasons.begin(), accuracy_.reasons.end());
    }

    [[nodiscard]] double memory_bytes() const override { return md::memory_bytes(needs_, plan_); }
    [[nodiscard]] std::string description() const override {
        return md::describe(scene_, needs_, derived_, plan_);
    }
    [[nodiscard]] std::string json() const override {
        return fmt::format(
            R"({{"grains": {}, "poured": {}, "dt": {}, "steps": {}, "collision_time": {}, "critical_dt": {}, )"
            R"("restitution": [{}, {}], "memory_bytes": {}, "isa": "{}", "order": {}, "accuracy": {}, )"
            R"("threads": {}}})",
            needs_.grains, needs_.poured, json_number(plan_.dt), plan_.steps,
            json_number(derived_.collision_time), json_number(derived_.critical_dt),
            json_number(derived_.restitution_min), json_number(derived_.restitution_max), memory_bytes(),
            simd::isa_name(plan_.isa), plan_.order, accuracy_json(), plan_.threads);
    }
    [[nodiscard]] std::unique_ptr<Engine> start() override { return start(plan_.isa); }
    [[nodiscard]] std::unique_ptr<Engine> start(simd::Isa isa) override {
        md::Plan plan = plan_;
        plan.isa = isa;
        // They may be many: the first start takes them, another one makes the same again.
        std::vector<scene::GrainState> grains = std::exchange(grains_, {});
        if (grains.empty()) grains = scene::initial_grains(scene_);
        const Hash128 hash = hash_of(grains);
        return std::make_unique<MdEngine>(md::Simulation(scene_, std::move(grains), needs_, plan), hash);
    }

private:
    // Of md.accuracy; null without.
    [[nodiscard]] std::string accuracy_json() const {
        const md::AccuracyChoice& choice = accuracy_;
        std::string all;
        for (const md::Candidate& c : choice.all)
            all += fmt::format(R"({}"{}": {{"step_ns": {}, "longest_dt": {}}})", all.empty() ? "" : ", ",
                               md::name_of(c), c.step_cost, json_number(c.longest));
        if (all.empty()) return "null";
        return fmt::format(R"({{"integrator": "{}", "error": {}, "cost_ns": {}, "candidates": {{{}}}}})",
                           md::name_of(choice.best), json_number(choice.best.error),
                           json_number(choice.best.cost), all);
    }

    scene::Scene scene_;
    std::vector<scene::GrainState> grains_;
    md::Needs needs_;
    md::AccuracyChoice accuracy_; // empty without md.accuracy
    md::Derived derived_;
    md::Plan plan_;
};

} // namespace

std::unique_ptr<Setup> prepare_md(scene::Scene scene, const Machine& machine) {
    return std::make_unique<MdSetup>(std::move(scene), machine);
}

} // namespace sandlane::app
