#include "core/memory.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <fstream>

#include <sys/resource.h>
#include <unistd.h>

namespace sandlane {

double allowed_memory() {
    double allowed =
        static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
    double limit = 0;
    std::ifstream file("/sys/fs/cgroup/memory.max"); // "max" without a limit
    if (file >> limit && limit > 0) allowed = std::min(allowed, limit);
    rlimit address_space{}; // ulimit -v
    if (::getrlimit(RLIMIT_AS, &address_space) == 0 && address_space.rlim_cur != RLIM_INFINITY)
        allowed = std::min(allowed, static_cast<double>(address_space.rlim_cur));
    return allowed;
}

void require_memory(double bytes, const std::string& what) {
    const double allowed = allowed_memory();
    if (bytes <= allowed) return;
    fail(Exit::unavailable, "{} needs about {:.3g} GB of memory; this process may use {:.3g} GB", what,
         bytes / 1e9, allowed / 1e9);
}

} // namespace sandlane
