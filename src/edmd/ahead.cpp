// What the next events will read, fetched before they come up.
#include "edmd/simulation.hpp"

namespace sandlane::edmd {

using simd::HardEvents;

namespace {

// The empty statement keeps compilers from taking functions that only fetch for functions that do nothing.
SANDLANE_INLINE void fetch(const void* from) {
    __builtin_prefetch(from);
    asm volatile("");
}

} // namespace

// Cells that the search after the next event of i looks at, without regard to what lies beyond the box, where
// nothing is fetched in advance: those around its cell, or those that are new to it when it has come through
// face `layer`, which are two away from the cell where it still is.
template <int dimension, class Body>
void Simulation::for_rows(std::uint32_t i, int layer, const Body& body) const {
    const HardEvents& e = events_[i];
    std::int64_t from[3] = {-1, -1, -1}, to[3] = {1, 1, 1};
    if (dimension == 2) from[2] = to[2] = 0;
    if (layer >= 0) from[layer / 2] = to[layer / 2] = layer % 2 == 0 ? -2 : 2;
    const std::int64_t center = cell_number(e.cell);
    const std::int64_t row = view_.count[0], plane = plane_;
    for (std::int64_t z = from[2]; z <= to[2]; ++z)
        for (std::int64_t y = from[1]; y <= to[1]; ++y) {
            const std::int64_t first = center + z * plane + y * row + from[0];
            if (first < 0 || first + to[0] - from[0] >= cell_count_) continue;
            body(cells_.data() + first, cells_.data() + first + (to[0] - from[0]));
        }
}
template <int dimension> void Simulation::fetch_cells(std::uint32_t i, int layer) const {
    for_rows<dimension>(i, layer, [](const simd::HardCell* first, const simd::HardCell* last) {
        fetch(first);
        fetch(last);
    });
    if (layer < 0) return;
    // Where it leaves, and where it goes to.
    const std::int64_t here = cell_number(events_[i].cell), stride[3] = {1, view_.count[0], plane_},
                       there = here + (layer % 2 == 0 ? -1 : 1) * stride[layer / 2];
    fetch(cells_.data() + here);
    if (there >= 0 && there < cell_count_) fetch(cells_.data() + there);
}
template <int dimension> void Simulation::fetch_states(std::uint32_t i, int layer) const {
    for_rows<dimension>(i, layer, [&](const simd::HardCell* first, const simd::HardCell* last) {
        for (; first <= last; ++first)
            for (const std::uint32_t k : first->particle) fetch(states_.data() + k);
    });
}
// Fetches what the buckets that come up will read: each time one comes up, the ones after it take a step.
template <int dimension> void Simulation::look_ahead() {
    const auto crosses = [](const HardEvents& e) { return e.crossing_time <= e.first_time; };
    queue_.for_entries(4, [&](std::uint32_t i, std::uint32_t) {
        fetch(&events_[i]);
        fetch(&states_[i]);
    });
    // Entries that went elsewhere are left out.
    queue_.for_entries(3, [&](std::uint32_t i, std::uint32_t bucket) {
        const HardEvents& e = events_[i];
        if (e.bucket != bucket) return;
        fetch_cells<dimension>(i, crosses(e) ? e.crossing : -1);
        if (crosses(e) || simd::is_wall(e.first)) return;
        fetch(&events_[e.first]);
        fetch(&states_[e.first]);
    });
    queue_.for_entries(2, [&](std::uint32_t i, std::uint32_t bucket) {
        const HardEvents& e = events_[i];
        if (e.bucket != bucket) return;
        fetch_states<dimension>(i, crosses(e) ? e.crossing : -1);
        if (!crosses(e) && !simd::is_wall(e.first)) fetch_cells<dimension>(e.first, -1);
    });
    queue_.for_entries(1, [&](std::uint32_t i, std::uint32_t bucket) {
        const HardEvents& e = events_[i];
        if (e.bucket == bucket && !crosses(e) && !simd::is_wall(e.first))
            fetch_states<dimension>(e.first, -1);
    });
}
template void Simulation::look_ahead<2>();
template void Simulation::look_ahead<3>();

} // namespace sandlane::edmd
