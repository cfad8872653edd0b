// Sandpiles: identities, single sources and avalanches against exact numbers (spec C1 to C7), and sweeps of
// tiles for every instruction set and thread count against the reference.
#include "automata/reference/sandpile.hpp"
#include "automata/sandpile.hpp"
#include "scene/reader.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sandlane::automata {

namespace {

using reference::Pile;

Pile identity(std::int64_t rows, std::int64_t columns) {
    Pile pile(columns, rows, 6);
    reference::relax(pile, false);
    for (std::int64_t& h : pile.height) h = 6 - h;
    reference::relax(pile, false);
    return pile;
}

std::vector<std::int64_t> histogram(const std::vector<std::int64_t>& heights) {
    std::vector<std::int64_t> counts(4, 0);
    for (const std::int64_t h : heights) ++counts.at(static_cast<std::size_t>(h));
    return counts;
}

scene::Scene pile_scene(const std::string& keys) {
    return scene::parse_scene("method = \"sandpile\"\n[sandpile]\n" + keys, "pile.toml");
}

std::vector<std::int64_t> heights_of(const PileLattice& lattice) {
    std::vector<std::int64_t> heights;
    for (std::int32_t y = 0; y < lattice.rows; ++y)
        for (std::int32_t x = 0; x < lattice.columns; ++x) heights.push_back(lattice.get(x, y));
    return heights;
}

void run_to_rest(Model& model) {
    while (!model.finished()) model.run(1 << 20);
}

TEST(Sandpile, SmallIdentities) {
    EXPECT_EQ(identity(2, 2).height, (std::vector<std::int64_t>(4, 2)));
    EXPECT_EQ(identity(3, 3).height, (std::vector<std::int64_t>{2, 1, 2, 1, 0, 1, 2, 1, 2}));
    EXPECT_EQ(identity(4, 4).height,
              (std::vector<std::int64_t>{2, 3, 3, 2, 3, 2, 2, 3, 3, 2, 2, 3, 2, 3, 3, 2}));
    EXPECT_EQ(identity(5, 5).height, (std::vector<std::int64_t>{2, 3, 2, 3, 2, 3, 2, 1, 2, 3, 2, 1, 0,
                                                                1, 2, 3, 2, 1, 2, 3, 2, 3, 2, 3, 2}));
    EXPECT_EQ(identity(1, 5).height, (std::vector<std::int64_t>{3, 2, 2, 2, 3}));
    EXPECT_EQ(identity(3, 5).height,
              (std::vector<std::int64_t>{0, 2, 1, 2, 0, 3, 3, 2, 3, 3, 0, 2, 1, 2, 0}));
}

TEST(Sandpile, IdentitiesOfEveryKernel) {
    const std::pair<int, std::vector<std::int64_t>> expected[] = {
        {8, {4, 8, 28, 24}}, {16, {16, 32, 112, 96}}, {32, {80, 80, 384, 480}}, {64, {396, 152, 1476, 2072}}};
    for (const auto& [size, counts] : expected)
        for (const simd::Isa isa : simd::available_isas()) {
            if (isa == simd::Isa::scalar && size > 32) continue;
            for (const int threads : {1, 3}) {
                SandpileModel model(
                    pile_scene(fmt::format("columns = {0}\nrows = {0}\nstart = \"identity\"\n", size)),
                    {isa, threads});
                run_to_rest(model);
                EXPECT_EQ(histogram(heights_of(model.lattice())), counts) << size << simd::isa_name(isa);
            }
        }
}

// Identities found from those of smaller lattices are the same.
TEST(Sandpile, DoubledIdentities) {
    for (const auto& [columns, rows] : {std::pair{64, 64}, {65, 65}, {100, 40}, {33, 129}, {5, 5}, {70, 1}})
        for (const simd::Isa isa : {simd::Isa::scalar, simd::available_isas().back()}) {
            if (isa == simd::Isa::scalar && columns * rows > 3000) continue;
            SandpileModel model(
                pile_scene(
                    fmt::format("columns = {}\nrows = {}\nstart = \"identity-doubled\"\n", columns, rows)),
                {isa, 2});
            run_to_rest(model);
            EXPECT_EQ(heights_of(model.lattice()), identity(rows, columns).height)
                << columns << " x " << rows;
        }
}

// Sweeps are the same, whether taken one by one, in pairs or after a restart in the middle of a level.
TEST(Sandpile, SearchesForIdentitiesGoOn) {
    const auto make = [] {
        return std::make_unique<SandpileModel>(
            pile_scene("columns = 90\nrows = 70\nstart = \"identity-doubled\"\n"),
            Means{simd::available_isas().back(), 1});
    };
    const auto whole = make();
    run_to_rest(*whole);
    auto part = make();
    for (const std::int64_t steps : {1, 40, 300, 1, 700}) {
        part->run(steps);
        const std::string state = part->serialise();
        part = make();
        part->restore(state);
        EXPECT_EQ(part->serialise(), state);
    }
    EXPECT_EQ(part->step(), 1042);
    EXPECT_LT(part->step(), whole->step());
    run_to_rest(*part);
    EXPECT_EQ(part->serialise(), whole->serialise());
}

// e + e relaxes to e.
TEST(Sandpile, IdentityIsIdempotent) {
    const Pile e = identity(20, 31);
    Pile twice = e;
    for (std::int64_t& h : twice.height) h *= 2;
    reference::relax(twice, false);
    EXPECT_EQ(twice.height, e.height);
}

// Adding a grain for each open side topples each site of a recurrent state once.
TEST(Sandpile, BurningTest) {
    Pile e = identity(9, 12);
    const std::vector<std::int64_t> before = e.height;
    for (std::int64_t y = 0; y < e.rows; ++y)
        for (std::int64_t x = 0; x < e.columns; ++x)
            e.at(x, y) += (x == 0) + (y == 0) + (x + 1 == e.columns) + (y + 1 == e.rows);
    std::fill(e.topplings.begin(), e.topplings.end(), 0);
    reference::relax(e, true);
    EXPECT_EQ(e.height, before);
    EXPECT_EQ(e.topplings, std::vector<std::int64_t>(before.size(), 1));
}

TEST(Sandpile, NumbersOfRecurrentStates) {
    // The determinant of the toppling matrix by elimination without fractions (Bareiss), exact in 128 bits.
    const auto determinant = [](std::int64_t rows, std::int64_t columns) {
        const auto n = static_cast<std::size_t>(rows * columns);
        std::vector<std::vector<__int128>> m(n, std::vector<__int128>(n, 0));
        for (std::size_t i = 0; i < n; ++i) {
            m[i][i] = 4;
            const std::size_t x = i % static_cast<std::size_t>(columns);
            if (x > 0) m[i][i - 1] = -1;
            if (x + 1 < static_cast<std::size_t>(columns)) m[i][i + 1] = -1;
            if (i >= static_cast<std::size_t>(columns)) m[i][i - static_cast<std::size_t>(columns)] = -1;
            if (i + static_cast<std::size_t>(columns) < n) m[i][i + static_cast<std::size_t>(columns)] = -1;
        }
        __int128 last = 1;
        for (std::size_t k = 0; k + 1 < n; ++k) {
            for (std::size_t i = k + 1; i < n; ++i)
                for (std::size_t j = k + 1; j < n; ++j)
                    m[i][j] = (m[i][j] * m[k][k] - m[i][k] * m[k][j]) / last;
            last = m[k][k];
        }
        return static_cast<std::int64_t>(m[n - 1][n - 1]);
    };
    EXPECT_EQ(determinant(1, 5), 780);
    EXPECT_EQ(determinant(2, 2), 192);
    EXPECT_EQ(determinant(3, 3), 100352);
    EXPECT_EQ(determinant(4, 4), 557568000);
    EXPECT_EQ(determinant(3, 5), 170537640);
    EXPECT_EQ(determinant(5, 5), 32565539635200);
}

struct Source {
    int grains, size;
    std::int64_t topplings, origin, sites, sweeps;
    std::vector<std::int64_t> counts;
};
const Source sources[] = {{100, 21, 225, 41, 37, 45, {397, 8, 16, 20}},
                          {1000, 41, 18226, 574, 421, 588, {1221, 112, 156, 192}}};

TEST(Sandpile, SingleSources) {
    for (const Source& s : sources) {
        Pile pile(s.size, s.size);
        pile.at(s.size / 2, s.size / 2) = s.grains;
        EXPECT_EQ(reference::relax(pile, true), s.sweeps);
        EXPECT_EQ(std::accumulate(pile.topplings.begin(), pile.topplings.end(), std::int64_t{0}),
                  s.topplings);
        EXPECT_EQ(pile.topplings[static_cast<std::size_t>(s.size / 2 * s.size + s.size / 2)], s.origin);
        EXPECT_EQ(std::count_if(pile.topplings.begin(), pile.topplings.end(), [](auto k) { return k > 0; }),
                  s.sites);
        EXPECT_EQ(histogram(pile.height), s.counts);
        EXPECT_EQ(std::accumulate(pile.height.begin(), pile.height.end(), std::int64_t{0}), s.grains);
    }
}

TEST(Sandpile, SingleSourcesByKernels) {
    std::vector<Source> all(std::begin(sources), std::end(sources));
    all.push_back({10000, 101, 1830917, 7585, 4377, 8002, {6113, 452, 1360, 2276}});
    for (const Source& s : all)
        for (const simd::Isa isa : simd::available_isas()) {
            if (isa == simd::Isa::scalar || (s.grains > 1000 && isa != simd::available_isas().back()))
                continue;
            for (const char* sweep : {"unit", "full"})
                for (const char* active : {"true", "false"}) {
                    SandpileModel model(
                        pile_scene(fmt::format("columns = {0}\nrows = {0}\ncentre = {1}\nsweep = "
                                               "\"{2}\"\nactive_tiles = {3}\n",
                                               s.size, s.grains, sweep, active)),
                        {isa, s.grains > 1000 ? 1 : 2});
                    run_to_rest(model);
                    EXPECT_EQ(static_cast<std::int64_t>(model.topplings()), s.topplings);
                    EXPECT_EQ(histogram(heights_of(model.lattice())), s.counts);
                    if (std::string(sweep) == "unit") {
                        EXPECT_EQ(model.step(), s.sweeps);
                    }
                }
        }
}

TEST(Sandpile, EightTimesEight) {
    for (const bool unit : {true, false}) {
        Pile pile(8, 8, 7);
        const std::int64_t sweeps = reference::relax(pile, unit);
        if (unit) {
            EXPECT_EQ(sweeps, 33);
        }
        EXPECT_EQ(std::accumulate(pile.topplings.begin(), pile.topplings.end(), std::int64_t{0}), 1028);
        EXPECT_EQ(std::accumulate(pile.height.begin(), pile.height.end(), std::int64_t{0}), 144);
        std::string rows;
        for (const std::int64_t h : pile.height) rows += static_cast<char>('0' + h);
        const std::string half = "13222231313113132333333221333312";
        std::string mirrored;
        for (int row = 3; row >= 0; --row) mirrored += half.substr(static_cast<std::size_t>(8 * row), 8);
        EXPECT_EQ(rows, half + mirrored);
    }
}

// Heights up to 255 in a byte and 65535 in two must not wrap.
TEST(Sandpile, SweepsOfFullHeightsAreTheReference) {
    for (const std::uint32_t most : {255U, 65535U})
        for (const std::int32_t columns : {1, 31, 32, 63, 64, 65, 130})
            for (const bool unit : {false, true})
                for (const simd::Isa isa : simd::available_isas()) {
                    PileLattice lattice(columns, 19, most == 255 ? 1 : 2);
                    Pile pile(columns, 19);
                    for (std::int32_t y = 0; y < 19; ++y)
                        for (std::int32_t x = 0; x < columns; ++x) {
                            const std::uint32_t h =
                                (x + y) % 3 == 0 ? static_cast<std::uint32_t>(x * 7 + y) % 9 : most;
                            lattice.set(x, y, h);
                            pile.at(x, y) = h;
                        }
                    PileSweeper sweeper(lattice, {isa, 2}, true);
                    for (int n = 0; n < 12; ++n) {
                        EXPECT_EQ(sweeper.sweep(lattice, unit),
                                  static_cast<std::uint64_t>(reference::sweep(pile, unit)));
                        EXPECT_EQ(heights_of(lattice), pile.height) << simd::isa_name(isa) << columns;
                    }
                }
}

TEST(Sandpile, PairsOfSweepsAreTwoSweeps) {
    for (const int bytes : {1, 2})
        for (const bool unit : {false, true})
            for (const std::int32_t rows : {1, 7, 31, 32, 33, 70})
                for (const simd::Isa isa : simd::available_isas()) {
                    PileLattice lattice(150, rows, bytes);
                    Pile pile(150, rows);
                    for (std::int32_t y = 0; y < rows; ++y)
                        for (std::int32_t x = 0; x < 150; ++x) {
                            pile.at(x, y) = (x * 7 + y * 13) % 11;
                            lattice.set(x, y, static_cast<std::uint32_t>(pile.at(x, y)));
                        }
                    PileSweeper sweeper(lattice, {isa, 3}, true);
                    for (int n = 0; n < 6; ++n) {
                        const auto found = sweeper.sweep_pair(lattice, unit);
                        EXPECT_EQ(found[0], static_cast<std::uint64_t>(reference::sweep(pile, unit)));
                        EXPECT_EQ(found[1], static_cast<std::uint64_t>(reference::sweep(pile, unit)));
                        EXPECT_EQ(heights_of(lattice), pile.height) << simd::isa_name(isa) << rows;
                    }
                    sweeper.sweep(lattice, unit);
                    reference::sweep(pile, unit);
                    EXPECT_EQ(heights_of(lattice), pile.height);
                }
}

TEST(Sandpile, QuietTilesChangeNothing) {
    for (const simd::Isa isa : simd::available_isas()) {
        if (isa == simd::Isa::scalar) continue;
        PileLattice all(300, 90, 2), active = all;
        for (PileLattice* lattice : {&all, &active}) {
            lattice->set(20, 20, 900);
            lattice->set(200, 70, 400);
        }
        PileSweeper every(all, {isa, 1}, false), some(active, {isa, 2}, true);
        double least = 1;
        for (int n = 0; n < 200; ++n) {
            EXPECT_EQ(every.sweep(all, false), some.sweep(active, false));
            EXPECT_EQ(heights_of(all), heights_of(active));
            least = std::min(least, some.visited());
        }
        EXPECT_LT(least, 0.5);
    }
}

TEST(Sandpile, OrderedGrains) {
    SandpileModel model(pile_scene("columns = 16\nrows = 16\ndrive = \"ordered\"\nsteps = 6000\n"),
                        {simd::Isa::scalar, 1});
    std::uint64_t largest = 0, last = 0;
    for (int k = 0; k < 6000; ++k) {
        model.run(1);
        largest = std::max(largest, model.topplings() - last);
        last = model.topplings();
    }
    EXPECT_EQ(model.topplings(), 61744U);
    EXPECT_EQ(largest, 544U);
    const std::vector<std::int64_t> h = heights_of(model.lattice());
    std::int64_t sum = 0, weighted = 0;
    for (std::size_t i = 0; i < h.size(); ++i) {
        sum += h[i];
        weighted += h[i] * static_cast<std::int64_t>(i + 1);
    }
    EXPECT_EQ(sum, 548);
    EXPECT_EQ(weighted, 71517);
}

// Avalanches of lists against whole sweeps.
TEST(Sandpile, AvalancheMeasures) {
    PileLattice lattice(13, 9, 1);
    Pile pile(13, 9, 3);
    for (std::int32_t y = 0; y < 9; ++y)
        for (std::int32_t x = 0; x < 13; ++x) lattice.set(x, y, 3);
    AvalancheRunner runner;
    for (std::int32_t k = 0; k < 60; ++k) {
        const std::int32_t x = k * 5 % 13, y = k * 4 % 9;
        const Avalanche a = runner.drop(lattice, x, y);
        std::fill(pile.topplings.begin(), pile.topplings.end(), 0);
        ++pile.at(x, y);
        EXPECT_EQ(a.duration, reference::relax(pile, true));
        std::int64_t size = 0, area = 0, radius = 0;
        for (std::size_t i = 0; i < pile.topplings.size(); ++i) {
            if (pile.topplings[i] == 0) continue;
            size += pile.topplings[i];
            ++area;
            const auto at = static_cast<std::int64_t>(i);
            radius = std::max({radius, std::abs(at % 13 - x), std::abs(at / 13 - y)});
        }
        EXPECT_EQ(a.size, size);
        EXPECT_EQ(a.area, area);
        EXPECT_EQ(a.radius, radius);
        EXPECT_EQ(heights_of(lattice), pile.height);
    }
}

// The mean size of avalanches is that of the toppling matrix; sizes of the stationary state scatter by their
// own spread.
TEST(Sandpile, MeanAvalancheSize) {
    const std::pair<int, double> expected[] = {
        {4, 1.20833333}, {8, 3.46247225}, {16, 11.33821462}, {32, 40.58031836}, {64, 153.04310023}};
    for (const auto& [size, mean] : expected) {
        PileLattice lattice(size, size, 1);
        AvalancheRunner runner;
        const auto burn_in = static_cast<std::uint32_t>(10 * size * size);
        constexpr std::uint32_t grains = 60000;
        double sum = 0, squares = 0;
        for (std::uint32_t k = 0; k < burn_in + grains; ++k) {
            const PhiloxCounter r = philox({k, 0, 0, 0}, {5, 0});
            const auto s = static_cast<std::uint64_t>(size);
            const double n = static_cast<double>(runner
                                                     .drop(lattice, static_cast<std::int32_t>(r[0] * s >> 32),
                                                           static_cast<std::int32_t>(r[1] * s >> 32))
                                                     .size);
            if (k < burn_in) continue;
            sum += n;
            squares += n * n;
        }
        const double found = sum / grains, variance = squares / grains - found * found;
        // Successive sizes are anticorrelated if anything: the pile keeps what it did not lose.
        EXPECT_NEAR(found, mean, 5 * std::sqrt(variance / grains)) << size;
    }
}

} // namespace

} // namespace sandlane::automata
