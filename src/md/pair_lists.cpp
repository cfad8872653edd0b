#include "md/pair_lists.hpp"

#include "core/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sandlane::md {

namespace {

// In units of R_min, in the plane and in space. A wider skin means fewer builds and longer lists; the minima
// are flat.
constexpr double outer_skin[] = {0.4, 0.2}, near_skin[] = {0.04, 0.03};
// Rounding of positions and distances never exceeds this part of a skin.
constexpr double safety = 1 - 1e-9;

double in_units(const double (&skins)[2], const Plan& plan, const Needs& needs) {
    return skins[plan.dimension - 2] * needs.radius_min;
}

} // namespace

PairLists::PairLists(const scene::Scene& scene, const Plan& plan, const Needs& needs)
    : cells_(scene, plan, needs, false, in_units(outer_skin, plan, needs)), lower_(plan.lower),
      upper_(plan.upper), skin_(in_units(outer_skin, plan, needs)),
      near_skin_(in_units(near_skin, plan, needs)), shear_rate_(scene.domain.shear_rate),
      radius_max_(needs.radius_max), fields_(plan.memory), remembered_(plan.memory, plan.odd_memory) {
    remembered_.index();
}

void PairLists::Memory::clear(std::size_t pairs, std::size_t row) {
    // With little to spare: doubled capacities would be a good part of a run's memory.
    if (rows.capacity() < pairs * row) {
        rows = std::vector<double>();
        rows.reserve(pairs * row * 17 / 16);
    }
    rows.resize(pairs * row);
    touched.assign(pairs / 8 + 1, 0);
}

void PairLists::Memory::set(std::size_t pair, const double* values, std::size_t count, std::size_t row) {
    std::copy_n(values, count, rows.data() + pair * row);
    touched[pair / 8] = static_cast<std::uint8_t>(touched[pair / 8] | 1U << (pair % 8));
}

void PairLists::invalidate(const State& state) {
    if (!stale_ && fields_ > 0) {
        remembered_ = memory(state);
        for (Tile& t : tiles_) t.memory = {};
    }
    stale_ = true;
}

void PairLists::adopt(ContactMemory memory) {
    remembered_ = std::move(memory);
    stale_ = true;
}

ContactMemory PairLists::memory(const State& state) const {
    if (stale_) return remembered_;
    ContactMemory result = remembered_.empty_copy();
    result.reserve(touching());
    for (const Tile& t : tiles_) add_memory(t, state, result);
    result.index();
    return result;
}

void PairLists::write_memory(const State& state, ByteWriter& bytes) const {
    if (stale_) return remembered_.write(bytes);
    ContactMemory::write_size(bytes, touching());
    for (const Tile& t : tiles_) {
        ContactMemory part = remembered_.empty_copy();
        add_memory(t, state, part);
        part.write_contacts(bytes);
    }
}

std::size_t PairLists::touching() const {
    std::size_t count = 0;
    for (const Tile& t : tiles_)
        for (std::size_t n = 0; n < static_cast<std::size_t>(t.near_count) && fields_ > 0; ++n)
            count += t.memory.touches(n) ? 1U : 0U;
    return count;
}

void PairLists::add_memory(const Tile& t, const State& state, ContactMemory& to) const {
    for (std::size_t n = 0; n < static_cast<std::size_t>(t.near_count) && fields_ > 0; ++n)
        if (t.memory.touches(n))
            to.add(state.id[static_cast<std::size_t>(t.near_i[n])],
                   state.id[static_cast<std::size_t>(t.near_j[n])], t.memory.rows.data() + n * row());
}

std::size_t PairLists::bytes() const {
    std::size_t total = cells_.bytes() + built_.bytes() + built_image_.bytes();
    for (const Tile& t : tiles_)
        total += sizeof(std::int32_t) * (t.i.capacity() + t.j.capacity() + t.near_i.capacity() +
                                         t.near_j.capacity() + t.position.capacity()) +
                 sizeof(double) * t.memory.rows.capacity() + t.memory.touched.capacity();
    return total;
}

simd::TileList PairLists::tile(std::size_t index, const State& state) {
    Tile& t = tiles_[index];
    return {t.near_i.data(),
            t.near_j.data(),
            t.near_count,
            static_cast<std::int32_t>(index * tile_size),
            static_cast<std::int32_t>(std::min(state.size(), (index + 1) * tile_size)),
            t.images,
            t.memory.rows.data(),
            t.memory.touched.data()};
}

