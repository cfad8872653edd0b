// The folder of a run. A lock file in it tells other runs that the folder is taken: while the run goes on it
// is held by flock, afterwards its presence says that results lie here, and of which scene.
#pragma once

#include <filesystem>
#include <string>

namespace sandlane::output {

class RunFolder {
public:
    enum class Start { fresh, resume };

    // fresh: creates the folder and refuses one that holds a running or finished run (Error(invalid_input)).
    // resume: goes on in the folder of an earlier run, refuses a running one, and one that began with another
    // origin (Error(io)). origin: one word, of the scene that the run began with; empty: not known.
    // Throws Error(io) naming the path if the folder cannot be created or written.
    RunFolder(std::filesystem::path path, Start start, std::string origin = {});
    RunFolder(RunFolder&& other) noexcept;
    RunFolder& operator=(RunFolder&& other) noexcept;
    ~RunFolder();

    // For a run that could not begin: removes the folder if it was made here, else only its mark.
    void discard() noexcept;

    [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
    [[nodiscard]] std::filesystem::path checkpoints() const; // created on first use
    [[nodiscard]] const std::string& origin() const noexcept { return origin_; }

private:
    void lock(Start start);

    void remove_empty() const noexcept;

    std::filesystem::path path_;
    std::filesystem::path made_; // topmost folder that this run created; empty: it was there
    std::string origin_;
    int lock_ = -1; // file descriptor
};

} // namespace sandlane::output
