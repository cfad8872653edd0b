#include "automata/counted_pipe.hpp"

#include "automata/reference/counted_pipe.hpp"

#include <algorithm>
#include <bit>
#include <numeric>

namespace sandlane::automata {

namespace {

// Hops of fewer particles than these take less time than the threads need to meet.
constexpr std::size_t worth_threads = 4096;

std::uint64_t bit_of(std::int32_t x) {
    return std::uint64_t{1} << (x & 63);
}

GasRules counted(GasRules rules) {
    rules.counted = true;
    return rules;
}

} // namespace

CountedPipe::CountedPipe(std::int32_t columns, std::int32_t rows)
    : lattice(columns, rows), beyond(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), 0),
      several(lattice.plane[0].size(), 0) {}

void CountedPipe::set_resting(std::int32_t x, std::int32_t y, std::int64_t count) {
    lattice.set(6, x, y, count > 0);
    beyond[site(x, y)] = static_cast<std::uint16_t>(count > 0 ? count - 1 : 0);
    std::uint64_t& w = several[word(x, y)];
    w = count > 1 ? w | bit_of(x) : w & ~bit_of(x);
}

std::int64_t CountedPipe::moving() const {
    std::uint64_t sum = 0;
    for (int i = 0; i < 6; ++i) sum += lattice.particles(i);
    return static_cast<std::int64_t>(sum);
}

std::int64_t CountedPipe::particles() const {
    return std::accumulate(beyond.begin(), beyond.end(),
                           moving() + static_cast<std::int64_t>(lattice.particles(6)));
}

CountedStepper::CountedStepper(const CountedPipe& pipe, const GasRules& rules, const Means& means)
    : rules_(rules), means_(means), stepper_(pipe.lattice, counted(rules), means),
      hops_(static_cast<std::size_t>((pipe.lattice.rows + simd::gas_tile_rows - 1) / simd::gas_tile_rows)) {
    for (Column<std::uint64_t>* plane : {&one_, &two_, &less_}) plane->resize(pipe.several.size(), 0);
}

namespace {

std::int64_t reference_step(CountedPipe& pipe, const GasRules& rules, std::uint32_t t) {
    const std::int32_t columns = pipe.lattice.columns, rows = pipe.lattice.rows;
    reference::CountedPipe plain(columns, rows);
    for (std::int32_t y = 0; y < rows; ++y)
        for (std::int32_t x = 0; x < columns; ++x) {
            for (int i = 0; i < 6; ++i)
                if (pipe.lattice.get(i, x, y))
                    plain.movers[pipe.site(x, y)] |= static_cast<std::uint8_t>(1 << i);
            plain.resting[pipe.site(x, y)] = static_cast<std::uint16_t>(pipe.resting(x, y));
        }
    const std::int64_t crowded = reference::step(plain, rules, t);
    for (std::int32_t y = 0; y < rows; ++y)
        for (std::int32_t x = 0; x < columns; ++x) {
            for (int i = 0; i < 6; ++i)
                pipe.lattice.set(i, x, y, (plain.movers[pipe.site(x, y)] >> i & 1) != 0);
            pipe.set_resting(x, y, plain.resting[pipe.site(x, y)]);
        }
    return crowded;
}

} // namespace

std::int64_t CountedStepper::step(CountedPipe& pipe, std::uint32_t t) {
    if (means_.isa == simd::Isa::scalar) return reference_step(pipe, rules_, t);
    // Hops move rest particles only, and movers do not wait for them.
    const simd::CountedView view{pipe.several.data(), one_.data(), two_.data(), less_.data()};
    stepper_.step(pipe.lattice, t, &view);
    for_tiles(hops_.size(), means_.threads, [&](std::size_t tile) { find_crowded(pipe, tile); });
    return hop_apart(pipe, t);
}

// What collisions changed, and the sites where several rest now.
void CountedStepper::find_crowded(CountedPipe& pipe, std::size_t tile) {
    const GasLattice& lattice = pipe.lattice;
    const std::int32_t first = static_cast<std::int32_t>(tile) * simd::gas_tile_rows,
                       last = std::min(first + simd::gas_tile_rows, lattice.rows);
    Sites& crowded = hops_[tile].crowded;
    crowded.clear();
    for (std::int32_t y = first; y < last; ++y)
        for (std::int32_t w = 0; w < lattice.words; ++w) {
            const std::size_t at = pipe.word(64 * w, y);
            const std::uint64_t one = one_[at], two = two_[at], less = less_[at];
            std::uint64_t& several = pipe.several[at];
            for (std::uint64_t left = one | two | less | several; left != 0; left &= left - 1) {
                const int b = std::countr_zero(left);
                const std::int32_t x = 64 * w + b;
                std::uint16_t& beyond = pipe.beyond[pipe.site(x, y)];
                beyond = static_cast<std::uint16_t>(beyond + (one >> b & 1) + 2 * (two >> b & 1) -
                                                    (less >> b & 1));
                if (beyond > 0)
                    crowded.push_back(static_cast<std::uint64_t>(x) | static_cast<std::uint64_t>(y) << 32);
                several = beyond > 0 ? several | bit_of(x) : several & ~bit_of(x);
            }
        }
}

