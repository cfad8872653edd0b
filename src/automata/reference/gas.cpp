#include "automata/reference/gas.hpp"

#include <algorithm>
#include <bit>
#include <vector>

namespace sandlane::automata::reference {

namespace {

constexpr std::array<int, 2> velocity[7] = {{2, 0}, {1, 1}, {-1, 1}, {-2, 0}, {-1, -1}, {1, -1}, {0, 0}};
constexpr int movers = 63, rest = 64;

int bit(int direction) {
    return 1 << ((direction + 6) % 6);
}

// All movers turned by 60 degrees, `times` times.
int rotated(int state, int times) {
    int result = state & rest;
    for (int i = 0; i < 6; ++i)
        if ((state & bit(i)) != 0) result |= bit(i + times);
    return result;
}

int collide_hpp(int s) {
    if (s == 0b0101) return 0b1010;
    if (s == 0b1010) return 0b0101;
    return s;
}

// Pairs and triples of movers; a rest particle looks on.
int collide_movers(int s, bool xi) {
    const int m = s & movers;
    for (int i = 0; i < 3; ++i)
        if (m == (bit(i) | bit(i + 3))) return rotated(s, xi ? 1 : 5);
    if (m == 0b010101 || m == 0b101010) return (m ^ movers) | (s & rest);
    return s;
}

int collide_with_rest(int s, bool xi, bool splits, bool joins) {
    for (int i = 0; i < 6; ++i) {
        const int one = rest | bit(i), two = bit(i - 1) | bit(i + 1);
        if (s == one && splits) return two;
        if (s == two && joins) return one;
    }
    return collide_movers(s, xi);
}

// Collision-saturated: all states of equal mass and momentum, ascending; classes of five are split by the
// rest bit.
int collide_saturated(int s, bool xi) {
    const auto is_alike = [&](int other) {
        return std::popcount(static_cast<unsigned>(other)) == std::popcount(static_cast<unsigned>(s)) &&
               momentum(other) == momentum(s);
    };
    std::vector<int> group;
    for (int other = 0; other < 128; ++other)
        if (is_alike(other)) group.push_back(other);
    if (group.size() == 5) std::erase_if(group, [&](int other) { return (other & rest) != (s & rest); });
    const std::size_t n = group.size();
    const auto at = static_cast<std::size_t>(std::find(group.begin(), group.end(), s) - group.begin());
    return group[(at + (xi ? 1 : n - 1)) % n];
}

} // namespace

std::array<int, 2> momentum(int state) {
    std::array<int, 2> sum{};
    for (int i = 0; i < 7; ++i)
        if ((state >> i & 1) != 0) {
            sum[0] += velocity[i][0];
            sum[1] += velocity[i][1];
        }
    return sum;
}

int collide(GasModel model, int state, bool xi, bool dissipative) {
    switch (model) {
    case GasModel::hpp:
        return collide_hpp(state);
    case GasModel::fhp1:
        return collide_movers(state, xi);
    case GasModel::fhp2:
        return collide_with_rest(state, xi, true, true);
    case GasModel::fhp3:
        return collide_saturated(state, xi);
    case GasModel::pipe:
        return collide_with_rest(state, xi, !dissipative, dissipative);
    }
    return state;
}

int turn_towards_x(int state, bool has_rest) {
    constexpr int moves[6][2] = {{6, 0}, {1, 0}, {5, 0}, {2, 1}, {4, 5}, {3, 2}};
    for (const auto& [from, to] : moves) {
        if (from == 6 && !has_rest) continue;
        if ((state >> from & 1) != 0 && (state >> to & 1) == 0) return (state & ~(1 << from)) | 1 << to;
    }
    return state;
}

bool chance(std::uint32_t probability, std::int32_t x, std::int32_t y, std::uint32_t t, std::uint32_t stream,
            const PhiloxKey& seed) {
    if (probability == 0) return false;
    if (probability == 1U << simd::probability_bits) return true;
    bool result = false;
    for (std::uint32_t n = static_cast<std::uint32_t>(std::countr_zero(probability)); n < 16; ++n) {
        const PhiloxCounter r = philox(
            {static_cast<std::uint32_t>(x / 64), static_cast<std::uint32_t>(y), t, stream * 64 + n}, seed);
        const std::uint64_t word = std::uint64_t{r[1]} << 32 | r[0];
        const bool drawn = (word >> (x % 64) & 1) != 0;
        result = (probability >> n & 1) != 0 ? drawn || result : drawn && result;
    }
    return result;
}

namespace {

// The tables of all collisions: [dissipative][xi][state].
std::vector<int> tables(GasModel model) {
    std::vector<int> table;
    for (const bool dissipative : {false, true})
        for (const bool xi : {false, true})
            for (int s = 0; s < 128; ++s) table.push_back(collide(model, s, xi, dissipative));
    return table;
}

struct Place {
    std::int32_t x, y;
};

// The neighbour in a direction: square lattice, or bricks.
Place neighbour(const GasRules& rules, Place p, int direction) {
    if (rules.model == GasModel::hpp) {
        constexpr int dx[] = {1, 0, -1, 0}, dy[] = {0, 1, 0, -1};
        return {p.x + dx[direction], p.y + dy[direction]};
    }
    const int o = p.y & 1;
    const int dx[] = {1, o, o - 1, -1, o - 1, o}, dy[] = {0, 1, 1, 0, -1, -1};
    return {p.x + dx[direction], p.y + dy[direction]};
}

} // namespace

GasBalance step(GasLattice& lattice, const GasRules& rules, std::uint32_t t) {
    static_assert(simd::gas_models == 5);
    static const std::array<std::vector<int>, 5> all = {tables(GasModel::hpp), tables(GasModel::fhp1),
                                                        tables(GasModel::fhp2), tables(GasModel::fhp3),
                                                        tables(GasModel::pipe)};
    const std::vector<int>& table = all[static_cast<std::size_t>(rules.model)];
    const int directions = rules.directions(), back = directions / 2;
    GasBalance balance;
    GasLattice next(lattice.columns, lattice.rows);
    for (std::int32_t y = 0; y < lattice.rows; ++y)
        for (std::int32_t x = 0; x < lattice.columns; ++x) {
            int state = 0;
            for (int i = 0; i < rules.planes(); ++i) state |= static_cast<int>(lattice.get(i, x, y)) << i;
            if (lattice.is_solid(x, y)) {
                int turned = state & rest;
                for (int i = 0; i < directions; ++i)
                    if ((state >> i & 1) != 0) turned |= 1 << (i + back) % directions;
                state = turned;
            } else {
                const auto drawn = [&](std::uint32_t probability, std::uint32_t stream) {
                    return chance(probability, x, y, t, stream, rules.seed);
                };
                const bool xi = rules.alternating ? ((static_cast<std::uint32_t>(x + y) + t) & 1) != 0
                                                  : drawn(1U << 15, simd::gas_stream::chirality);
                const bool dissipative = drawn(rules.dissipation, simd::gas_stream::dissipation);
                state = table[static_cast<std::size_t>((dissipative ? 256 : 0) + (xi ? 128 : 0) + state)];
                if (drawn(rules.gravity, simd::gas_stream::gravity)) {
                    const int pulled = turn_towards_x(state, rules.has_rest());
                    balance.gravity_x += momentum(pulled)[0] - momentum(state)[0];
                    state = pulled;
                }
            }
            if ((state & rest) != 0) next.set(6, x, y, true);
            for (int i = 0; i < directions; ++i) {
                if ((state >> i & 1) == 0) continue;
                const Place to = neighbour(rules, {x, y}, i);
                if (rules.closed && (to.y < 0 || to.y >= lattice.rows)) {
                    // Walls of HPP always send straight back.
                    const bool straight = directions == 4 || chance(rules.roughness, x, y, t,
                                                                    simd::gas_stream::wall, rules.seed);
                    const int out = straight ? (i + back) % directions : 6 - i;
                    balance.wall_x += velocity[out][0] - velocity[i][0];
                    next.set(out, x, y, true);
                } else {
                    next.set(i, (to.x + lattice.columns) % lattice.columns,
                             (to.y + lattice.rows) % lattice.rows, true);
                }
            }
        }
    for (std::size_t i = 0; i < lattice.plane.size(); ++i) lattice.plane[i].swap(next.plane[i]);
    return balance;
}

} // namespace sandlane::automata::reference
