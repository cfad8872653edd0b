// The index of mixing: its two ends, and its mean over random arrangements.
#include "analysis/mixing.hpp"

#include "analysis/support.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

using namespace sandlane;
using namespace sandlane::analysis;
using scene::Populations;

namespace {

scene::AnalysisSpec spec_of(Populations populations, std::int64_t bins) {
    scene::AnalysisSpec spec;
    spec.kind = scene::AnalysisKind::mixing;
    spec.populations = populations;
    spec.axis = scene::Axis::x;
    spec.bins = bins;
    return spec;
}

std::unique_ptr<Analysis> mixing_of(const Hand& h, Populations populations, std::int64_t bins = 4) {
    scene::Scene s;
    s.domain.dimension = h.grains.dimension;
    s.domain.upper = h.grains.upper;
    return make_analysis(s, spec_of(populations, bins));
}

double index_of(const Hand& h, Analysis& mixing) {
    mixing.add(h.frame());
    return mixing.rows().at(0).at(1);
}

// 8 x 8 (x 8) grains, two in each direction per cell of four.
Hand grid(int dimension) {
    Hand h(dimension == 3 ? Vec{1, 1, 1} : Vec{1, 1, 0});
    for (int k = 0; k < (dimension == 3 ? 512 : 64); ++k)
        h.add({(k % 8 + 0.5) / 8, (k / 8 % 8 + 0.5) / 8, dimension == 3 ? (k / 64 + 0.5) / 8 : 0.0}, 0.05);
    return h;
}

} // namespace

TEST(Mixing, ApartIsZeroAndEvenIsAboveRandom) {
    // Cells of one colour.
    const Mixing apart = lacey_mixing({{4, 4}, {0, 0}, {2, 0}, {7, 7}});
    EXPECT_NEAR(apart.index, 0, 1e-15);
    EXPECT_EQ(apart.cells, 3);
    EXPECT_EQ(apart.grains, 13);
    // The same share in every cell: S = 0, M = (N - 1)/(N - K).
    const Mixing even = lacey_mixing({{4, 2}, {8, 4}, {2, 1}});
    EXPECT_EQ(even.variance, 0);
    EXPECT_NEAR(even.index, 13.0 / 11, 1e-15);
    // By hand: shares 3/4 and 1/4 about 1/2; S^2 = 1/16, S_0^2 = 1/4, S_R^2 = 1/4 1/7.
    EXPECT_NEAR(lacey_mixing({{4, 3}, {4, 1}}).index, (1.0 / 4 - 1.0 / 16) / (1.0 / 4 - 1.0 / 28), 1e-15);
}

TEST(Mixing, NothingToMixIsNoNumber) {
    EXPECT_TRUE(std::isnan(lacey_mixing({}).index));
    EXPECT_TRUE(std::isnan(lacey_mixing({{5, 5}, {3, 3}}).index)); // one population
    EXPECT_TRUE(std::isnan(lacey_mixing({{1, 1}, {1, 0}}).index)); // no cell with two grains
}

// Cells of very different numbers: the mean over random arrangements is 1 all the same.
TEST(Mixing, RandomArrangementsHaveOneInTheMean) {
    const std::vector<std::int64_t> sizes{1, 2, 3, 5, 8, 13, 40};
    std::vector<int> colours(72, 0);
    std::fill_n(colours.begin(), 20, 1);
    std::mt19937_64 random(3);
    const int trials = 4000;
    double sum = 0, squares = 0;
    for (int trial = 0; trial < trials; ++trial) {
        std::shuffle(colours.begin(), colours.end(), random);
        std::vector<MixingCell> cells;
        auto at = colours.begin();
        for (const std::int64_t size : sizes) {
            cells.push_back({size, std::count(at, at + size, 1)});
            at += size;
        }
        const double index = lacey_mixing(cells).index;
        sum += index;
        squares += index * index;
    }
    const double mean = sum / trials, deviation = std::sqrt((squares / trials - mean * mean) / trials);
    EXPECT_NEAR(mean, 1, 5 * deviation);
    EXPECT_LT(5 * deviation, 0.02); // so that the line above says something
}

TEST(Mixing, SidesAreRemembered) {
    for (const int dimension : {2, 3}) {
        Hand h = grid(dimension);
        const auto mixing = mixing_of(h, Populations::sides);
        EXPECT_NEAR(index_of(h, *mixing), 0, 1e-14);
        // Exchange every second pair of columns with its mirror: half and half in each cell.
        for (std::size_t i = 0; i < h.grains.size(); ++i)
            if (static_cast<int>(8 * h.grains.y[i]) % 2 == 0) h.grains.x[i] = 1 - h.grains.x[i];
        const double grains = static_cast<double>(h.grains.size()), cells = dimension == 3 ? 64 : 16;
        EXPECT_NEAR(index_of(h, *mixing), (grains - 1) / (grains - cells), 1e-14);
        EXPECT_EQ(mixing->rows()[0][2], 0.5);
        EXPECT_EQ(mixing->rows()[0][5], cells);
        h.add({0.5, 0.5, 0.5}); // a newcomer belongs to neither
        mixing->add(h.frame());
        EXPECT_EQ(mixing->rows()[0][4], grains);
    }
}

TEST(Mixing, ByMaterialAndBySize) {
    Hand h = grid(3);
    for (std::size_t i = 0; i < h.grains.size(); ++i) {
        h.grains.material[i] = h.grains.z[i] < 0.25 ? 1 : 4;
        if (static_cast<int>(8 * h.grains.z[i]) % 2 == 0) h.grains.radius[i] = 0.04;
    }
    const auto materials = mixing_of(h, Populations::materials), sizes = mixing_of(h, Populations::sizes);
    EXPECT_NEAR(index_of(h, *materials), 0, 1e-14);
    EXPECT_EQ(materials->rows()[0][2], 0.25);
    EXPECT_NEAR(index_of(h, *sizes), 511.0 / 448, 1e-14); // half and half in each cell
}

TEST(Mixing, CellsAreThreeDiametersWide) {
    Hand h({1.2, 0.6, 0.3});
    for (int k = 0; k < 1000; ++k)
        h.add({(k % 100 + 0.5) * 0.012, (k / 100 + 0.5) * 0.06, 0.1 + 0.1 * (k % 2)}, 0.05);
    const auto mixing = mixing_of(h, Populations::sides, 0);
    mixing->add(h.frame());
    EXPECT_EQ(mixing->rows()[0][5], 4 * 2 * 1);
}
