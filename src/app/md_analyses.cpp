#include "app/md_analyses.hpp"

#include "app/interval.hpp"

#include <algorithm>
#include <cmath>

namespace sandlane::app {

void MdAnalyses::open(const std::filesystem::path& folder, const scene::Scene& scene, std::int64_t stride,
                      const output::Checkpoint* resume) {
    for (const scene::AnalysisSpec& spec : scene.analyses) {
        const std::string name = "analysis " + spec.name;
        const std::int64_t every = interval(spec.every, scene.md.duration, 100, scene.md.dt, stride);
        const double start = std::ceil(spec.start / scene.md.dt * (1 - 1e-14));
        entries_.push_back({name, every, start < 1e15 ? static_cast<std::int64_t>(start) : never,
                            output::AnalysisFile(folder, scene, spec, output::bookmark_in(resume, name))});
    }
}

std::int64_t MdAnalyses::next_due(std::int64_t step) const {
    std::int64_t next = never;
    for (const Entry& entry : entries_) {
        if (entry.start == never) continue;
        const std::int64_t after = std::max(step, entry.start - 1);
        next = std::min(next, next_multiple(after, entry.every));
    }
    return next;
}

bool MdAnalyses::due(std::int64_t step, bool all) const {
    return std::any_of(entries_.begin(), entries_.end(),
                       [&](const Entry& entry) { return entry.due(step, all); });
}

void MdAnalyses::write_due(const md::Simulation& simulation, const analysis::Snapshot& snapshot, bool all) {
    const analysis::Contacts contacts = simulation.contacts();
    for (Entry& entry : entries_)
        if (entry.due(simulation.step(), all)) entry.file.write({snapshot, contacts});
}

void MdAnalyses::add_bookmarks(std::map<std::string, std::string>& bookmarks) {
    for (Entry& entry : entries_) bookmarks[entry.bookmark] = entry.file.bookmark();
}

void MdAnalyses::draw(const md::Simulation& simulation) const {
    if (entries_.empty()) return;
    const analysis::Snapshot snapshot = simulation.snapshot();
    for (const Entry& entry : entries_) entry.file.draw(snapshot);
}

} // namespace sandlane::app
