// Files of grains, read for a scene of either dimension.
#include "core/error.hpp"
#include "scene/population.hpp"

#include <cmath>
#include <cstdlib>

using namespace sandlane;

namespace {

void read(const std::string& text, std::int64_t dimension) {
    scene::Scene s;
    s.domain.dimension = dimension;
    for (const char* name : {"glass", "steel"}) s.materials.emplace_back().name = name;
    s.grains.emplace_back().kind = scene::GrainKind::file;
    try {
        for (const scene::GrainState& g : scene::parse_grains(text, "fuzz.csv", s, s.grains[0], {}))
            if (!(g.radius > 0 && std::isfinite(g.position.x)) || g.material < 0 || g.material > 1)
                std::abort();
    } catch (const Error&) {
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text(reinterpret_cast<const char*>(data), size);
    read(text, 2);
    read(text, 3);
    return 0;
}
