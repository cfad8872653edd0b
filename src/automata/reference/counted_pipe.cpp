#include "automata/reference/counted_pipe.hpp"

#include "automata/reference/gas.hpp"

#include <bit>
#include <numeric>

namespace sandlane::automata::reference {

namespace {

std::uint8_t bit(int direction) {
    return static_cast<std::uint8_t>(1 << ((direction + 6) % 6));
}

} // namespace

CountedSite collide(CountedSite s, bool xi, bool dissipative) {
    for (int i = 0; i < 3; ++i)
        if (s.movers == (bit(i) | bit(i + 3))) {
            if (dissipative) return {0, s.resting + 2};
            const int turn = xi ? 1 : 5;
            return {bit(i + turn) | bit(i + 3 + turn), s.resting};
        }
    if (s.movers == 0b010101 || s.movers == 0b101010)
        return dissipative ? CountedSite{0, s.resting + 3} : CountedSite{s.movers ^ 63, s.resting};
    for (int i = 0; i < 6; ++i) {
        const int pair = bit(i - 1) | bit(i + 1);
        if (s.movers == bit(i) && s.resting == 1 && !dissipative) return {pair, 0};
        if (s.movers == pair && s.resting == 0 && dissipative) return {bit(i), 1};
    }
    return s;
}

CountedSite pull(CountedSite s) {
    const int state = s.movers | (s.resting > 0 ? 64 : 0);
    const int pulled = turn_towards_x(state, true);
    const bool rose = (state & 64) != 0 && (pulled & 64) == 0;
    return {pulled & 63, s.resting - (rose ? 1 : 0)};
}

namespace {

// The neighbour in a direction; a row outside the pipe where there is none.
struct Place {
    std::int64_t x, y;
};
Place neighbour(const CountedPipe& pipe, Place p, int direction) {
    const std::int64_t o = p.y & 1;
    const std::int64_t dx[] = {1, o, o - 1, -1, o - 1, o}, dy[] = {0, 1, 1, 0, -1, -1};
    return {(p.x + dx[direction] + pipe.length) % pipe.length, p.y + dy[direction]};
}

bool inside(const CountedPipe& pipe, Place p) {
    return p.y >= 0 && p.y < pipe.width;
}

template <class Body> void for_sites(const CountedPipe& pipe, const Body& body) {
    for (std::int64_t y = 0; y < pipe.width; ++y)
        for (std::int64_t x = 0; x < pipe.length; ++x)
            body(Place{x, y}, static_cast<std::size_t>(y * pipe.length + x));
}

bool happens(std::uint32_t probability, Place p, std::uint32_t t, std::uint32_t stream,
             const GasRules& rules) {
    return chance(probability, static_cast<std::int32_t>(p.x), static_cast<std::int32_t>(p.y), t, stream,
                  rules.seed);
}

// Each site with several sends one away, all at once.
bool hop(CountedPipe& pipe, const GasRules& rules, std::uint32_t t, std::uint32_t round) {
    bool any = false;
    const std::vector<std::uint16_t> old = pipe.resting;
    for_sites(pipe, [&](Place p, std::size_t n) {
        if (old[n] <= 1) return;
        any = true;
        const PhiloxCounter r =
            philox({static_cast<std::uint32_t>(p.x), static_cast<std::uint32_t>(p.y), t, hop_stream + round},
                   rules.seed);
        const Place to = neighbour(pipe, p, static_cast<int>(r[0] * std::uint64_t{6} >> 32));
        if (!inside(pipe, to)) return;
        --pipe.resting[n];
        ++pipe.resting[static_cast<std::size_t>(to.y * pipe.length + to.x)];
    });
    return any;
}

} // namespace

std::int64_t CountedPipe::moving() const {
    return std::accumulate(movers.begin(), movers.end(), std::int64_t{0},
                           [](std::int64_t sum, std::uint8_t m) { return sum + std::popcount(m); });
}

std::int64_t CountedPipe::particles() const {
    return moving() + std::accumulate(resting.begin(), resting.end(), std::int64_t{0});
}

std::int64_t step(CountedPipe& pipe, const GasRules& rules, std::uint32_t t) {
    using namespace simd::gas_stream;
    for_sites(pipe, [&](Place p, std::size_t n) {
        CountedSite s{pipe.movers[n], pipe.resting[n]};
        s = collide(s, happens(1U << 15, p, t, chirality, rules),
                    happens(rules.dissipation, p, t, dissipation, rules));
        if (happens(rules.gravity, p, t, gravity, rules)) s = pull(s);
        pipe.movers[n] = static_cast<std::uint8_t>(s.movers);
        pipe.resting[n] = static_cast<std::uint16_t>(s.resting);
    });
    for (std::uint32_t round = 0; round < most_hops && hop(pipe, rules, t, round); ++round) {
    }
    std::int64_t crowded = 0;
    std::vector<std::uint8_t> next(pipe.movers.size(), 0);
    for_sites(pipe, [&](Place p, std::size_t n) {
        crowded += pipe.resting[n] > 1 ? 1 : 0;
        for (int i = 0; i < 6; ++i) {
            if ((pipe.movers[n] & bit(i)) == 0) continue;
            const Place to = neighbour(pipe, p, i);
            if (inside(pipe, to))
                next[static_cast<std::size_t>(to.y * pipe.length + to.x)] |= bit(i);
            else
                next[n] |= happens(rules.roughness, p, t, wall, rules) ? bit(i + 3) : bit(6 - i);
        }
    });
    pipe.movers.swap(next);
    return crowded;
}

} // namespace sandlane::automata::reference
