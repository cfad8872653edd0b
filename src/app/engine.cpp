#include "app/engine.hpp"

#include "core/error.hpp"

#include <algorithm>

namespace sandlane::app {

std::string Words::rate_key() const {
    std::string name = work + "_per_second";
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
}

std::unique_ptr<Setup> make_setup(scene::Scene scene, const Machine& machine) {
    switch (scene.method) {
#define ENGINE(choice, name, what)                                                                           \
    case scene::Engine::choice:                                                                              \
        return prepare_##choice(std::move(scene), machine);
#include "scene/engines.def"
    }
    fail(Exit::internal, "a scene without an engine");
}

} // namespace sandlane::app