void PairLists::update(const State& state, const simd::PairView& pairs, const simd::DimensionKernels& kernels,
                       int threads, double time) {
    time_ = time;
    if (!stale_ && near_budget_ >= 0) return;
    const bool rebuild = stale_ || !outer_valid(state, pairs, threads);
    if (rebuild) {
        invalidate(state);
        build(state, pairs, kernels, threads);
    }
    refresh(state, pairs, kernels, threads, rebuild);
    if (rebuild) remembered_ = remembered_.empty_copy(); // the lists know it now
}

// Largest square of a displacement since the last build among the grains of a tile.
template <int dimension>
double PairLists::largest_square(const State& state, const simd::PairView& pairs, std::size_t tile) const {
    double largest = 0;
    for (std::size_t i = tile * tile_size; i < std::min(state.size(), (tile + 1) * tile_size); ++i) {
        if (shear_rate_ != 0) {
            const Vec moved = displacement(state, pairs, i);
            largest = std::max(largest, dot(moved, moved));
            continue;
        }
        const double *now = state.record_of(i), *built = built_.data() + i * dimension;
        double square = 0;
        for (int d = 0; d < dimension; ++d) {
            double x = now[d] - built[d];
            x = x < -pairs.half[d] ? x + pairs.period[d] : x > pairs.half[d] ? x - pairs.period[d] : x;
            square += x * x;
        }
        largest = std::max(largest, square);
    }
    return largest;
}

// With a seam: of a grain since the last build, beyond what the shear flow through its place did.
Vec PairLists::displacement(const State& state, const simd::PairView& pairs, std::size_t i) const {
    const auto dimension = static_cast<std::size_t>(state.dimension);
    const double *now = state.record_of(i), *built = built_.data() + i * dimension;
    double moved[3] = {};
    for (std::size_t d = 0; d < dimension; ++d) moved[d] = now[d] - built[d];
    const double height = pairs.period[1], crossed = state.image[1][i] - built_image_[i];
    moved[0] +=
        crossed * pairs.seam - shear_rate_ * (built[1] - 0.5 * (lower_.y + upper_.y)) * (time_ - built_time_);
    moved[1] += crossed * height;
    for (std::size_t d = 0; d < dimension; ++d) // a seam's term may span several periods
        if (pairs.period[d] > 0) moved[d] -= pairs.period[d] * std::nearbyint(moved[d] / pairs.period[d]);
    return {moved[0], moved[1], moved[2]};
}

// Two grains that were a skin apart can have met when both moved by half of it. The near list adds its own
// skin. A shear flow moves one against the other by its rate and their distance.
bool PairLists::outer_valid(const State& state, const simd::PairView& pairs, int threads) {
    for_tiles(tiles_.size(), threads, [&](std::size_t index) {
        tiles_[index].largest_square = state.dimension == 3 ? largest_square<3>(state, pairs, index)
                                                            : largest_square<2>(state, pairs, index);
    });
    double largest = 0;
    for (const Tile& t : tiles_) largest = std::max(largest, t.largest_square);
    const double sheared = std::abs(shear_rate_) * (time_ - built_time_) * (2 * radius_max_ + skin_);
    return 2 * std::sqrt(largest) + sheared <= safety * (skin_ - near_skin_);
}

void PairLists::build(const State& state, const simd::PairView& pairs, const simd::DimensionKernels& kernels,
                      int threads) {
    ++builds_;
    stale_ = false;
    tiles_.resize(state.tiles());
    built_.resize(state.size() * static_cast<std::size_t>(state.dimension));
    if (shear_rate_ != 0) built_image_ = state.image[1];
    built_time_ = time_;
    cells_.build(state, kernels.bin, threads);
    for_tiles_dynamic(tiles_.size(), threads,
                      [&](std::size_t index) { build_tile(index, state, pairs, kernels); });
    cells_.release();
}

void PairLists::build_tile(std::size_t index, const State& state, const simd::PairView& pairs,
                           const simd::DimensionKernels& kernels) {
    Tile& t = tiles_[index];
    // Found into scratch: lists keep no more than they need.
    thread_local std::vector<std::int32_t> listed_i, listed_j, found;
    listed_i.clear();
    listed_j.clear();
    found.resize(cells_.most_around() + block_width);
    const auto begin = static_cast<std::int32_t>(index * tile_size);
    const auto end = static_cast<std::int32_t>(std::min(state.size(), (index + 1) * tile_size));
    const auto dimension = static_cast<std::size_t>(state.dimension);
    const simd::CellView view = cells_.view();
    for (std::int32_t i = begin; i < end; ++i) {
        const auto grain = static_cast<std::size_t>(i);
        std::copy_n(state.record_of(grain), dimension, built_.data() + grain * dimension);
        const std::int32_t count = kernels.candidates(view, pairs, cells_.cell_of(grain),
                                                      cells_.slot_of(grain), skin_, found.data());
        const auto last = std::remove_if(found.begin(), found.begin() + count,
                                         [&](std::int32_t j) { return j >= begin && j < i; });
        std::sort(found.begin(), last);
        listed_j.insert(listed_j.end(), found.begin(), last);
        listed_i.resize(listed_j.size(), i);
    }
    t.count = static_cast<std::int32_t>(listed_i.size());
    for (std::vector<std::int32_t>* list : {&listed_i, &listed_j})
        list->insert(list->end(), block_width, begin);
    t.i.assign(listed_i.begin(), listed_i.end());
    t.j.assign(listed_j.begin(), listed_j.end());
    const simd::Images images = pairs.sheared ? simd::Images::sheared : simd::Images::periodic;
    t.images = may_cross(t, state, pairs) ? images : simd::Images::none;
}

