// TOML text -> validated Scene, and back.
#pragma once

#include "scene/scene.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace sandlane::scene {

// One --set path=value override; the value is TOML ("md.dt=1e-6", "materials.0.friction=0.3").
using Overrides = std::vector<std::string>;

// Throws Error(invalid_input) with "file:line: key: ..." for the first problem found. Files of grains
// and of triangles are looked for beside the scene file; in the scene their names are absolute.
[[nodiscard]] Scene read_scene(const std::filesystem::path& path, const Overrides& overrides = {});
[[nodiscard]] Scene parse_scene(std::string_view text, const std::string& name,
                                const Overrides& overrides = {});

// The effective scene with every key written out; parse_scene(write_scene(s)) gives s again.
[[nodiscard]] std::string write_scene(const Scene& scene);

// The scene reference (Markdown) and the same for --help, generated from the schema.
[[nodiscard]] std::string scene_reference();

} // namespace sandlane::scene
