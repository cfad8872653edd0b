// Checkpoint files: everything that a run needs to go on bit for bit, with another thread count or
// instruction set too. Layout: magic, version, content, length and XXH3-128 of the content. Written
// atomically, and piece by piece.
#pragma once

#include "core/bytes.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>

namespace sandlane::output {

inline constexpr std::uint32_t checkpoint_version = 6;

struct Progress {
    std::string scene; // effective scene, TOML
    std::int64_t step = 0;
    double wall_seconds = 0;                      // spent before
    std::map<std::string, std::string> bookmarks; // output -> where it continues
};

struct Checkpoint : Progress {
    std::string engine_state;
};

// Empty without a checkpoint, or if it knows no such output.
[[nodiscard]] std::string bookmark_in(const Checkpoint* checkpoint, const std::string& name);

// state: puts the state of the engine.
void write_checkpoint(const std::filesystem::path& path, const Progress& progress,
                      const std::function<void(ByteWriter&)>& state);

// Throws Error(invalid_input) for a missing file and Error(io) for one that is damaged or of another version.
[[nodiscard]] Checkpoint read_checkpoint(const std::filesystem::path& path);
[[nodiscard]] Checkpoint parse_checkpoint(const std::string& bytes, const std::string& name);

} // namespace sandlane::output