namespace {

// A rest particle comes to a site; true if the site was not crowded before.
bool put(CountedPipe& pipe, std::int32_t x, std::int32_t y) {
    std::uint64_t& rest = pipe.lattice.plane[6][pipe.word(x, y)];
    if ((rest & bit_of(x)) == 0) {
        rest |= bit_of(x);
        return false;
    }
    ++pipe.beyond[pipe.site(x, y)];
    std::uint64_t& several = pipe.several[pipe.word(x, y)];
    const bool is_new = (several & bit_of(x)) == 0;
    several |= bit_of(x);
    return is_new;
}

} // namespace

// Each crowded site sends one away. It stays marked in `several` until the end of the round, so that no site
// is listed twice.
void CountedStepper::send(CountedPipe& pipe, std::size_t tile, std::uint32_t t, std::uint32_t round) {
    Hops& hops = hops_[tile];
    const std::size_t count = hops.crowded.size();
    hops.arrived.clear();
    hops.below.clear();
    hops.above.clear();
    if (count == 0) return;
    hops.crowded.resize(padded(count), 0);
    hops.directions.resize(hops.crowded.size());
    simd::automata_kernels(means_.isa)
        .hops({hops.crowded.data(),
               hops.directions.data(),
               static_cast<std::int64_t>(hops.crowded.size()),
               {rules_.seed[0], rules_.seed[1]},
               t,
               reference::hop_stream + round});
    hops.crowded.resize(count);
    const std::int32_t columns = pipe.lattice.columns, rows = pipe.lattice.rows,
                       first = static_cast<std::int32_t>(tile) * simd::gas_tile_rows,
                       last = first + simd::gas_tile_rows;
    // By parity of the row (bricks).
    constexpr std::int32_t across[2][6] = {{1, 0, -1, -1, -1, 0}, {1, 1, 0, -1, 0, 1}},
                           up[6] = {0, 1, 1, 0, -1, -1};
    for (std::size_t n = 0; n < count; ++n) {
        const auto x = static_cast<std::int32_t>(hops.crowded[n] & 0xffffffffU),
                   y = static_cast<std::int32_t>(hops.crowded[n] >> 32);
        const std::int32_t to_y = y + up[hops.directions[n]];
        if (to_y < 0 || to_y >= rows) continue;
        std::int32_t to_x = x + across[y & 1][hops.directions[n]];
        to_x += to_x < 0 ? columns : to_x >= columns ? -columns : 0;
        --pipe.beyond[pipe.site(x, y)];
        const std::uint64_t to = static_cast<std::uint64_t>(to_x) | static_cast<std::uint64_t>(to_y) << 32;
        if (to_y < first)
            hops.below.push_back(to);
        else if (to_y >= last)
            hops.above.push_back(to);
        else if (put(pipe, to_x, to_y))
            hops.arrived.push_back(to);
    }
}

// From the neighbouring tiles; then the list of the next round.
void CountedStepper::receive(CountedPipe& pipe, std::size_t tile) {
    Hops& hops = hops_[tile];
    const auto take = [&](const Sites& sites) {
        for (const std::uint64_t site : sites)
            if (put(pipe, static_cast<std::int32_t>(site & 0xffffffffU),
                    static_cast<std::int32_t>(site >> 32)))
                hops.arrived.push_back(site);
    };
    if (tile > 0) take(hops_[tile - 1].above);
    if (tile + 1 < hops_.size()) take(hops_[tile + 1].below);
    hops.crowded.insert(hops.crowded.end(), hops.arrived.begin(), hops.arrived.end());
    std::erase_if(hops.crowded, [&](std::uint64_t site) {
        const auto x = static_cast<std::int32_t>(site & 0xffffffffU),
                   y = static_cast<std::int32_t>(site >> 32);
        if (pipe.beyond[pipe.site(x, y)] > 0) return false;
        pipe.several[pipe.word(x, y)] &= ~bit_of(x);
        return true;
    });
}

std::int64_t CountedStepper::hop_apart(CountedPipe& pipe, std::uint32_t t) {
    const auto crowded = [&] {
        return std::accumulate(hops_.begin(), hops_.end(), std::size_t{0},
                               [](std::size_t sum, const Hops& h) { return sum + h.crowded.size(); });
    };
    std::size_t left = crowded();
    for (std::uint32_t round = 0; round < reference::most_hops && left > 0; ++round) {
        const int threads = left < worth_threads ? 1 : means_.threads;
        for_tiles(hops_.size(), threads, [&](std::size_t tile) { send(pipe, tile, t, round); });
        for_tiles(hops_.size(), threads, [&](std::size_t tile) { receive(pipe, tile); });
        left = crowded();
    }
    return static_cast<std::int64_t>(left);
}

} // namespace sandlane::automata
