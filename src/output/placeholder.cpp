#include "output/report.hpp"
namespace sandlane::output {
void ReplayRecorder::add(const analysis::Snapshot&) {}
void write_report(const std::filesystem::path&, const ReportInput&, const ReplayRecorder&) {}
} // namespace sandlane::output
