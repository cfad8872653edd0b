// NAME.csv of one [[analysis]], and its pictures.
#pragma once

#include "analysis/analysis.hpp"
#include "output/log.hpp"

#include <filesystem>
#include <memory>
#include <string>

namespace sandlane::output {

class AnalysisFile {
public:
    // bookmark: empty for a new file, else what bookmark() returned before. Throws Error(io) naming the file.
    AnalysisFile(std::filesystem::path folder, const scene::Scene& scene, const scene::AnalysisSpec& spec,
                 const std::string& bookmark = {});

    // Adds rows to a series. The table of an average waits for the next bookmark: most frames would be
    // written for nothing.
    void write(const analysis::Frame& frame);
    // Pictures of the grids, NAME-GRID.png, with the walls as they stand in the snapshot.
    void draw(const analysis::Snapshot& snapshot) const;
    // Brings the file up to date.
    [[nodiscard]] std::string bookmark();

private:
    [[nodiscard]] std::filesystem::path file(const std::string& ending) const;
    void restore(const std::string& bookmark);
    void open_series(const std::string& bookmark);

    std::filesystem::path folder_;
    std::string name_;
    int width_; // of pictures, pixels
    std::unique_ptr<analysis::Analysis> analysis_;
    std::unique_ptr<LogWriter> series_; // null for an average
};

} // namespace sandlane::output
