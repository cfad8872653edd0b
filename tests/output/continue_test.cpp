// A run that goes on from a checkpoint leaves the files of a run without a break, byte for byte.
#include "output/log.hpp"
#include "output/picture_series.hpp"
#include "output/replay.hpp"
#include "output/writers.hpp"

#include "output/sample.hpp"
#include "output/support.hpp"

#include <gtest/gtest.h>

#include <memory>

using namespace sandlane;
using namespace sandlane::output;
namespace fs = std::filesystem;

namespace {

// Writes three frames, takes the bookmark, writes two more; then opens again at the bookmark and writes the
// two again. open(folder, bookmark) returns a pointer to something with write(snapshot) and bookmark().
template <analysis::Snapshot (*snapshot)(int) = sample::walled_row, class Open>
void expect_same_files(const Open& open) {
    const sample::Folder folder("continue");
    std::string bookmark;
    std::map<std::string, std::string> at_bookmark;
    {
        const auto writer = open(folder.path(), std::string());
        for (int n = 0; n < 3; ++n) writer->write(snapshot(n));
        bookmark = writer->bookmark();
        at_bookmark = files_of(folder.path());
        for (int n = 3; n < 5; ++n) writer->write(snapshot(n));
    }
    const auto undisturbed = files_of(folder.path());
    ASSERT_FALSE(undisturbed.empty());
    EXPECT_NE(undisturbed, at_bookmark);
    {
        const auto writer = open(folder.path(), bookmark);
        EXPECT_EQ(writer->bookmark(), bookmark);
        EXPECT_EQ(files_of(folder.path()), at_bookmark); // what came after the checkpoint is cut off
        for (int n = 3; n < 5; ++n) writer->write(snapshot(n));
    }
    EXPECT_EQ(files_of(folder.path()), undisturbed);
}

class LogOfSnapshots {
public:
    LogOfSnapshots(const fs::path& folder, const std::string& bookmark)
        : log_(folder / "log.csv", {{"time", "s"}, {"x", "m"}}, bookmark) {}
    void write(const analysis::Snapshot& s) {
        log_.write(std::vector<std::vector<double>>{{s.time, s.x[0]}});
    }
    [[nodiscard]] std::string bookmark() { return log_.bookmark(); }

private:
    LogWriter log_;
};

// The fastest frame comes first: the scale of later pictures is known only from the bookmark.
class SlowingPictures {
public:
    SlowingPictures(const fs::path& folder, const std::string& bookmark)
        : pictures_(folder / "pictures", small(), bookmark) {}
    void write(analysis::Snapshot s) {
        for (double& v : s.vy) v = s.step == 0 ? 7 : 0.3;
        pictures_.write(s);
    }
    [[nodiscard]] std::string bookmark() const { return pictures_.bookmark(); }

private:
    static scene::Scene small() {
        scene::Scene scene = sample::scene();
        scene.output.picture_width = 100;
        return scene;
    }
    PictureSeries pictures_;
};

} // namespace

TEST(Continue, Trajectories) {
    for (const auto kind :
         {scene::Trajectory::dump, scene::Trajectory::xyz, scene::Trajectory::vtp, scene::Trajectory::book}) {
        SCOPED_TRACE(static_cast<int>(kind));
        scene::Scene scene = sample::scene();
        scene.walls.resize(1);
        scene.walls[0].motion = "lift";
        expect_same_files([&](const fs::path& folder, const std::string& bookmark) {
            return make_trajectory_writer(kind, folder, scene, bookmark);
        });
    }
}

TEST(Continue, TrajectoriesOfSpace) {
    for (const auto kind : {scene::Trajectory::dump, scene::Trajectory::xyz, scene::Trajectory::vtp}) {
        SCOPED_TRACE(static_cast<int>(kind));
        scene::Scene scene = sample::space_scene();
        scene.walls.resize(1);
        scene.walls[0].motion = "lift";
        expect_same_files<sample::space_row>([&](const fs::path& folder, const std::string& bookmark) {
            return make_trajectory_writer(kind, folder, scene, bookmark);
        });
    }
}

TEST(Continue, Log) {
    expect_same_files([](const fs::path& folder, const std::string& bookmark) {
        return std::make_unique<LogOfSnapshots>(folder, bookmark);
    });
}

TEST(Continue, Replay) {
    expect_same_files([](const fs::path& folder, const std::string& bookmark) {
        return std::make_unique<ReplayWriter>(folder, bookmark);
    });
}

TEST(Continue, PicturesKeepTheirScale) {
    expect_same_files([](const fs::path& folder, const std::string& bookmark) {
        return std::make_unique<SlowingPictures>(folder, bookmark);
    });
}

TEST(Continue, BookmarksThatFitNothingAreRefused) {
    const sample::Folder folder("bookmarks");
    const scene::Scene scene = sample::scene();
    for (const auto kind :
         {scene::Trajectory::dump, scene::Trajectory::xyz, scene::Trajectory::vtp, scene::Trajectory::book})
        for (const char* bookmark : {"x", "1000000 2", "-5", "1 0.5"})
            EXPECT_NE(refusal(Exit::io,
                              [&] { (void)make_trajectory_writer(kind, folder.path(), scene, bookmark); }),
                      "")
                << static_cast<int>(kind) << " " << bookmark;
    for (const char* bookmark : {"x", "5", "-1 2", "5 x"})
        EXPECT_TRUE(
            has(refusal(Exit::io, [&] { PictureSeries(folder / "pictures", scene, bookmark); }), "pictures"));
}

TEST(Continue, AShortenedFileIsRefused) {
    const sample::Folder folder("shortened");
    std::string bookmark;
    {
        ReplayWriter writer(folder.path());
        writer.write(sample::row(0));
        bookmark = writer.bookmark();
    }
    fs::resize_file(folder / "replay.bin", fs::file_size(folder / "replay.bin") - 1);
    EXPECT_TRUE(has(refusal(Exit::io, [&] { ReplayWriter(folder.path(), bookmark); }), "replay.bin"));
}