// Whether while the list lasts a pair may be nearest across a periodic side: it is now, or one of its grains
// may come across.
bool PairLists::may_cross(const Tile& t, const State& state, const simd::PairView& pairs) const {
    const double lower[] = {lower_.x, lower_.y, lower_.z}, upper[] = {upper_.x, upper_.y, upper_.z};
    for (int d = 0; d < state.dimension; ++d) {
        if (!(pairs.period[d] > 0)) continue;
        const auto x = [&](std::int32_t i) { return state.record_of(static_cast<std::size_t>(i))[d]; };
        const auto beside = [&](std::int32_t i) {
            return x(i) < lower[d] + skin_ || x(i) > upper[d] - skin_;
        };
        for (std::size_t n = 0; n < static_cast<std::size_t>(t.count); ++n)
            if (std::abs(x(t.j[n]) - x(t.i[n])) > pairs.half[d] || beside(t.i[n]) || beside(t.j[n]))
                return true;
    }
    return false;
}

void PairLists::refresh(const State& state, const simd::PairView& pairs,
                        const simd::DimensionKernels& kernels, int threads, bool rebuilt) {
    ++refreshes_;
    near_budget_ = 0.5 * safety * near_skin_;
    for_tiles(tiles_.size(), threads,
              [&](std::size_t index) { refresh_tile(index, state, pairs, kernels, rebuilt); });
}

void PairLists::refresh_tile(std::size_t index, const State& state, const simd::PairView& pairs,
                             const simd::DimensionKernels& kernels, bool rebuilt) {
    Tile& t = tiles_[index];
    const auto first = static_cast<std::int32_t>(index * tile_size);
    // Found into scratch of the size of the outer list: near lists keep no more than they need.
    thread_local std::vector<std::int32_t> near_i, near_j, position;
    for (std::vector<std::int32_t>* list : {&near_i, &near_j, &position})
        if (list->size() < t.i.size()) list->resize(t.i.size());
    t.near_count = kernels.near_pairs(pairs, t.i.data(), t.j.data(), t.count, near_skin_, near_i.data(),
                                      near_j.data(), position.data());
    const auto count = static_cast<std::size_t>(t.near_count);
    // The tile kernel loads whole blocks of existing grains.
    std::fill_n(near_i.data() + count, block_width, first);
    std::fill_n(near_j.data() + count, block_width, first);
    t.near_i.assign(near_i.data(), near_i.data() + count + block_width);
    t.near_j.assign(near_j.data(), near_j.data() + count + block_width);
    if (fields_ == 0) return;
    // What was before waits in scratch, whose room the tile takes over: nothing is allocated.
    thread_local Memory before;
    thread_local std::vector<std::int32_t> last_position;
    std::swap(before, t.memory);
    std::swap(last_position, t.position);
    t.position.assign(position.data(), position.data() + count);
    t.memory.clear(count + block_width, row());
    if (rebuilt) return recall_memory(t, state);
    // From the near pairs before to those now: both ascend in their position in the outer list.
    std::size_t old = 0;
    for (std::size_t now = 0; now < count; ++now) {
        while (old < last_position.size() && last_position[old] < t.position[now]) ++old;
        if (old == last_position.size()) return;
        if (last_position[old] == t.position[now] && before.touches(old))
            t.memory.set(now, before.rows.data() + old * row(), row(), row());
    }
}

void PairLists::recall_memory(Tile& t, const State& state) const {
    std::vector<double> values(row());
    for (std::size_t n = 0; n < static_cast<std::size_t>(t.near_count) && !remembered_.empty(); ++n)
        if (remembered_.find(state.id[static_cast<std::size_t>(t.near_i[n])],
                             state.id[static_cast<std::size_t>(t.near_j[n])], values.data()))
            t.memory.set(n, values.data(), static_cast<std::size_t>(fields_), row());
}

} // namespace sandlane::md
