// Trajectory files that other tools read. Each writer appends one frame per snapshot.
#pragma once

#include "analysis/snapshot.hpp"
#include "scene/scene.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace sandlane::output {

class TrajectoryWriter {
public:
    virtual ~TrajectoryWriter() = default;
    virtual void write(const analysis::Snapshot& snapshot) = 0;
    // What a checkpoint must remember to continue the files without a gap or a repetition, and its way back.
    [[nodiscard]] virtual std::string bookmark() = 0;
};

// bookmark: empty for a new file, else what bookmark() returned before. Files: trajectory.dump (LAMMPS dump),
// trajectory.xyz (extended XYZ), frames/NNNNNN.vtp with trajectory.pvd, trajectory.book (snapshot
// format 1.14).
[[nodiscard]] std::unique_ptr<TrajectoryWriter> make_trajectory_writer(scene::Trajectory kind,
                                                                       const std::filesystem::path& folder,
                                                                       const scene::Scene& scene,
                                                                       const std::string& bookmark = {});

} // namespace sandlane::output
