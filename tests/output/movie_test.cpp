// Movies, with a stand-in for ffmpeg that notes its arguments, and with ffmpeg itself where it is installed.
#include "output/picture.hpp"

#include "output/canvas.hpp"

#include "output/sample.hpp"
#include "output/support.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

using namespace sandlane;
using namespace sandlane::output;
namespace fs = std::filesystem;

namespace {

// PATH as long as this lives.
class Path {
public:
    explicit Path(const fs::path& folder) : before_(std::getenv("PATH")) {
        ::setenv("PATH", folder.c_str(), 1);
    }
    Path(const Path&) = delete;
    Path& operator=(const Path&) = delete;
    ~Path() { ::setenv("PATH", before_.c_str(), 1); }

private:
    std::string before_;
};

// A run folder whose name a shell would take apart, with two pictures.
fs::path make_run(const sample::Folder& folder) {
    fs::path run = folder / "it's a run";
    fs::create_directories(run / "pictures");
    for (const char* name : {"000000.png", "000001.png"}) write_file_atomically(run / "pictures" / name, "");
    return run;
}

// bin/ffmpeg: writes its arguments to `arguments`, one a line, and ends with this code.
fs::path make_ffmpeg(const sample::Folder& folder, int code) {
    fs::create_directories(folder / "bin");
    const fs::path program = folder / "bin" / "ffmpeg";
    write_file_atomically(program, fmt::format("#!/bin/sh\nprintf '%s\\n' \"$@\" > {}\nexit {}\n",
                                               (folder / "arguments").string(), code));
    fs::permissions(program, fs::perms::owner_all);
    return folder / "bin";
}

bool contains(const std::vector<std::string>& words, const std::string& word) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

} // namespace

TEST(Movie, FfmpegGetsPicturesAndTarget) {
    const sample::Folder folder("movie");
    const fs::path run = make_run(folder);
    const Path path(make_ffmpeg(folder, 0));
    EXPECT_EQ(write_movie(run), "");
    const auto arguments = lines_of(folder / "arguments");
    EXPECT_TRUE(contains(arguments, (run / "pictures" / "%06d.png").string()));
    EXPECT_EQ(arguments.back(), (run / "movie.mp4").string());
}

TEST(Movie, WithoutFfmpegTheCommandIsTold) {
    const sample::Folder folder("no-ffmpeg");
    const fs::path run = make_run(folder);
    std::string command;
    {
        const Path path(folder / "empty");
        command = write_movie(run);
    }
    EXPECT_EQ(command.substr(0, 7), "ffmpeg ");
    // A shell takes it apart into the same arguments.
    std::vector<std::string> direct;
    {
        const Path path(make_ffmpeg(folder, 0));
        EXPECT_EQ(write_movie(run), "");
        direct = lines_of(folder / "arguments");
        ASSERT_EQ(std::system(command.c_str()), 0); // NOLINT(*-env33-c): the stand-in
    }
    EXPECT_EQ(lines_of(folder / "arguments"), direct);
}

TEST(Movie, AFailingFfmpegIsNoSuccess) {
    const sample::Folder folder("failing-ffmpeg");
    const Path path(make_ffmpeg(folder, 1));
    EXPECT_NE(write_movie(make_run(folder)), "");
}

TEST(Movie, NoPicturesNoMovie) {
    const sample::Folder folder("no-pictures");
    const Path path(make_ffmpeg(folder, 0));
    EXPECT_NE(write_movie(folder.path()), "");
    EXPECT_FALSE(fs::exists(folder / "arguments"));
}

TEST(Movie, FailureLeavesNoHalfMovie) {
    const sample::Folder folder("half-movie");
    const fs::path run = make_run(folder);
    write_file_atomically(run / "movie.mp4", "half");
    const Path path(make_ffmpeg(folder, 1));
    EXPECT_NE(write_movie(run), "");
    EXPECT_FALSE(fs::exists(run / "movie.mp4"));
}

// Pictures of an odd size, in a folder whose name means something to ffmpeg.
TEST(Movie, FfmpegMakesOneOfPictures) {
    if (std::system("ffmpeg -version > /dev/null 2>&1") != 0) // NOLINT(*-env33-c): whether it is there
        GTEST_SKIP() << "ffmpeg is not installed";
    const sample::Folder folder("real-movie");
    const fs::path run = folder / "100%d";
    fs::create_directories(run / "pictures");
    constexpr int frames = 12;
    for (int k = 0; k < frames; ++k) {
        const float shade = static_cast<float>(k) / frames;
        write_file_atomically(run / "pictures" / fmt::format("{:06}.png", k),
                              Canvas(65, 33, {shade, shade, shade}).png());
    }
    EXPECT_EQ(write_movie(run), "");
    const std::string movie = read_file(run / "movie.mp4");
    EXPECT_EQ(movie.substr(4, 4), "ftyp");
    // Each picture comes out again, the size made even.
    const fs::path hashes = folder / "hashes";
    const std::string decode = fmt::format("ffmpeg -v error -y -i '{}' -f framehash '{}'",
                                           (run / "movie.mp4").string(), hashes.string());
    ASSERT_EQ(std::system(decode.c_str()), 0); // NOLINT(*-env33-c)
    int decoded = 0;
    bool even = false;
    for (const std::string& line : lines_of(hashes)) {
        decoded += line.starts_with("0,") ? 1 : 0;
        even = even || line == "#dimensions 0: 66x34";
    }
    EXPECT_EQ(decoded, frames);
    EXPECT_TRUE(even);
}
