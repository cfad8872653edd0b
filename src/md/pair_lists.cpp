#include "md/pair_lists.hpp"

#include "core/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sandlane::md {

namespace {

// In units of R_min. A wider skin means fewer builds and longer lists; both minima are flat.
constexpr double outer_skin = 0.4, near_skin = 0.04;
// Rounding of positions and distances never exceeds this part of a skin.
constexpr double safety = 1 - 1e-9;

double nearest(double d, double half, double period) {
    if (d < -half) d += period;
    if (d > half) d -= period;
    return d;
}

} // namespace

PairLists::PairLists(const scene::Scene& scene, const Plan& plan, const Needs& needs)
    : cells_(scene, plan, needs.radius_max, false, outer_skin * needs.radius_min),
      skin_(outer_skin * needs.radius_min), near_skin_(near_skin * needs.radius_min), fields_(plan.memory),
      remembered_(plan.memory) {
    remembered_.index();
}

void PairLists::invalidate(const State& state) {
    if (!stale_ && fields_ > 0) remembered_ = memory(state);
    stale_ = true;
}

void PairLists::adopt(ContactMemory memory) {
    remembered_ = std::move(memory);
    stale_ = true;
}

ContactMemory PairLists::memory(const State& state) const {
    if (stale_) return remembered_;
    ContactMemory result(fields_);
    for (const Tile& t : tiles_)
        for (std::size_t n = 0; n < static_cast<std::size_t>(t.near_count) && fields_ > 0; ++n)
            if (t.memory[n] < 0.5 * laws::no_contact)
                result.add(state.id[static_cast<std::size_t>(t.near_i[n])],
                           state.id[static_cast<std::size_t>(t.near_j[n])], t.memory.data() + n,
                           static_cast<std::ptrdiff_t>(t.stride()));
    result.index();
    return result;
}

std::size_t PairLists::bytes() const {
    std::size_t total = cells_.bytes() + built_x_.bytes() + built_y_.bytes();
    for (const Tile& t : tiles_)
        total += sizeof(std::int32_t) *
                     (t.i.capacity() + t.j.capacity() + t.near_i.capacity() + t.near_j.capacity() +
                      t.position.capacity() + t.last_position.capacity()) +
                 sizeof(double) * (t.memory.capacity() + t.last_memory.capacity());
    return total;
}

simd::TileList PairLists::tile(std::size_t index, const State& state) {
    Tile& t = tiles_[index];
    return {t.near_i.data(),
            t.near_j.data(),
            t.near_count,
            static_cast<std::int32_t>(index * tile_size),
            static_cast<std::int32_t>(std::min(state.size(), (index + 1) * tile_size)),
            t.memory.data(),
            static_cast<std::ptrdiff_t>(t.stride())};
}

void PairLists::update(const State& state, const simd::PairView& pairs, const simd::MdKernels& kernels,
                       int threads) {
    if (!stale_ && near_budget_ >= 0) return;
    const bool rebuild = stale_ || !outer_valid(state, pairs, threads);
    if (rebuild) {
        invalidate(state);
        build(state, pairs, kernels, threads);
    }
    refresh(state, pairs, kernels, threads, rebuild);
}

// Two grains that were a skin apart can have met when both moved by half of it. The near list adds its own
// skin.
bool PairLists::outer_valid(const State& state, const simd::PairView& pairs, int threads) {
    for_tiles(tiles_.size(), threads, [&](std::size_t index) {
        double largest = 0;
        for (std::size_t i = index * tile_size; i < std::min(state.size(), (index + 1) * tile_size); ++i) {
            const double* r = pairs.records + i * simd::record_fields;
            const double dx = nearest(r[0] - built_x_[i], pairs.half_x, pairs.period_x);
            const double dy = nearest(r[1] - built_y_[i], pairs.half_y, pairs.period_y);
            largest = std::max(largest, dx * dx + dy * dy);
        }
        tiles_[index].largest_square = largest;
    });
    double largest = 0;
    for (const Tile& t : tiles_) largest = std::max(largest, t.largest_square);
    return std::sqrt(largest) <= 0.5 * safety * (skin_ - near_skin_);
}

void PairLists::build(const State& state, const simd::PairView& pairs, const simd::MdKernels& kernels,
                      int threads) {
    ++builds_;
    stale_ = false;
    tiles_.resize(state.tiles());
    built_x_.resize(state.size());
    built_y_.resize(state.size());
    cells_.build(state, kernels.bin, threads);
    for_tiles_dynamic(tiles_.size(), threads,
                      [&](std::size_t index) { build_tile(index, state, pairs, kernels); });
}

