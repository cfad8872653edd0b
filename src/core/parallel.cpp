#include "core/parallel.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <thread>

#if defined(__linux__)
#include <sched.h>
#endif

namespace sandlane {

namespace {

int affinity_cpus() {
#if defined(__linux__)
    cpu_set_t set;
    if (sched_getaffinity(0, sizeof set, &set) == 0) return CPU_COUNT(&set);
#endif
    const unsigned n = std::thread::hardware_concurrency();
    return n > 0 ? static_cast<int>(n) : 1;
}

// CPUs granted by a cgroup v2 quota, rounded up; 0 if there is none.
int quota_cpus() {
    std::ifstream file("/sys/fs/cgroup/cpu.max");
    std::string quota;
    double period = 0;
    if (!(file >> quota >> period) || quota == "max" || period <= 0) return 0;
    double granted = 0;
    if (std::from_chars(quota.data(), quota.data() + quota.size(), granted).ec != std::errc{}) return 0;
    return static_cast<int>((granted + period - 1) / period);
}

int threads_from_environment(const char* name) {
    const char* text = std::getenv(name);
    if (text == nullptr || *text == '\0') return 0;
    int value = 0;
    const char* end = text + std::strlen(text);
    const auto [stop, error] = std::from_chars(text, end, value);
    if (error != std::errc{} || (stop != end && *stop != ',') || value < 1)
        fail(Exit::invalid_input, "{}={}: must be a whole number of at least 1", name, text);
    return value;
}

// Leaves the core to its sibling for a moment.
void pause() {
#if defined(__x86_64__)
    __builtin_ia32_pause();
#elif defined(__aarch64__)
    asm volatile("yield");
#endif
}

} // namespace

void Crew::meet() {
    if (size_ == 1) return;
    const std::uint32_t meeting = meetings_.load(std::memory_order_relaxed);
    if (arrived_.fetch_add(1, std::memory_order_acq_rel) + 1 == size_) {
        arrived_.store(0, std::memory_order_relaxed);
        meetings_.store(meeting + 1, std::memory_order_release);
        return;
    }
    // Whoever is awaited may need this processor: at once if there are fewer than threads, after some us
    // if another program has taken some.
    int patience = size_ > omp_get_num_procs() ? 0 : 200;
    while (meetings_.load(std::memory_order_acquire) == meeting)
        if (patience > 0) {
            --patience;
            pause();
        } else {
            std::this_thread::yield();
        }
}

int allowed_cpus() {
    const int affinity = affinity_cpus();
    const int quota = quota_cpus();
    return quota > 0 && quota < affinity ? quota : affinity;
}

ThreadChoice choose_threads(int requested) {
    ThreadChoice choice{requested, "--threads"};
    for (const char* name : {"SANDLANE_THREADS", "OMP_NUM_THREADS"})
        if (choice.count <= 0) choice = {threads_from_environment(name), name};
    if (choice.count <= 0) return {allowed_cpus(), "affinity and cgroup quota", true};
    // Oversubscription helps to test determinism on small machines; far beyond the CPUs it is a mistake.
    const int limit = std::max(8, 4 * allowed_cpus());
    if (choice.count > limit)
        fail(Exit::unavailable,
             "{} asks for {} threads, but this process may use {} CPUs (allowed: 1 to {}). Best is {}.",
             choice.reason, choice.count, allowed_cpus(), limit, allowed_cpus());
    return choice;
}

} // namespace sandlane
