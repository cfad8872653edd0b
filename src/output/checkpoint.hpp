// Checkpoint files: everything that a run needs to go on bit for bit, with another thread count or
// instruction set too. Layout: magic, version, length, XXH3-128 of the content, content (named sections).
// Written atomically.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

namespace sandlane::output {

struct Checkpoint {
    std::string scene;        // effective scene, TOML
    std::string engine_state; // Simulation::serialise()
    std::int64_t step = 0;
    double wall_seconds = 0;                      // spent before
    std::map<std::string, std::string> bookmarks; // output -> where it continues
};

// Empty without a checkpoint, or if it knows no such output.
[[nodiscard]] std::string bookmark_in(const Checkpoint* checkpoint, const std::string& name);

void write_checkpoint(const std::filesystem::path& path, const Checkpoint& checkpoint);

// Throws Error(invalid_input) for a missing file and Error(io) for one that is damaged or of another version.
[[nodiscard]] Checkpoint read_checkpoint(const std::filesystem::path& path);
[[nodiscard]] Checkpoint parse_checkpoint(const std::string& bytes, const std::string& name);

} // namespace sandlane::output
