// Threads: the only place that speaks OpenMP. Work is cut into tiles of fixed size, never n/threads,
// so that results are the same for every thread count.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
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

// Threads that go through many rounds of tiles together. Between two rounds they meet, which takes 0.1 us; a
// parallel region for each round takes 0.5 us.
class Crew {
public:
    // To be called by every thread of the crew, in the same order: body(tile) for the contiguous range of
    // tiles that is the thread's, as for_tiles. Returns when all tiles are done. The body must not throw.
    template <class Body> void for_tiles(std::size_t tiles, const Body& body) {
        const std::size_t count = static_cast<std::size_t>(size_), self = index();
        for (std::size_t tile = tiles * self / count; tile < tiles * (self + 1) / count; ++tile) body(tile);
        meet();
    }
    // body() on one thread while the others wait.
    template <class Body> void once(const Body& body) {
        if (index() == 0) body();
        meet();
    }

private:
    template <class Body> friend void with_crew(int threads, const Body& body);

    [[nodiscard]] std::size_t index() const {
        return size_ > 1 ? static_cast<std::size_t>(thread_index()) : 0;
    }
    void meet();

    int size_ = 1;
    alignas(64) std::atomic<int> arrived_{0};
    alignas(64) std::atomic<std::uint32_t> meetings_{0};
};

// Calls body(crew) on each of up to `threads` threads. The body must not throw.
template <class Body> void with_crew(int threads, const Body& body) {
    Crew crew;
    if (threads <= 1) {
        body(crew);
        return;
    }
#pragma omp parallel num_threads(threads)
    {
#pragma omp single
        crew.size_ = omp_get_num_threads();
        body(crew);
    }
}

} // namespace sandlane
