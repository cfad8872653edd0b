// The analyses of a run: when each is due, and its files.
#pragma once

#include "analysis/snapshot.hpp"
#include "md/simulation.hpp"
#include "output/analysis_file.hpp"
#include "output/checkpoint.hpp"

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace sandlane::app {

class MdAnalyses {
public:
    // scene: with the time step of the run. resume: null for a fresh run.
    void open(const std::filesystem::path& folder, const scene::Scene& scene, std::int64_t stride,
              const output::Checkpoint* resume);

    [[nodiscard]] std::int64_t next_due(std::int64_t step) const;
    // all: at the start of a run, whatever the step.
    [[nodiscard]] bool due(std::int64_t step, bool all) const;
    // snapshot: of the simulation as it stands.
    void write_due(const md::Simulation& simulation, const analysis::Snapshot& snapshot, bool all);
    void add_bookmarks(std::map<std::string, std::string>& bookmarks);
    void draw(const md::Simulation& simulation) const;

private:
    struct Entry {
        std::string bookmark;      // its name
        std::int64_t every, start; // steps
        output::AnalysisFile file;

        [[nodiscard]] bool due(std::int64_t step, bool all) const {
            return step >= start && (all || (every > 0 && step % every == 0));
        }
    };
    std::vector<Entry> entries_;
};

} // namespace sandlane::app
