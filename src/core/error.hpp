// Errors that end a run: one message for the user, one exit code for scripts.
#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace sandlane {

// Documented exit codes of the command line; scripts depend on them.
enum class Exit : int {
    ok = 0,
    comparison_failed = 1,
    invalid_input = 2, // usage, scene or any input file
    unavailable = 4,   // the machine lacks the instruction set, the threads or the memory asked for
    io = 5,            // output could not be written, or a checkpoint is damaged
    unstable = 6,      // the simulation left the validity range of its method
    stopped = 7,       // walltime or signal; a checkpoint was written
    internal = 70,
};

class Error : public std::runtime_error {
public:
    Error(Exit code, const std::string& message) : std::runtime_error(message), code_(code) {}
    [[nodiscard]] Exit code() const noexcept { return code_; }

private:
    Exit code_;
};

// Throws Error with a formatted message. State file or key, the value, the allowed range and what to do.
template <class... Args>
[[noreturn]] void fail(Exit code, fmt::format_string<Args...> format, Args&&... args) {
    throw Error(code, fmt::format(format, std::forward<Args>(args)...));
}

} // namespace sandlane
