#include "output/writers.hpp"

#include "core/error.hpp"
#include "output/single_file.hpp"
#include "output/text.hpp"
#include "output/writer_list.hpp"

#include <algorithm>

namespace sandlane::output {

SingleFileWriter::SingleFileWriter(const std::filesystem::path& path, const std::string& bookmark)
    : file_(path, length_in(bookmark, path)) {}

void SingleFileWriter::write(const analysis::Snapshot& snapshot) {
    text_.clear();
    format(snapshot, text_);
    file_.write(text_);
    file_.flush();
    constexpr std::size_t kept = std::size_t{1} << 20;
    if (text_.capacity() > kept) std::string().swap(text_);
}

void SingleFileWriter::pass_on(std::string& text) {
    constexpr std::size_t much = std::size_t{1} << 17;
    if (text.size() < much) return;
    file_.write(text);
    text.clear();
}

std::string SingleFileWriter::bookmark() {
    file_.flush();
    return std::to_string(file_.position());
}

std::int64_t length_in(const std::string& bookmark, const std::filesystem::path& path) {
    if (bookmark.empty()) return -1;
    std::int64_t length = -1;
    if (!read_number(bookmark, length) || length < 0)
        fail(Exit::io, "{}: the checkpoint holds \"{}\" where the length of this file is expected",
             path.string(), bookmark);
    return length;
}

DepthRange depth_range(const analysis::Snapshot& snapshot) {
    if (snapshot.dimension == 3) return {snapshot.lower.z, snapshot.upper.z};
    double half = 0;
    for (const double radius : snapshot.radius) half = std::max(half, radius);
    const double width = snapshot.upper.x - snapshot.lower.x;
    if (!(half > 0)) half = width > 0 ? 0.01 * width : 1;
    return {-half, half};
}

std::unique_ptr<TrajectoryWriter> make_trajectory_writer(scene::Trajectory kind,
                                                         const std::filesystem::path& folder,
                                                         const scene::Scene& scene,
                                                         const std::string& bookmark) {
    for (const WriterEntry& entry : writer_list)
        if (entry.kind == kind) return entry.make(folder, scene, bookmark);
    fail(Exit::internal, "trajectory format {} has no writer", static_cast<int>(kind));
}

} // namespace sandlane::output
