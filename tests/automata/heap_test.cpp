// Heaps of grains with energy: the exact heaps of the specification (C8 to C10), slopes, and rough heaps.
#include "automata/heap.hpp"
#include "automata/spectrum.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace sandlane::automata {

namespace {

HeapTable heap(std::int64_t columns, std::uint32_t grains, double r, double u) {
    HeapTable table(columns, {r, u, 0, 0, 0, false, {}});
    for (std::uint32_t g = 0; g < grains; ++g) table.drop(g);
    return table;
}

struct Expected {
    double r, u;
    std::int64_t foot, top, weighted;
    double slope;
};

TEST(Heap, ExactHeaps) {
    const Expected all[] = {{.5, 1.5, 141, 283, 954084, 1.98734}, {.6, 2, 163, 246, 1101781, 1.49787},
                            {.8, 1, 346, 116, 2333159, .32660},   {.5, 1, 198, 202, 1332630, 1.01206},
                            {.5, 3, 115, 349, 778973, 3.00609},   {.4, 1, 141, 282, 954107, 1.98689}};
    for (const Expected& e : all) {
        const HeapTable table = heap(2000, 20000, e.r, e.u);
        std::int64_t foot = 0, weighted = 0;
        while (table.height(0, foot) > 0) ++foot;
        for (std::int64_t x = 0; x < 2000; ++x) weighted += table.height(0, x) * (x + 1);
        EXPECT_EQ(foot, e.foot) << e.r << " " << e.u;
        EXPECT_EQ(table.height(0, 0), e.top);
        EXPECT_EQ(weighted, e.weighted);
        std::vector<double> x, h;
        for (std::int64_t k = 0; k <= static_cast<std::int64_t>(0.6 * static_cast<double>(foot)); ++k) {
            x.push_back(static_cast<double>(k));
            h.push_back(table.height(0, k));
        }
        EXPECT_NEAR(-fit_line(x, h).slope, e.slope, 5e-6);
    }
}

TEST(Heap, SmallHeap) {
    const HeapTable table = heap(30, 400, .5, 1.5);
    EXPECT_EQ(table.height(0, 0), 40);
    EXPECT_EQ(table.height(0, 1), 36);
    EXPECT_EQ(table.height(0, 2), 35);
    for (std::int64_t x = 3; x < 20; ++x)
        EXPECT_EQ(table.height(0, x), std::max<std::int64_t>(33 - 2 * (x - 3), 0));
    EXPECT_EQ(table.lost(), 0);
}

TEST(Heap, KeepsOrLosesEveryGrain) {
    for (const bool two : {false, true})
        for (const double rough : {0.0, 0.5})
            for (const std::int64_t steepest : {0, 3}) {
                HeapTable table(20, {.5, 1.5, 0, rough, steepest, two, {4, 0}});
                for (std::uint32_t g = 0; g < 3000; ++g) table.drop(g);
                const std::vector<std::int32_t>& h = table.heights();
                EXPECT_EQ(std::accumulate(h.begin(), h.end(), std::int64_t{0}) + table.lost(), 3000);
                EXPECT_GT(table.lost(), 0);
                EXPECT_EQ(table.height(0, 19), 0);
            }
}

TEST(Heap, LanesAreTheHeaps) {
    for (const bool two : {false, true})
        for (const std::int64_t steepest : {0, 2, 4})
            for (const double rough : {0.0, 0.7})
                for (const std::size_t count : {1U, 5U, 8U}) {
                    std::vector<HeapTable> expected;
                    for (std::uint32_t n = 0; n < count; ++n)
                        expected.emplace_back(25, HeapRules{.55, 1.3, .2, rough, steepest, two, {n, 5}});
                    const std::vector<HeapTable> start = expected;
                    for (HeapTable& heap : expected)
                        for (std::uint32_t g = 0; g < 1500; ++g) heap.drop(g);
                    for (const simd::Isa isa : simd::available_isas()) {
                        if (isa == simd::Isa::scalar) continue;
                        std::vector<HeapTable> found = start;
                        drop_on_lanes(found, isa, 0, 700);
                        drop_on_lanes(found, isa, 700, 800);
                        for (std::size_t n = 0; n < count; ++n) {
                            EXPECT_EQ(found[n].heights(), expected[n].heights())
                                << simd::isa_name(isa) << " sides " << two + 1 << " steepest " << steepest;
                            EXPECT_EQ(found[n].lost(), expected[n].lost());
                            EXPECT_EQ(found[n].released(), expected[n].released());
                        }
                    }
                }
}

// Of every number of columns: the last ones are looked at one by one.
TEST(Heap, LanesOfAllLengths) {
    for (const std::int64_t columns : {2, 3, 8, 9, 10, 17, 40})
        for (const bool two : {false, true}) {
            std::vector<HeapTable> expected;
            for (std::uint32_t n = 0; n < 8; ++n)
                expected.emplace_back(columns, HeapRules{.5, 1.5, 0, .5, 3, two, {n, 1}});
            std::vector<HeapTable> found = expected;
            for (HeapTable& heap : expected)
                for (std::uint32_t g = 0; g < 800; ++g) heap.drop(g);
            drop_on_lanes(found, simd::available_isas().back(), 0, 800);
            for (std::size_t n = 0; n < 8; ++n)
                EXPECT_EQ(found[n].heights(), expected[n].heights()) << columns;
        }
}

TEST(Heap, TwoSidesAreAlike) {
    HeapTable table(500, {.5, 1.5, 0, 0, 0, true, {7, 0}});
    for (std::uint32_t g = 0; g < 20000; ++g) table.drop(g);
    std::int64_t right = 0, left = 0;
    for (std::int64_t x = 1; x < 500; ++x) {
        right += table.height(0, x);
        left += table.height(1, x);
    }
    EXPECT_NEAR(static_cast<double>(right), static_cast<double>(left), 0.02 * 20000);
    EXPECT_NEAR(table.height(0, 20) - table.height(0, 60), 2 * 40, 4);
}

// A limit of the slope below the angle of repose takes grains from the flank.
TEST(Heap, AvalanchesLimitTheSlope) {
    HeapTable table(300, {.5, 1.5, 0, 0, 3, false, {}});
    for (std::uint32_t g = 0; g < 10000; ++g) table.drop(g);
    // A column that is too steep keeps its grain only if that has too little energy: r (s - 1) <= U.
    for (std::int64_t x = 0; x + 1 < 299; ++x)
        EXPECT_TRUE(table.height(0, x) - table.height(0, x + 1) <= 3 ||
                    .5 * (table.height(0, x) - 1 - table.height(0, x + 1)) <= 1.5);
}

// The foot of the mean of rough heaps is curved: a logarithm fits better than a line, flatter at the foot.
TEST(Heap, RoughHeapsHaveATail) {
    constexpr std::int64_t columns = 400;
    std::vector<double> mean(columns, 0);
    constexpr int heaps = 100;
    for (std::uint32_t n = 0; n < heaps; ++n) {
        HeapTable table(columns, {.5, 1.5, 0, .5, 0, false, {n, 0}});
        for (std::uint32_t g = 0; g < 3000; ++g) table.drop(g);
        for (std::int64_t x = 0; x < columns; ++x)
            mean[static_cast<std::size_t>(x)] += static_cast<double>(table.height(0, x)) / heaps;
    }
    const auto foot = static_cast<std::size_t>(std::find(mean.begin(), mean.end(), 0.0) - mean.begin());
    std::vector<double> x, h;
    for (std::size_t k = 0; k < foot / 2; ++k) {
        x.push_back(static_cast<double>(k));
        h.push_back(mean[foot - k]);
    }
    const TailFit fit = fit_tail(x, h);
    const Line line = fit_line(x, h);
    double rest = 0;
    for (std::size_t i = 0; i < x.size(); ++i) rest += std::pow(h[i] - line.offset - line.slope * x[i], 2);
    EXPECT_LT(fit.error, 0.5 * std::sqrt(rest / static_cast<double>(x.size())));
    EXPECT_LT(fit.c, 0);
    EXPECT_LT(h[3] - h[0], 3 * fit.b);
}

} // namespace

} // namespace sandlane::automata
