#include "dsmc/tiling.hpp"

#include <algorithm>

namespace sandlane::dsmc {

namespace {

// Particles of a tile: larger ones keep more particles to themselves, smaller ones stay in the second cache
// of a core; the best of several sizes measured.
constexpr double tile_particles = 8192;

} // namespace

Tiling::Tiling(const std::int32_t (&cells)[3], const bool (&periodic)[3], double per_cell) {
    for (int d = 0; d < 3; ++d) cells_[d] = cells[d], periodic_[d] = periodic[d];
    for (;;) { // double the shortest edge
        int shortest = -1;
        for (int d = 0; d < 3; ++d)
            if (edge_[d] < cells_[d] && (shortest < 0 || edge_[d] < edge_[shortest])) shortest = d;
        if (shortest < 0 || 2.0 * cells_per_tile() * std::max(per_cell, 1.0) > 1.5 * tile_particles) break;
        edge_[shortest] *= 2;
    }
    for (int d = 0; d < 3; ++d) { // tiles of equal size as far as possible
        const std::int32_t tiles = (cells_[d] + edge_[d] - 1) / edge_[d];
        edge_[d] = (cells_[d] + tiles - 1) / tiles;
        count_[d] = (cells_[d] + edge_[d] - 1) / edge_[d];
    }
    const auto n = static_cast<std::size_t>(tiles());
    for (std::int32_t t = 0; t < tiles(); ++t)
        places_.push_back({t % count_[0], t / count_[0] % count_[1], t / count_[0] / count_[1]});
    sources_.resize(n);
    slot_.resize(n);
    std::vector<std::vector<Neighbour>> targets(n);
    std::size_t most = 0;
    for (std::int32_t t = 0; t < tiles(); ++t) {
        auto& slots = slot_[static_cast<std::size_t>(t)];
        slots.fill(-1);
        const auto& at = place(t);
        for (int direction = 0; direction < 27; ++direction) {
            const int step[3] = {direction % 3 - 1, direction / 3 % 3 - 1, direction / 9 - 1};
            std::int32_t to[3];
            bool exists = true;
            for (std::size_t d = 0; d < 3; ++d) {
                to[d] = at[d] + step[d];
                if (periodic_[d]) to[d] = (to[d] + count_[d]) % count_[d];
                exists = exists && to[d] >= 0 && to[d] < count_[d];
            }
            if (!exists) continue;
            const std::int32_t tile = to[0] + count_[0] * (to[1] + count_[1] * to[2]);
            auto& list = targets[static_cast<std::size_t>(t)];
            const auto known = std::find_if(list.begin(), list.end(),
                                            [&](const Neighbour& other) { return other.tile == tile; });
            if (tile == t) continue;
            std::int32_t number = static_cast<std::int32_t>(list.size());
            if (known != list.end())
                number = known->slot;
            else
                list.push_back({tile, number});
            slots[static_cast<std::size_t>(direction)] = static_cast<std::int8_t>(number);
        }
        most = std::max(most, targets[static_cast<std::size_t>(t)].size());
    }
    slots_ = static_cast<std::int32_t>(most) + 1;
    for (std::int32_t t = 0; t < tiles(); ++t)
        for (const Neighbour& to : targets[static_cast<std::size_t>(t)])
            sources_[static_cast<std::size_t>(to.tile)].push_back({t, to.slot});
}

std::int32_t Tiling::slot(std::int32_t from, std::int32_t to) const {
    const auto &a = place(from), &b = place(to);
    std::int32_t direction = 0, factor = 1;
    for (std::size_t d = 0; d < 3; ++d) {
        std::int32_t step = b[d] - a[d];
        if (periodic_[d] && count_[d] > 2) {
            if (step == count_[d] - 1) step = -1;
            if (step == 1 - count_[d]) step = 1;
        }
        if (step < -1 || step > 1) return far_slot();
        direction += (step + 1) * factor;
        factor *= 3;
    }
    const std::int8_t slot = slot_[static_cast<std::size_t>(from)][static_cast<std::size_t>(direction)];
    return slot < 0 ? far_slot() : slot;
}

laws::CellAxis Tiling::axis(int d, double lower, double upper) const {
    laws::CellAxis a;
    a.lower = lower;
    a.inverse_edge = cells_[d] / (upper - lower);
    a.last = cells_[d] - 1;
    a.inverse_tile = (1 + 0x1p-40) / edge_[d]; // the first cell of a tile is not below it
    std::int32_t inner = 1, outer = cells_per_tile();
    for (int e = 0; e < d; ++e) {
        inner *= edge_[e];
        outer *= count_[e];
    }
    a.step = inner;
    a.jump = outer - static_cast<double>(edge_[d]) * inner;
    return a;
}

std::array<std::int32_t, 3> Tiling::cell(std::int32_t number) const {
    const auto& at = place(number / cells_per_tile());
    const std::int32_t inner = number % cells_per_tile();
    return {at[0] * edge_[0] + inner % edge_[0], at[1] * edge_[1] + inner / edge_[0] % edge_[1],
            at[2] * edge_[2] + inner / edge_[0] / edge_[1]};
}

} // namespace sandlane::dsmc