void PairLists::build_tile(std::size_t index, const State& state, const simd::PairView& pairs,
                           const simd::MdKernels& kernels) {
    Tile& t = tiles_[index];
    t.i.clear();
    t.j.clear();
    const auto begin = static_cast<std::int32_t>(index * tile_size);
    const auto end = static_cast<std::int32_t>(std::min(state.size(), (index + 1) * tile_size));
    const simd::CellView view = cells_.view();
    std::vector<std::int32_t> found(cells_.most_around() + block_width);
    for (std::int32_t i = begin; i < end; ++i) {
        const auto grain = static_cast<std::size_t>(i);
        built_x_[grain] = pairs.records[grain * simd::record_fields];
        built_y_[grain] = pairs.records[grain * simd::record_fields + 1];
        const std::int32_t count = kernels.candidates(view, pairs, cells_.cell_of(grain),
                                                      cells_.slot_of(grain), skin_, found.data());
        const auto last = std::remove_if(found.begin(), found.begin() + count,
                                         [&](std::int32_t j) { return j >= begin && j < i; });
        std::sort(found.begin(), last);
        t.j.insert(t.j.end(), found.begin(), last);
        t.i.resize(t.j.size(), i);
    }
    t.count = static_cast<std::int32_t>(t.i.size());
    for (std::vector<std::int32_t>* list : {&t.i, &t.j}) list->resize(list->size() + block_width, begin);
    for (std::vector<std::int32_t>* list : {&t.near_i, &t.near_j, &t.position}) list->resize(t.i.size());
    t.memory.resize(t.i.size() * static_cast<std::size_t>(fields_));
}

void PairLists::refresh(const State& state, const simd::PairView& pairs, const simd::MdKernels& kernels,
                        int threads, bool rebuilt) {
    ++refreshes_;
    near_budget_ = 0.5 * safety * near_skin_;
    for_tiles(tiles_.size(), threads, [&](std::size_t index) {
        Tile& t = tiles_[index];
        if (fields_ > 0 && !rebuilt) {
            t.last_position = t.position;
            t.last_memory = t.memory;
            t.last_near_count = t.near_count;
        }
        t.near_count = kernels.near_pairs(pairs, t.i.data(), t.j.data(), t.count, near_skin_, t.near_i.data(),
                                          t.near_j.data(), t.position.data());
        // The tile kernel loads whole blocks of existing grains.
        const auto end = static_cast<std::size_t>(t.near_count);
        std::fill_n(t.near_i.data() + end, block_width, static_cast<std::int32_t>(index * tile_size));
        std::fill_n(t.near_j.data() + end, block_width, static_cast<std::int32_t>(index * tile_size));
        if (fields_ == 0) return;
        std::fill(t.memory.begin(), t.memory.end(), laws::no_contact);
        if (rebuilt)
            recall_memory(t, state);
        else
            carry_memory(t);
    });
}

// From the near pairs before to those now: both ascend in their position in the outer list.
void PairLists::carry_memory(Tile& t) const {
    std::int32_t before = 0;
    for (std::int32_t now = 0; now < t.near_count; ++now) {
        const std::int32_t position = t.position[static_cast<std::size_t>(now)];
        while (before < t.last_near_count && t.last_position[static_cast<std::size_t>(before)] < position)
            ++before;
        if (before == t.last_near_count) return;
        if (t.last_position[static_cast<std::size_t>(before)] != position) continue;
        for (std::size_t f = 0; f < static_cast<std::size_t>(fields_); ++f)
            t.memory[f * t.stride() + static_cast<std::size_t>(now)] =
                t.last_memory[f * t.stride() + static_cast<std::size_t>(before)];
    }
}

void PairLists::recall_memory(Tile& t, const State& state) const {
    for (std::size_t n = 0; n < static_cast<std::size_t>(t.near_count) && !remembered_.empty(); ++n) {
        const double* values = remembered_.find(state.id[static_cast<std::size_t>(t.near_i[n])],
                                                state.id[static_cast<std::size_t>(t.near_j[n])]);
        for (std::size_t f = 0; f < static_cast<std::size_t>(fields_) && values != nullptr; ++f)
            t.memory[f * t.stride() + n] = values[f];
    }
}

} // namespace sandlane::md
