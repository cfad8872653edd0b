// Collisions of lattice gases as Boolean expressions (spec 3.2, 3.4). B is a word or a register of words,
// n[0] to n[5] the particles by direction, n[6] the rest particle.
#pragma once

#include "core/real.hpp"

#include <array>
#include <cstdint>
#include <utility>

namespace sandlane::simd {

inline constexpr int turned(int direction, int by) {
    return (direction + by + 6) % 6;
}

// Head-on pairs alone (d), by axis, and symmetric triples, of the six movers.
template <class B> struct PairsAndTriples {
    B pair[3], triple;

    SANDLANE_INLINE explicit PairsAndTriples(const B* n) {
        for (int i = 0; i < 3; ++i)
            pair[i] =
                n[i] & n[i + 3] & ~(n[turned(i, 1)] | n[turned(i, 2)] | n[turned(i, 4)] | n[turned(i, 5)]);
        triple = (n[0] ^ n[1]) & (n[1] ^ n[2]) & (n[2] ^ n[3]) & (n[3] ^ n[4]) & (n[4] ^ n[5]);
    }
    // What changes in direction j, of axis a = j mod 3: xi turns a pair by +60 degrees.
    SANDLANE_INLINE B change(int a, const B& xi) const {
        return triple | pair[a] | (xi & pair[(a + 2) % 3]) | (~xi & pair[(a + 1) % 3]);
    }
};

// HPP: pairs that meet head on leave at right angles; n[0] to n[3].
template <class B> SANDLANE_INLINE void collide_hpp(B* n) {
    const B change = (n[0] & n[2] & ~(n[1] | n[3])) | (n[1] & n[3] & ~(n[0] | n[2]));
    for (int i = 0; i < 4; ++i) n[i] = n[i] ^ change;
}

template <class B> SANDLANE_INLINE void collide_fhp1(B* n, const B& xi) {
    const PairsAndTriples<B> found(n);
    for (int a = 0; a < 3; ++a) {
        const B change = found.change(a, xi);
        n[a] = n[a] ^ change;
        n[a + 3] = n[a + 3] ^ change;
    }
}

// FHP-II; `splits`: where a rest particle and a mover may become a pair, `joins`: the reverse.
template <class B>
SANDLANE_INLINE void collide_with_rest(B* n, const B& xi, const B& splits, const B& joins) {
    const PairsAndTriples<B> found(n);
    B either[6]; // {rest, i} or {i-1, i+1}, nothing else
    B any = n[6] ^ n[6];
    for (int i = 0; i < 6; ++i) {
        const B away = n[turned(i, 2)] | n[turned(i, 3)] | n[turned(i, 4)];
        const B split = splits & n[6] & n[i] & ~(n[turned(i, 1)] | n[turned(i, 5)] | away);
        const B join = joins & ~n[6] & ~n[i] & n[turned(i, 1)] & n[turned(i, 5)] & ~away;
        either[i] = split | join;
        any = any | either[i];
    }
    B change[3];
    for (int a = 0; a < 3; ++a) change[a] = found.change(a, xi);
    for (int j = 0; j < 6; ++j)
        n[j] = n[j] ^ (change[j % 3] | either[j] | either[turned(j, 1)] | either[turned(j, 5)]);
    n[6] = n[6] ^ any;
}

template <class B> SANDLANE_INLINE void collide_fhp2(B* n, const B& xi) {
    const B all = ~(n[6] ^ n[6]);
    collide_with_rest(n, xi, all, all);
}

// ---- FHP-III: groups of states that go into each other, written out by the compiler

struct StateGroup {
    int size = 0;
    std::array<int, 3> state{}; // ascending
};
struct StateGroups {
    int count = 0;
    std::array<StateGroup, 40> group{};
};

// States of equal mass and momentum; the two classes of five are split by the rest bit (spec 3.1.5).
constexpr StateGroups saturated_groups() {
    constexpr int px[7] = {2, 1, -1, -2, -1, 1, 0}, py[7] = {0, 1, 1, 0, -1, -1, 0};
    struct Sums {
        int mass = 0, x = 0, y = 0;
        constexpr bool operator==(const Sums&) const = default;
    };
    const auto sums = [&](int state) {
        Sums s;
        for (int i = 0; i < 7; ++i)
            if ((state >> i & 1) != 0) {
                ++s.mass;
                s.x += px[i];
                s.y += py[i];
            }
        return s;
    };
    StateGroups all;
    for (int s = 0; s < 128; ++s) {
        const Sums own = sums(s);
        int members[5] = {}, count = 0;
        bool first = true;
        for (int t = 0; t < 128; ++t)
            if (sums(t) == own) {
                first = first && t >= s;
                members[count++] = t;
            }
        if (!first || count == 1) continue;
        for (int rest = 0; rest < (count == 5 ? 2 : 1); ++rest) {
            StateGroup& g = all.group[static_cast<std::size_t>(all.count)];
            for (int k = 0; k < count; ++k)
                if (count != 5 || members[k] >> 6 == rest)
                    g.state[static_cast<std::size_t>(g.size++)] = members[k];
            ++all.count;
        }
    }
    return all;
}
inline constexpr StateGroups fhp3_groups = saturated_groups();

// New states by old ones, of both chiralities.
struct StateTable {
    alignas(64) std::uint8_t to[2][128];
};

constexpr StateTable fhp3_table() {
    StateTable table{};
    for (int s = 0; s < 128; ++s) table.to[0][s] = table.to[1][s] = static_cast<std::uint8_t>(s);
    for (int k = 0; k < fhp3_groups.count; ++k) {
        const StateGroup& g = fhp3_groups.group[static_cast<std::size_t>(k)];
        for (int i = 0; i < g.size; ++i) {
            const auto state = [&](int at) {
                return static_cast<std::uint8_t>(g.state[static_cast<std::size_t>(at % g.size)]);
            };
            table.to[1][state(i)] = state(i + 1);
            table.to[0][state(i)] = state(i + g.size - 1);
        }
    }
    return table;
}

// The sites of a row in one state each: products of the eight combinations of three planes.
template <class B> struct Minterms {
    B low[8], high[8], rest[2];

    SANDLANE_INLINE explicit Minterms(const B* n) {
        products(n, low);
        products(n + 3, high);
        rest[0] = ~n[6];
        rest[1] = n[6];
    }
    SANDLANE_INLINE B of(int state) const { return low[state & 7] & high[state >> 3 & 7] & rest[state >> 6]; }

private:
    static SANDLANE_INLINE void products(const B* n, B* p) {
        for (int s = 0; s < 8; ++s)
            p[s] =
                ((s & 1) != 0 ? n[0] : ~n[0]) & ((s & 2) != 0 ? n[1] : ~n[1]) & ((s & 4) != 0 ? n[2] : ~n[2]);
    }
};

template <int mask, class B> SANDLANE_INLINE void mark(B* change, const B& sites) {
    if constexpr ((mask & 1) != 0) change[0] = change[0] | sites;
    if constexpr ((mask & 2) != 0) change[1] = change[1] | sites;
    if constexpr ((mask & 4) != 0) change[2] = change[2] | sites;
    if constexpr ((mask & 8) != 0) change[3] = change[3] | sites;
    if constexpr ((mask & 16) != 0) change[4] = change[4] | sites;
    if constexpr ((mask & 32) != 0) change[5] = change[5] | sites;
    if constexpr ((mask & 64) != 0) change[6] = change[6] | sites;
}

// Two states are exchanged; of three each goes to the next where xi, else to the one before.
template <int number, class B> SANDLANE_INLINE void exchange(const Minterms<B>& at, const B& xi, B* change) {
    constexpr StateGroup g = fhp3_groups.group[number];
    if constexpr (g.size == 2) {
        mark<g.state[0] ^ g.state[1]>(change, at.of(g.state[0]) | at.of(g.state[1]));
    } else {
        const B a = at.of(g.state[0]), b = at.of(g.state[1]), c = at.of(g.state[2]);
        mark<g.state[0] ^ g.state[1]>(change, (xi & a) | (~xi & b));
        mark<g.state[1] ^ g.state[2]>(change, (xi & b) | (~xi & c));
        mark<g.state[2] ^ g.state[0]>(change, (xi & c) | (~xi & a));
    }
}

template <class B, int... number>
SANDLANE_INLINE void exchange_all(const Minterms<B>& at, const B& xi, B* change,
                                  std::integer_sequence<int, number...>) {
    (exchange<number>(at, xi, change), ...);
}

template <class B> SANDLANE_INLINE void collide_fhp3(B* n, const B& xi) {
    const Minterms<B> at(n);
    B change[7];
    for (B& c : change) c = n[6] ^ n[6];
    exchange_all(at, xi, change, std::make_integer_sequence<int, fhp3_groups.count>());
    for (int j = 0; j < 7; ++j) n[j] = n[j] ^ change[j];
}

// ---- gravity towards +x (spec 3.4.5): the first move of the list whose source is there and whose target is
// free

template <bool rest, class B> SANDLANE_INLINE void turn_towards_x(B* n, B where) {
    constexpr int moves[6][2] = {{6, 0}, {1, 0}, {5, 0}, {2, 1}, {4, 5}, {3, 2}};
    for (int m = rest ? 0 : 1; m < 6; ++m) {
        B& from = n[moves[m][0]];
        B& to = n[moves[m][1]];
        const B moved = where & from & ~to;
        from = from ^ moved;
        to = to ^ moved;
        where = where & ~moved;
    }
}

// ---- any number of rest particles (spec 3.4.4): n[6] where there are some

// How many rest particles beyond the first a site gains, one + 2 two, or loses.
template <class B> struct RestChange { B one, two, less; };

// several: where more than one rests. stops: where collisions dissipate. Collision, then gravity.
template <class B>
SANDLANE_INLINE RestChange<B> collide_counted(B* n, const B& several, const B& xi, const B& stops,
                                              const B& gravity) {
    const PairsAndTriples<B> found(n);
    const B rest = n[6], two = stops & (found.pair[0] | found.pair[1] | found.pair[2]),
            three = stops & found.triple;
    B either[6]; // {one rest particle, i} or {i-1, i+1}, nothing else
    B any = rest ^ rest;
    for (int i = 0; i < 6; ++i) {
        const B away = n[turned(i, 2)] | n[turned(i, 3)] | n[turned(i, 4)];
        const B split = ~stops & rest & ~several & n[i] & ~(n[turned(i, 1)] | n[turned(i, 5)] | away);
        const B join = stops & ~rest & ~n[i] & n[turned(i, 1)] & n[turned(i, 5)] & ~away;
        either[i] = split | join;
        any = any | either[i];
    }
    B change[3];
    for (int a = 0; a < 3; ++a) change[a] = ~stops & found.change(a, xi);
    for (int j = 0; j < 6; ++j)
        n[j] = (n[j] ^ (change[j % 3] | either[j] | either[turned(j, 1)] | either[turned(j, 5)])) &
               ~(two | three);
    n[6] = (rest ^ any) | two | three;
    RestChange<B> gain{(two & ~rest) | (three & rest), (two & rest) | three, rest ^ rest};
    // A rest particle is the first that gravity moves.
    const B moved = gravity & n[6] & ~n[0], fewer = moved & (several | two | three);
    n[0] = n[0] | moved;
    n[6] = n[6] & ~(moved & ~fewer);
    turn_towards_x<false>(n, B(gravity & ~moved));
    const B less = fewer & ~(gain.one | gain.two), minus = fewer & ~less;
    return {gain.one ^ minus, gain.two ^ (minus & ~gain.one), less};
}

} // namespace sandlane::simd
