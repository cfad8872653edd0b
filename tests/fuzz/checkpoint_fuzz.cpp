// Checkpoints. First byte 1: the rest is a file, and then the content of one. Else the rest
// is a list of patches (offset, eight bytes) of the state of a small run, behind the checksum: on the
// lattice, or for 2 with lists and contacts that remember.
#include "core/bytes.hpp"
#include "core/error.hpp"
#include "core/hash.hpp"
#include "md/simulation.hpp"
#include "output/checkpoint.hpp"
#include "scene/reader.hpp"

#include <cstring>

using namespace sandlane;

namespace {

constexpr const char* scene_text = R"(
[domain]
lower = [0, 0]
upper = [1, 1]
periodic = ["x"]
gravity = [0, -1]
[[materials]]
name = "glass"
young = 1e6
friction = 0.5
tangential_damping = 0.1
tangential_stiffness = 100
[[grains]]
kind = "lattice"
radius = { law = "uniform", min = 0.045, max = 0.0488 }
lower = [0.1, 0.065]
counts = [8, 3]
spacing = [0.0955, 0.0955] # the largest overlap is below the legal one, so that contacts remember
[[grains]]
kind = "pour"
radius = 0.05
count = 3
rate = 1000
lower = [0.1, 0.8]
upper = [0.9, 0.9]
[[walls]]
kind = "segment"
points = [[0, 0.019], [1, 0.019]]
[md]
max_speed = 0.1
)";

md::Simulation new_run(const scene::Overrides& overrides) {
    const scene::Scene s = scene::parse_scene(scene_text, "fuzz.toml", overrides);
    const auto grains = scene::initial_grains(s);
    const md::Needs needs = md::analyse(s, grains);
    return {s, grains, needs, md::make_plan(s, needs, md::derive(s, needs), simd::Isa::scalar, {1, "fuzz"})};
}

void read_file_of(const std::string& bytes) {
    try {
        (void)output::parse_checkpoint(bytes, "fuzz.checkpoint");
    } catch (const Error&) {
    }
    const Hash128 hash = hash_bytes(bytes.data(), bytes.size());
    ByteWriter file;
    file.put_bytes("SANDLANE");
    file.put(output::checkpoint_version);
    file.put_bytes(bytes);
    file.put(static_cast<std::uint64_t>(bytes.size()));
    file.put(hash.high);
    file.put(hash.low);
    (void)output::parse_checkpoint(file.bytes(), "fuzz.checkpoint");
}

struct Run {
    md::Simulation fresh;
    std::string state; // after ten steps

    explicit Run(const scene::Overrides& overrides) : fresh(new_run(overrides)) {
        md::Simulation run = fresh;
        run.run(10);
        state = run.serialise();
    }
};

void restore_patched(const Run& run, const std::uint8_t* data, std::size_t size) {
    std::string bytes = run.state;
    constexpr std::size_t patch = 10;
    for (; size >= patch; data += patch, size -= patch) {
        std::uint16_t offset = 0;
        std::memcpy(&offset, data, sizeof offset);
        const std::size_t at = offset % (bytes.size() - 8);
        std::memcpy(bytes.data() + at, data + 2, 8);
    }
    if (size > 0) bytes.resize(bytes.size() * data[0] / 255);
    md::Simulation simulation = run.fresh;
    simulation.restore(bytes);
    (void)simulation.state_hash();
    simulation.run(3);
    (void)simulation.snapshot();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    static const Run on_lattice({"md.neighbours=lattice"});
    static const Run with_springs({"md.tangential=cundall-strack"});
    try {
        if (data[0] == 1)
            read_file_of(std::string(reinterpret_cast<const char*>(data + 1), size - 1));
        else
            restore_patched(data[0] == 2 ? with_springs : on_lattice, data + 1, size - 1);
    } catch (const Error&) {
    }
    return 0;
}
