// States of gases and automata, which checkpoints hold behind their checksum. The first byte chooses the
// scene, the rest is a list of patches (offset, eight bytes); what is left over cuts the state off.
#include "automata/model.hpp"
#include "core/error.hpp"
#include "dsmc/plan.hpp"
#include "dsmc/simulation.hpp"
#include "edmd/plan.hpp"
#include "scene/reader.hpp"

#include <cstring>
#include <functional>
#include <memory>

using namespace sandlane;

namespace {

constexpr const char* gas = R"(
domain = { dimension = 3, upper = [4, 4, 4], periodic = ["x"] }
gas = { particles = 20, temperature = 1, diameter = 0.6, restitution = 0.9, tangential_restitution = 0.3 }
species = [{ particles = 3, mass = 4, diameter = 0.8 }]
[[sides]]
side = "-z"
kind = "heated"
temperature = 1
)";
const std::string plane = R"(
domain = { dimension = 2, upper = [8, 8], periodic = ["x", "y"] }
gas = { particles = 12, temperature = 1, restitution = 0.8 }
)";

const std::string scenes[] = {
    std::string("method = \"dsmc\"\n") + gas + "[dsmc]\ncells = [2, 2, 2]\ndt = 0.1\nduration = 1\n",
    "method = \"dsmc\"\n" + plane + "[dsmc]\ncells = [4, 4]\ndt = 0.1\nduration = 1\nadaptive = true\n",
    std::string("method = \"edmd\"\n") + gas + "[edmd]\nevents = 100\n",
    "method = \"edmd\"\n" + plane + "[edmd]\nevents = 100\nalgorithm = \"improved\"\n",
    "method = \"edmd\"\n" + plane + "[edmd]\nevents = 100\nalgorithm = \"simple\"\n",
    "method = \"sandpile\"\n[sandpile]\ncolumns = 9\nrows = 7\ncentre = 60\n",
    "method = \"sandpile\"\n[sandpile]\ncolumns = 8\nrows = 8\nstart = \"identity-doubled\"\n",
    "method = \"heap\"\n[heap]\ncolumns = 12\nheaps = 2\nsteps = 40\nroughness = 0.5\nsteepest = 2\nsides = "
    "\"two\"\n",
    "method = \"ripples\"\n[ripples]\ncolumns = 12\nrows = 4\nsteps = 10\n",
    "method = \"ripples\"\n[ripples]\ncolumns = 12\nsteps = 10\narithmetic = \"floating\"\n",
    "method = \"lattice-gas\"\n[lattice_gas]\nrule = \"fhp-3\"\ncolumns = 70\nrows = 4\nsteps = 10\n",
    "method = \"pipe-flow\"\n[pipe_flow]\nlength = 70\nwidth = 3\nsteps = 10\nwindow = 4\n",
    "method = \"pipe-flow\"\n[pipe_flow]\nlength = 70\nwidth = 3\nsteps = 10\nvariant = "
    "\"counted-rest\"\ndissipation = 0.5\n",
};

// A run of one scene after some steps, and what takes up a state of it.
struct Run {
    std::string state;
    std::function<void(const std::string&)> take_up;
};

Run run_gas(const scene::Scene& s) {
    const auto plan = std::make_shared<dsmc::Plan>(dsmc::make_plan(s, simd::Isa::scalar, {1, "fuzz"}));
    const auto particles = dsmc::maxwellian(plan->setup, static_cast<std::uint32_t>(dsmc::all_particles(s)),
                                            s.gas.temperature, s.gas.spin_temperature);
    const dsmc::Simulation fresh(plan->setup, particles, simd::Isa::scalar, 1);
    dsmc::Simulation run = fresh;
    run.run(5);
    return {run.serialise(), [fresh](const std::string& state) {
                dsmc::Simulation simulation = fresh;
                simulation.restore(state);
                (void)simulation.state_hash();
                (void)simulation.observe();
                simulation.run(2);
            }};
}

Run run_events(const scene::Scene& s) {
    const auto plan = std::make_shared<edmd::Plan>(edmd::make_plan(s, simd::Isa::scalar, {1, "fuzz"}));
    const auto run = edmd::start(s, *plan, simd::Isa::scalar);
    run->run(50);
    return {run->serialise(), [s, plan](const std::string& state) {
                const auto simulation = edmd::start(s, *plan, simd::Isa::scalar);
                simulation->restore(state);
                (void)simulation->state_hash();
                (void)edmd::observe(simulation->setup(), simulation->particles());
                // No step: a particle that fell far behind may cross cells without end before anything
                // happens.
            }};
}

Run run_automaton(const scene::Scene& s) {
    const automata::Means means{simd::Isa::scalar, 1};
    const std::unique_ptr<automata::Model> run = automata::make_model(s, means);
    run->run(7);
    return {run->serialise(), [s, means](const std::string& state) {
                const std::unique_ptr<automata::Model> model = automata::make_model(s, means);
                model->restore(state);
                (void)model->state_hash();
                (void)model->log_row();
                (void)model->quantities();
                (void)model->final_tables();
                // A mountain of a million grains is a state like others, but its avalanches take long.
                if (s.method != scene::Engine::heap) model->run(2);
                (void)model->fields();
            }};
}

Run start(const std::string& text) {
    const scene::Scene s = scene::parse_scene(text, "fuzz.toml");
    if (s.method == scene::Engine::dsmc) return run_gas(s);
    if (s.method == scene::Engine::edmd) return run_events(s);
    return run_automaton(s);
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    static const std::vector<Run> runs = [] {
        std::vector<Run> all;
        for (const std::string& scene : scenes) all.push_back(start(scene));
        return all;
    }();
    const Run& run = runs[data[0] % runs.size()];
    std::string bytes = run.state;
    constexpr std::size_t patch = 10;
    for (++data, --size; size >= patch; data += patch, size -= patch) {
        std::uint16_t offset = 0;
        std::memcpy(&offset, data, sizeof offset);
        std::memcpy(bytes.data() + offset % (bytes.size() - 8), data + 2, 8);
    }
    if (size > 0) bytes.resize(bytes.size() * data[0] / 255);
    try {
        run.take_up(bytes);
    } catch (const Error&) {
    }
    return 0;
}
