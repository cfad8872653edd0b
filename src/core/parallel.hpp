// Threads: the only place that speaks OpenMP. Work is cut into tiles of fixed size, never n/threads,
// so that results are the same for every thread count.
#pragma once

#include <cstddef>
#include <string>

#include <omp.h>

namespace sandlane {

struct ThreadChoice {
    int count = 1;
    std::string reason;     // e.g. "--threads", "OMP_NUM_THREADS", "affinity and cgroup quota"
    bool automatic = false; // nobody asked for this number: an engine may use fewer for a small scene
};

// requested <= 0 means "not given". Precedence: requested, SANDLANE_THREADS, OMP_NUM_THREADS, affinity and
// cgroup quota. Throws Error(unavailable) for more threads than the CPUs allowed, Error(invalid_input) for
// nonsense.
[[nodiscard]] ThreadChoice choose_threads(int requested);
[[nodiscard]] int allowed_cpus();

// Calls body(tile) for tile = 0 .. tiles-1 on up to `threads` threads, contiguous ranges per thread.
// The body must not throw.
template <class Body> void for_tiles(std::size_t tiles, int threads, const Body& body) {
    if (threads <= 1 || tiles <= 1) {
        for (std::size_t tile = 0; tile < tiles; ++tile) body(tile);
        return;
    }
#pragma omp parallel for schedule(static) num_threads(threads)
    for (std::size_t tile = 0; tile < tiles; ++tile) body(tile);
}

// As for_tiles, for tiles of uneven cost. Only for bodies whose result does not depend on who runs them.
template <class Body> void for_tiles_dynamic(std::size_t tiles, int threads, const Body& body) {
    if (threads <= 1 || tiles <= 1) {
        for (std::size_t tile = 0; tile < tiles; ++tile) body(tile);
        return;
    }
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
    for (std::size_t tile = 0; tile < tiles; ++tile) body(tile);
}

[[nodiscard]] inline int thread_index() {
    return omp_get_thread_num();
}

} // namespace sandlane
