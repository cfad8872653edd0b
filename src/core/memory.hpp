// Memory: what this process may use, and a refusal in words before the kernel ends the program.
#pragma once

#include <string>

namespace sandlane {

// Bytes: the machine's memory, or the limit of the cgroup or of `ulimit -v` if one is lower.
[[nodiscard]] double allowed_memory();

// Throws Error(unavailable) "WHAT needs about ... GB ..." for more than allowed_memory().
void require_memory(double bytes, const std::string& what);

} // namespace sandlane
