// report.html: one self-contained page (no network) with plots of the log and a replay of the grains.
#pragma once

#include "analysis/snapshot.hpp"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace sandlane::output {

struct ReportInput {
    std::string title, description;
    std::vector<std::pair<std::string, std::string>> summary; // label, value
    std::string plan;                                         // the text of `sandlane check`
    std::string scene_text;                                   // the effective scene
    analysis::Log log;
};

// Collects frames for the replay while the run goes on, thinned so that the page stays below about 5 MB.
class ReplayRecorder {
public:
    void add(const analysis::Snapshot& snapshot);
    [[nodiscard]] const std::vector<analysis::Snapshot>& frames() const { return frames_; }
    [[nodiscard]] std::int64_t stride() const { return stride_; } // every stride-th snapshot was kept

private:
    std::vector<analysis::Snapshot> frames_;
    std::int64_t stride_ = 1;
    [[maybe_unused]] std::int64_t seen_ = 0;
};

void write_report(const std::filesystem::path& path, const ReportInput& input, const ReplayRecorder& replay);

} // namespace sandlane::output
