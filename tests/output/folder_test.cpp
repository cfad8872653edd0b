#include "output/folder.hpp"

#include "output/sample.hpp"
#include "output/support.hpp"

#include <gtest/gtest.h>

#include <array>

#include <sys/wait.h>
#include <unistd.h>

using namespace sandlane;
using namespace sandlane::output;
using Start = RunFolder::Start;

namespace {

// Another process that holds a run folder from construction until release().
class OtherRun {
public:
    explicit OtherRun(const std::filesystem::path& path) {
        std::array<int, 2> ready{}, end{};
        if (::pipe(ready.data()) != 0 || ::pipe(end.data()) != 0) ADD_FAILURE() << "no pipe";
        child_ = ::fork();
        if (child_ == 0) hold(path, ready[1], end);
        ::close(ready[1]);
        ::close(end[0]);
        end_ = end[1];
        char word = 0;
        EXPECT_EQ(::read(ready[0], &word, 1), 1);
        ::close(ready[0]);
    }
    void release() {
        ::close(end_);
        ::waitpid(child_, nullptr, 0);
    }

private:
    [[noreturn]] static void hold(const std::filesystem::path& path, int ready,
                                  const std::array<int, 2>& end) {
        ::close(end[1]);
        const RunFolder folder(path, Start::fresh);
        char word = 'r';
        if (::write(ready, &word, 1) != 1) ::_exit(1);
        ::_exit(::read(end[0], &word, 1) == 0 ? 0 : 1); // 0: the test has closed its end
    }

    pid_t child_ = 0;
    int end_ = -1;
};

} // namespace

TEST(RunFolder, CreatesParentsAndSubfolders) {
    const sample::Folder folder("runs");
    const RunFolder run(folder / "a" / "b", Start::fresh);
    EXPECT_TRUE(std::filesystem::is_directory(run.checkpoints()));
    EXPECT_EQ(run.checkpoints(), folder / "a" / "b" / "checkpoints");
}

TEST(RunFolder, ASecondRunIsRefusedAndAResumedOneAllowed) {
    const sample::Folder folder("second");
    { const RunFolder first(folder / "run", Start::fresh); }
    const std::string message =
        refusal(Exit::invalid_input, [&] { RunFolder(folder / "run", Start::fresh); });
    EXPECT_TRUE(has(message, (folder / "run").string())) << message;
    EXPECT_TRUE(has(message, "--resume")) << message;
    EXPECT_NO_THROW(RunFolder(folder / "run", Start::resume));
}

TEST(RunFolder, ARunningOneIsLeftAlone) {
    const sample::Folder folder("running");
    OtherRun other(folder / "run");
    for (const Start start : {Start::fresh, Start::resume})
        EXPECT_TRUE(has(refusal(Exit::invalid_input, [&] { RunFolder(folder / "run", start); }),
                        "is writing a run here"));
    other.release();
    EXPECT_NO_THROW(RunFolder(folder / "run", Start::resume));
}

TEST(RunFolder, AFolderThatCannotBeWrittenIsNamed) {
    const sample::Folder folder("unwritable");
    write_file_atomically(folder / "file", "");
    for (const char* path : {"file", "file/run"})
        EXPECT_TRUE(has(refusal(Exit::io, [&] { RunFolder(folder / path, Start::fresh); }),
                        (folder / path).string()));
    if (::geteuid() == 0) return; // permissions do not bind root
    std::filesystem::create_directory(folder / "locked");
    std::filesystem::permissions(folder / "locked",
                                 std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
    for (const char* path : {"locked", "locked/run"})
        EXPECT_TRUE(has(refusal(Exit::io, [&] { RunFolder(folder / path, Start::fresh); }),
                        (folder / "locked").string()));
}
