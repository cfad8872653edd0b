#include "md/still_tiles.hpp"

#include <algorithm>
#include <cstring>

namespace sandlane::md {

namespace {

struct Range {
    std::size_t begin, end; // grains
};
Range grains_of(std::size_t tile, const State& state) {
    return {tile * tile_size, std::min(state.size(), (tile + 1) * tile_size)};
}

template <class T> bool same(const T* a, const T* b, std::size_t count) {
    return count == 0 || std::memcmp(a, b, count * sizeof(T)) == 0;
}
template <class T> bool same(const std::vector<T>& a, const T* b) {
    return same(a.data(), b, a.size());
}

// Values k >= 2 of the integrator, in whole blocks of grains.
const double* gear_of(const State& state, Range grains, std::size_t& count) {
    const auto fields = static_cast<std::size_t>(state.dofs() * (state.order - 2));
    count = (padded(grains.end) - grains.begin) * fields;
    return state.gear.data() + grains.begin * fields;
}

} // namespace

void StillTiles::reset(std::size_t tiles) {
    for (auto* flags : {&resting_, &resting_now_, &still_, &still_now_}) flags->assign(tiles, 0);
    tiles_.resize(tiles);
    for (Tile& t : tiles_) t.known = false;
}

void StillTiles::see_partners(std::size_t tile, const simd::TileList& list) {
    Tile& t = tiles_[tile];
    t.partners.clear();
    for (std::int32_t n = 0; n < list.count; ++n)
        if (list.j[n] < list.begin || list.j[n] >= list.end)
            t.partners.push_back(static_cast<std::uint32_t>(list.j[n]) / tile_size);
    std::sort(t.partners.begin(), t.partners.end());
    t.partners.erase(std::unique(t.partners.begin(), t.partners.end()), t.partners.end());
    t.known = true;
}

// Tiles that move look at their partners when they come to rest.
void StillTiles::see_list(std::size_t tile, const simd::TileList& list) {
    tiles_[tile].known = false;
    if (at_rest(tile)) see_partners(tile, list);
}

bool StillTiles::can_skip(std::size_t tile) const {
    if (still_[tile] == 0) return false;
    const auto rests = [&](std::uint32_t partner) { return resting_[partner] != 0; };
    return std::all_of(tiles_[tile].partners.begin(), tiles_[tile].partners.end(), rests);
}

void StillTiles::before(std::size_t tile, const State& state, const simd::TileList& list, int memory_row,
                        const std::vector<double>& wall_memory) {
    Tile& t = tiles_[tile];
    std::size_t count = 0;
    const double* gear = gear_of(state, grains_of(tile, state), count);
    t.gear.assign(gear, gear + count);
    t.walls = wall_memory;
    if (memory_row == 0) return;
    const auto pairs = static_cast<std::size_t>(list.count);
    t.memory.assign(list.memory, list.memory + pairs * static_cast<std::size_t>(memory_row));
    t.touched.assign(list.touched, list.touched + (pairs + 7) / 8);
}

void StillTiles::after(std::size_t tile, const State& state, const simd::TileList& list, int memory_row,
                       const std::vector<double>& wall_memory, bool moving_walls) {
    const Range grains = grains_of(tile, state);
    const auto unchanged = [&](const Column<double>& a, const Column<double>& b, std::size_t fields) {
        return a.empty() || same(a.data() + grains.begin * fields, b.data() + grains.begin * fields,
                                 (grains.end - grains.begin) * fields);
    };
    const bool rests = unchanged(state.record, state.next_record, simd::record_fields) &&
                       unchanged(state.spin, state.next_spin, simd::spin_fields);
    Tile& t = tiles_[tile];
    std::size_t count = 0;
    const double* gear = gear_of(state, grains, count);
    resting_now_[tile] = rests ? 1 : 0;
    still_now_[tile] =
        rests && !moving_walls && at_rest(tile) && same(t.gear, gear) &&
                t.walls.size() == wall_memory.size() && same(t.walls, wall_memory.data()) &&
                (memory_row == 0 || (same(t.memory, list.memory) && same(t.touched, list.touched)))
            ? 1
            : 0;
    if (rests && !t.known) see_partners(tile, list);
}

void StillTiles::advance() {
    // Skipped tiles stay what they are.
    for (std::size_t tile = 0; tile < tiles_.size(); ++tile)
        if (can_skip(tile)) resting_now_[tile] = still_now_[tile] = 1;
    resting_.swap(resting_now_);
    still_.swap(still_now_);
}

std::size_t StillTiles::skipped() const {
    std::size_t count = 0;
    for (std::size_t tile = 0; tile < tiles_.size(); ++tile)
        if (can_skip(tile)) ++count;
    return count;
}

} // namespace sandlane::md
