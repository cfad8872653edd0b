// What an engine has to provide to the program. `run`, `check`, `compare`, `bench`, checkpoints and reports
// know engines by these three classes only:
//   Setup     a validated scene with its plan, before memory is spent;
//   Engine    the simulation: takes steps, tells its state, goes on from a checkpoint;
//   Recorder  the files of a run that only this engine writes.
// An engine is a line in scene/engines.def and a function prepare_NAME, see below; md_engine.cpp is an
// example.
#pragma once

#include "analysis/snapshot.hpp"
#include "app/difference.hpp"
#include "core/hash.hpp"
#include "core/parallel.hpp"
#include "output/checkpoint.hpp"
#include "output/report.hpp"
#include "scene/scene.hpp"
#include "simd/tables.hpp"

#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace sandlane::app {

// How an engine speaks of its work.
struct Words {
    std::string thing = "grain", things = "grains"; // what size() counts
    std::string key = "particles";                  // the same in summary.json
    std::string work = "particle-steps";            // one thing times one step: what rates count
    std::string steps = "steps";                    // or sweeps, events
    std::string time_unit = "s";                    // empty: time is counted in steps
    [[nodiscard]] std::string rate_key() const;     // "particle_steps_per_second", in JSON
};

struct Look; // commands.hpp

// The files of a run that only its engine writes: pictures, trajectories, profiles. It holds a reference to
// its engine.
class Recorder {
public:
    virtual ~Recorder() = default;

    // Next step after `step` at which something is due, or `never` (interval.hpp).
    [[nodiscard]] virtual std::int64_t next_due(std::int64_t step) const = 0;
    // Of what is due by time: when next, s.
    [[nodiscard]] virtual double next_time() const { return std::numeric_limits<double>::infinity(); }
    // Writes what is due at the present step; all: every kind (start of a run).
    virtual void write_due(bool all) = 0;
    // What a checkpoint must remember so that the files go on without a gap, by name of output.
    virtual void add_bookmarks(std::map<std::string, std::string>& bookmarks) = 0;
    // Brings tables up to date that wait for the end, also of a run that was stopped.
    virtual void finish() {}
    // pictures/000000.png and so on, of which a movie is made.
    [[nodiscard]] virtual std::int64_t pictures() const { return 0; }
    // A replay, figures.
    virtual void add_to_report(output::ReportInput&) const {}
};

// One decision of a run, such as a candidate that was drawn or an event that was taken. The runs of a scene
// make the same ones in the same order, whatever computes them.
struct Decision {
    std::int64_t step = 0;
    double time = 0;                     // s
    std::uint32_t place = 0, number = 0; // cell, and candidate there
    std::uint32_t first = 0, second = 0; // identities
    std::uint32_t outcome = 0;
    friend bool operator==(const Decision&, const Decision&) = default;
};

// What intervals of outputs are counted in.
struct Pace {
    enum class Kind { steps, time, log_time } kind = Kind::steps;
    double first = 0; // log_time: of the first output, s, by default
};

class Engine {
public:
    virtual ~Engine() = default;

    [[nodiscard]] virtual const Words& words() const = 0;
    [[nodiscard]] virtual const scene::Scene& scene() const = 0;
    [[nodiscard]] virtual simd::Isa isa() const = 0;
    [[nodiscard]] virtual int threads() const = 0;

    // ---- going on
    virtual void run(std::int64_t steps) = 0;
    // The same, but not beyond a time: for engines of which pace() says that outputs go by time.
    virtual void run_until(std::int64_t steps, double until) {
        (void)until;
        run(steps);
    }
    [[nodiscard]] virtual std::int64_t step() const = 0;  // done since the start of the scene
    [[nodiscard]] virtual std::int64_t steps() const = 0; // that the scene asks for
    // The same, for progress, where only finished() tells.
    [[nodiscard]] virtual std::int64_t expected_steps() const { return steps(); }
    [[nodiscard]] virtual bool finished() const { return false; } // further steps would change nothing
    // Where steps have unequal lengths they are counted in parts: run() ends with the first whole step at or
    // after the parts asked for, all steps meet at multiples of stride(), and taken() counts them since the
    // program started.
    [[nodiscard]] virtual std::int64_t stride() const { return 1; }
    [[nodiscard]] virtual std::int64_t taken() const { return step(); }
    [[nodiscard]] virtual double time() const = 0; // at step()
    // Where outputs go by time: all that happens up to this time, and at it, is done, s.
    [[nodiscard]] virtual double reached() const { return time(); }
    [[nodiscard]] virtual double time_step() const = 0; // intervals of outputs are counted in it
    [[nodiscard]] virtual double duration() const = 0;  // intervals of outputs are parts of it
    // asked: of an output whose interval the scene gives.
    [[nodiscard]] virtual Pace pace(bool asked) const {
        (void)asked;
        return {};
    }
    [[nodiscard]] virtual std::size_t size() const = 0; // grains, sites: what a step works on
    // What so many steps are counted as, in units of words().work.
    [[nodiscard]] virtual double work(std::int64_t steps) const {
        return static_cast<double>(steps) * static_cast<double>(size());
    }

