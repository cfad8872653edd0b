// Numbers with units, and keys given on the command line: "domain.upper=[1, 2]".
#include "core/error.hpp"
#include "scene/reader.hpp"
#include "scene/units.hpp"

#include <cmath>
#include <cstdlib>

using namespace sandlane;

namespace {

constexpr const char* scenes[] = {
    R"(domain = { upper = [1, 1] }
materials = [{ name = "glass", stiffness = 1e4 }]
grains = [{ kind = "single", radius = 0.01, position = [0.5, 0.5] }]
md = { max_speed = 1, duration = 1 })",
    R"(method = "dsmc"
domain = { dimension = 2, upper = [8, 8], periodic = ["x", "y"] }
gas = { particles = 12, temperature = 1 }
dsmc = { dt = 0.1, duration = 1 })",
    R"(method = "heap"
heap = { columns = 12, steps = 40 })",
};

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text(reinterpret_cast<const char*>(data), size);
    for (int unit = 0; unit <= static_cast<int>(scene::Unit::heating); ++unit) {
        double value = 0;
        if (scene::parse_quantity(text, static_cast<scene::Unit>(unit), value).empty() && std::isnan(value))
            std::abort();
    }
    for (const char* scene : scenes) try {
            const std::string written = scene::write_scene(scene::parse_scene(scene, "fuzz.toml", {text}));
            if (scene::write_scene(scene::parse_scene(written, "written.toml")) != written) std::abort();
        } catch (const Error&) {
        }
    return 0;
}
