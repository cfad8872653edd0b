// Scene files: any text ends as a scene, which then survives being written and read, or as an Error. Small
// scenes get their grains and their plan.
#include "core/error.hpp"
#include "md/plan.hpp"
#include "scene/population.hpp"
#include "scene/reader.hpp"
#include "scene/wall_geometry.hpp"

#include <cstdlib>

using namespace sandlane;

namespace {

bool is_small(const scene::Scene& s) {
    double work = 0;
    for (std::size_t n = 0; n < s.grains.size(); ++n) {
        if (s.grains[n].kind == scene::GrainKind::file) return false; // no other files are touched
        work += scene::expected_grains(s, n);
    }
    for (const scene::Wall& w : s.walls)
        if (w.kind == scene::WallKind::grains) work += scene::wall_grain_count(w);
    return work < 200;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        const std::string text(reinterpret_cast<const char*>(data), size);
        const scene::Scene s = scene::parse_scene(text, "fuzz.toml");
        const std::string written = scene::write_scene(s);
        if (scene::write_scene(scene::parse_scene(written, "written.toml")) != written) std::abort();
        if (s.method != scene::Engine::md || !is_small(s)) return 0;
        const md::Needs needs = md::analyse(s, scene::initial_grains(s));
        const md::Plan plan = md::make_plan(s, needs, md::derive(s, needs), simd::Isa::scalar, {1, "fuzz"});
        if (!(plan.dt > 0) || plan.steps < 0) std::abort();
    } catch (const Error&) {
    }
    return 0;
}
