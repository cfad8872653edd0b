// Files: whole or not at all, and errors that name them.
#include "core/file.hpp"

#include "core/error.hpp"
#include "support/says.hpp"

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

#include <unistd.h>

namespace sandlane {

namespace fs = std::filesystem;

namespace {

class Files : public testing::Test {
protected:
    Files() {
        std::string name = (fs::temp_directory_path() / "sandlane-XXXXXX").string();
        if (::mkdtemp(name.data()) != nullptr) folder_ = name;
    }
    ~Files() override { fs::remove_all(folder_); }

    [[nodiscard]] fs::path path(const char* name) const { return folder_ / name; }
    [[nodiscard]] auto entries() const {
        return std::distance(fs::directory_iterator(folder_), fs::directory_iterator());
    }

private:
    fs::path folder_;
};

template <class Action> std::string failure(Exit code, const Action& action) {
    try {
        action();
    } catch (const Error& e) {
        EXPECT_EQ(e.code(), code) << e.what();
        return e.what();
    }
    ADD_FAILURE() << "no error";
    return {};
}

TEST_F(Files, ReadsBackAllBytes) {
    std::string bytes;
    for (int n = 0; n < 256; ++n) bytes += static_cast<char>(n);
    write_file_atomically(path("a"), bytes);
    EXPECT_EQ(read_file(path("a")), bytes);
    write_file_atomically(path("a"), ""); // replaces
    EXPECT_EQ(read_file(path("a")), "");
    EXPECT_EQ(entries(), 1);
}

TEST_F(Files, ErrorsNameThePath) {
    EXPECT_SAYS(failure(Exit::invalid_input, [&] { (void)read_file(path("no")); }),
                path("no").string() + ": no such file");
    EXPECT_SAYS(failure(Exit::invalid_input, [&] { (void)read_file(path(".")); }), "is a folder, not a file");
    const std::string missing = failure(Exit::io, [&] { write_file_atomically(path("no/a"), "x"); });
    EXPECT_SAYS(missing, path("no/a").string() + ": cannot create the file: No such file or directory");
    fs::create_directory(path("folder"));
    EXPECT_SAYS(failure(Exit::io, [&] { write_file_atomically(path("folder"), "x"); }), "cannot rename");
    EXPECT_EQ(entries(), 1); // no temporary file is left
}

TEST_F(Files, LinksAndDevicesAreNotReplaced) {
    write_file_atomically(path("target"), "old");
    fs::create_symlink(path("target"), path("link"));
    write_file_atomically(path("link"), "new");
    EXPECT_EQ(read_file(path("target")), "new");
    EXPECT_TRUE(fs::is_symlink(path("link")));
    write_file_atomically("/dev/null", "x");
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
    EXPECT_SAYS(failure(Exit::io, [] { write_file_atomically("/dev/full", "x"); }),
                "No space left on device");
    EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST_F(Files, GrowingFilesContinueWhereTold) {
    {
        OutputFile file(path("log"));
        file.write("one\ntwo\n");
        file.flush();
        EXPECT_EQ(file.position(), 8);
        file.write("half a li");
    }
    OutputFile file(path("log"), 8);
    EXPECT_EQ(file.position(), 8);
    file.write("three\n");
    file.flush();
    EXPECT_EQ(read_file(path("log")), "one\ntwo\nthree\n");
    EXPECT_SAYS(failure(Exit::io, [&] { OutputFile(path("log"), 100); }),
                "is shorter than the checkpoint says (100 bytes");
    EXPECT_SAYS(failure(Exit::io, [&] { OutputFile(path("gone"), 0); }), "gone: is shorter");
    EXPECT_SAYS(failure(Exit::io, [&] { OutputFile(path("no/log")); }), "no/log: cannot open");
}

TEST_F(Files, FullDisksAreNoticedAtTheFlush) {
    OutputFile file("/dev/full");
    file.write("x");
    EXPECT_SAYS(failure(Exit::io, [&] { file.flush(); }), "/dev/full: cannot write: No space left on device");
}

TEST_F(Files, MovedFilesHaveOneOwner) {
    OutputFile a(path("a"));
    a.write("1");
    OutputFile b = std::move(a);
    b.write("2");
    OutputFile c;
    EXPECT_FALSE(c.is_open());
    c = std::move(b);
    c.write("3");
    c.flush();
    EXPECT_EQ(c.position(), 3);
    EXPECT_EQ(read_file(path("a")), "123");
}

} // namespace

} // namespace sandlane
