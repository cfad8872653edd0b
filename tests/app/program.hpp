// Runs the real program in a folder of its own, as a shell would.
#pragma once

#include "core/error.hpp"
#include "core/file.hpp"
#include "support/says.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <sys/resource.h>
#include <sys/types.h>

namespace sandlane::test {

namespace fs = std::filesystem;

inline nlohmann::json json_of(const std::string& text) {
    return nlohmann::json::parse(text);
}

struct Call {
    std::vector<std::string> arguments;
    std::vector<std::pair<std::string, std::string>> environment = {};
    rlim_t largest_file = RLIM_INFINITY; // bytes
    rlim_t memory = RLIM_INFINITY;       // of its address space, bytes
    bool everywhere = true;              // false: root keeps to the permissions of files like everybody
    fs::path out = {}, err = {};         // empty: captured
};

struct Outcome {
    int code = -1;  // exit code; -1 after a signal
    int signal = 0; // that ended it
    std::string out, err;
    double memory = 0; // bytes, at most resident
};

class Process {
public:
    Process(const fs::path& folder, const Call& call);
    ~Process(); // kills it if nobody has waited for it
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;

    void send(int signal) const;
    [[nodiscard]] bool running();
    [[nodiscard]] Outcome wait();

private:
    pid_t id_ = -1;
    int status_ = 0;
    rusage usage_{};
    int out_ = -1, err_ = -1; // read ends of pipes
};

// A test with a working folder that goes with it.
class App : public testing::Test {
protected:
    App();
    ~App() override;

    [[nodiscard]] fs::path path(const std::string& name) const { return folder_ / name; }
    void write(const std::string& name, const std::string& text) const {
        write_file_atomically(path(name), text);
    }
    [[nodiscard]] std::string read(const std::string& name) const { return read_file(path(name)); }
    // Everything below the working folder.
    [[nodiscard]] std::set<std::string> listing() const;

    [[nodiscard]] Outcome run(const Call& call) const;
    [[nodiscard]] Outcome run(std::vector<std::string> arguments) const {
        return run(Call{std::move(arguments)});
    }
    // Fails the test unless the program ends with 0.
    Outcome run_well(std::vector<std::string> arguments) const;
    [[nodiscard]] const fs::path& folder() const { return folder_; }
    // The files of a run but what tells of the process: its number, its times, when it wrote checkpoints.
    [[nodiscard]] std::map<std::string, std::string> results(const std::string& out) const;
    // The newest below the folder of a run; empty if there is none.
    [[nodiscard]] std::string latest_checkpoint(const std::string& out) const;

private:
    fs::path folder_;
};

// 80 grains that fall in a box for 0.2 s; about 0.1 s of wall time.
extern const std::string box_scene;
// 27 spheres in a cube with a floor, for 2 ms.
extern const std::string cube_scene;
// The text with one piece of it replaced.
[[nodiscard]] std::string replaced(std::string text, const std::string& piece, const std::string& by);

[[nodiscard]] inline int code_of(Exit exit) {
    return static_cast<int>(exit);
}

} // namespace sandlane::test
