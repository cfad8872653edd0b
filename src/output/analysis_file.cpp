#include "output/analysis_file.hpp"

#include "output/colours.hpp"
#include "output/heat_map.hpp"

#include <algorithm>
#include <utility>

namespace sandlane::output {

namespace fs = std::filesystem;

AnalysisFile::AnalysisFile(fs::path folder, const scene::Scene& scene, const scene::AnalysisSpec& spec,
                           const std::string& bookmark)
    : folder_(std::move(folder)), name_(spec.name), width_(static_cast<int>(scene.output.picture_width)),
      analysis_(analysis::make_analysis(scene, spec)) {
    if (!bookmark.empty())
        restore(bookmark);
    else if (analysis_->series())
        open_series({});
}

fs::path AnalysisFile::file(const std::string& ending) const {
    return folder_ / (name_ + ending);
}

void AnalysisFile::open_series(const std::string& bookmark) {
    series_ = std::make_unique<LogWriter>(file(".csv"), analysis_->columns(), bookmark);
}

void AnalysisFile::restore(const std::string& bookmark) {
    std::string position;
    try {
        ByteReader bytes(bookmark);
        position = bytes.get_text();
        analysis_->load(bytes);
        if (!bytes.at_end()) fail(Exit::io, "damaged or truncated content");
    } catch (const Error& e) {
        fail(Exit::io, "{}: the checkpoint does not say how to go on: {}", file(".csv").string(), e.what());
    }
    if (analysis_->series()) open_series(position);
}

void AnalysisFile::write(const analysis::Frame& frame) {
    analysis_->add(frame);
    if (series_ != nullptr) series_->write(analysis_->rows());
}

// Grids of one unit share a colour scale: they are there to be compared.
void AnalysisFile::draw(const analysis::Snapshot& snapshot) const {
    const std::vector<analysis::Grid> grids = analysis_->grids();
    for (const analysis::Grid& grid : grids) {
        double largest = 0;
        for (const analysis::Grid& other : grids)
            if (other.unit == grid.unit) largest = std::max(largest, largest_finite(other.values));
        const HeatMapStyle style{width_, largest > 0 ? round_up(largest) : 0};
        write_heat_map(file("-" + grid.name + ".png"), grid, snapshot.walls, style);
    }
}

std::string AnalysisFile::bookmark() {
    ByteWriter bytes;
    if (series_ != nullptr) {
        bytes.put_text(series_->bookmark());
    } else {
        bytes.put_text("");
        write_file_atomically(file(".csv"), log_text({analysis_->columns(), analysis_->rows()}));
    }
    analysis_->save(bytes);
    return bytes.bytes();
}

} // namespace sandlane::output
