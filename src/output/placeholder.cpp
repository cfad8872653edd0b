#include "output/picture.hpp"
#include "output/report.hpp"
namespace sandlane::output {
void write_picture(const std::filesystem::path&, const analysis::Snapshot&, const PictureStyle&) {}
std::string write_movie(const std::filesystem::path&) {
    return {};
}
void ReplayRecorder::add(const analysis::Snapshot&) {}
void write_report(const std::filesystem::path&, const ReportInput&, const ReplayRecorder&) {}
} // namespace sandlane::output
