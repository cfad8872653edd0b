// report.html: one self-contained page (no network) with plots of the log and a replay of the grains.
#pragma once

#include "analysis/snapshot.hpp"
#include "output/replay.hpp"
#include "scene/scene.hpp"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace sandlane::output {

// A picture in the report.
struct Figure {
    std::string caption, png; // bytes
    std::string svg = {};     // instead of them
};

struct ReportInput {
    scene::Scene scene;                                       // title, domain, colour and body are shown
    std::vector<std::pair<std::string, std::string>> summary; // label, value
    std::string plan;                                         // the text of `sandlane check`
    std::string scene_text;                                   // the effective scene
    analysis::Log log;
    std::vector<ReplayFrame> replay;
    std::vector<Figure> figures;
};

// A long log and replay are thinned so that the page stays below about 5 MB; the page says so.
// Throws Error(io) if it cannot be written.
void write_report(const std::filesystem::path& path, const ReportInput& input);

} // namespace sandlane::output