    // ---- state: equal hashes mean equal bits, whatever the threads and the instruction set
    [[nodiscard]] virtual Hash128 state_hash() const = 0;
    virtual void serialise(ByteWriter& out) const = 0;
    // Of an engine made from the same scene. Throws Error(io) that names `origin` if the state does not
    // belong to it.
    virtual void restore(const std::string& state, const std::string& origin) = 0;

    // ---- comparison, quantity by quantity
    [[nodiscard]] virtual std::vector<Difference> compare_state(const Engine& other) const = 0;
    // What kernels_compared() says, from the present state by the kernels of two instruction sets.
    [[nodiscard]] virtual std::vector<Difference> compare_kernels(simd::Isa first,
                                                                  simd::Isa second) const = 0;
    [[nodiscard]] virtual std::string kernels_compared() const = 0; // "Forces of the initial state"

    // ---- decisions, where an engine draws or orders them
    virtual bool keep_decisions() { return false; } // from now on; false: there are none
    [[nodiscard]] virtual std::vector<Decision> take_decisions() { return {}; } // since the last call
    [[nodiscard]] virtual std::string tell(const Decision&) const { return {}; }

    // ---- outputs
    [[nodiscard]] virtual std::vector<analysis::LogColumn> log_columns() const = 0;
    [[nodiscard]] virtual std::vector<double> log_row() = 0; // one number per column
    // After a row of the log and its warnings. Throws Error(unstable) where the row is beyond a limit of the
    // scene.
    virtual void judge() {}
    // Warnings since the last call.
    [[nodiscard]] virtual std::vector<std::string> news() { return {}; }
    // resume: go on with the files of the folder where the checkpoint says; null: a fresh folder.
    [[nodiscard]] virtual std::unique_ptr<Recorder> recorder(const std::filesystem::path& folder,
                                                             const output::Checkpoint* resume) = 0;
    // Throws Error(invalid_input) for a look that the engine does not have.
    virtual void draw(const std::filesystem::path& png, const Look& look) const = 0;
    [[nodiscard]] virtual std::string plan_json() const = 0;              // the object "plan" of summary.json
    [[nodiscard]] virtual std::string summary_json() const { return {}; } // more members: "\"removed\": 3, "
    [[nodiscard]] virtual std::vector<std::pair<std::string, std::string>> report_rows() const = 0;
};

// What runs the scene, resolved once.
struct Machine {
    simd::Isa isa = simd::Isa::scalar;
    ThreadChoice threads;
};

class Setup {
public:
    virtual ~Setup() = default;

    [[nodiscard]] virtual double memory_bytes() const = 0;
    [[nodiscard]] virtual std::string description() const = 0; // the text of `sandlane check`
    [[nodiscard]] virtual std::string json() const = 0;        // the object of `sandlane check --json`
    // At the start of the scene, by the instruction set of the plan or by another one.
    [[nodiscard]] virtual std::unique_ptr<Engine> start() = 0;
    [[nodiscard]] virtual std::unique_ptr<Engine> start(simd::Isa isa) = 0;
};

// By the method of the scene. Throws Error(invalid_input) for what the engine cannot do.
[[nodiscard]] std::unique_ptr<Setup> make_setup(scene::Scene scene, const Machine& machine);

#define ENGINE(choice, name, what)                                                                           \
    [[nodiscard]] std::unique_ptr<Setup> prepare_##choice(scene::Scene scene, const Machine& machine);
#include "scene/engines.def"

} // namespace sandlane::app
