// The three conditions of force chains, one by one (md-spheres 9.8).
#include "analysis/force_chains.hpp"

#include "analysis/support.hpp"

#include <gtest/gtest.h>

#include <numbers>

using namespace sandlane;
using namespace sandlane::analysis;

namespace {

// Three grains in contact that make an angle at the middle one.
Hand bent(double degrees) {
    Hand h({10, 10, 0});
    const double angle = degrees * std::numbers::pi / 180;
    for (int k = 0; k < 3; ++k) h.add({}, 1, 1, {}, 2);
    h.touch(0, 1, {1, 0, 0});
    h.touch(1, 2, {-std::cos(angle), std::sin(angle), 0}); // from the middle, whose first line points to -x
    return h;
}

} // namespace

TEST(ForceChains, NeedAnAngleAbove150Degrees) {
    EXPECT_EQ(find_force_chains(bent(149.9).frame(), 1).triples, 0);
    EXPECT_EQ(find_force_chains(bent(149.9).frame(), 1).members(), 0);
    for (const double angle : {150.1, 180.0, 209.9}) {
        const ForceChains found = find_force_chains(bent(angle).frame(), 1);
        EXPECT_EQ(found.triples, 1);
        EXPECT_EQ(found.length, std::vector<std::int64_t>{3});
    }
    EXPECT_EQ(find_force_chains(bent(210.1).frame(), 1).triples, 0);
}

TEST(ForceChains, NeedThreeLoadedGrains) {
    for (std::size_t weak = 0; weak < 3; ++weak) {
        Hand h = bent(180);
        h.grains.pressure[weak] = 1; // not above the threshold
        EXPECT_EQ(find_force_chains(h.frame(), 1).triples, 0);
    }
}

TEST(ForceChains, NeedContacts) {
    Hand h = bent(180);
    h.contacts.pop_back();
    EXPECT_EQ(find_force_chains(h.frame(), 1).triples, 0);
    h.touch(1, -1, {1, 0, 0}); // a wall is no grain
    EXPECT_EQ(find_force_chains(h.frame(), 1).triples, 0);
}

TEST(ForceChains, ComponentsOfTheirBonds) {
    Hand h({10, 10, 0});
    for (int k = 0; k < 10; ++k) h.add({}, 1, 1, {}, 2);
    // A row 8-0-5-3, apart from it a row 1-2-4, and 6 beside 5, at a right angle; 7 and 9 touch nobody.
    h.touch(0, 8, {-1, 0, 0});
    h.touch(0, 5, {1, 0, 0});
    h.touch(3, 5, {-1, 0, 0});
    h.touch(1, 2, {0, 1, 0});
    h.touch(2, 4, {0, 1, 0});
    h.touch(5, 6, {0, 1, 0});
    const ForceChains found = find_force_chains(h.frame(), 1);
    EXPECT_EQ(found.triples, 3);
    EXPECT_EQ(found.length, (std::vector<std::int64_t>{4, 3}));
    EXPECT_EQ(found.chain, (std::vector<std::int32_t>{0, 1, 1, 0, 1, 0, -1, -1, 0, -1}));
}

TEST(ForceChains, TheSeriesCountsInUnitsOfTheMeanPressure) {
    scene::AnalysisSpec spec;
    spec.kind = scene::AnalysisKind::force_chains;
    spec.threshold = 0.5;
    const auto series = make_analysis(scene::Scene(), spec);
    Hand h = bent(180);
    h.grains.pressure = {2, 3, 4}; // mean 3, threshold 1.5
    h.grains.time = 0.25;
    series->add(h.frame());
    EXPECT_EQ(series->rows(), (Rows{{0.25, 3, 1, 1, 3, 1, 3, 3}}));
    h.grains.pressure = {1, 3, 5};
    series->add(h.frame());
    EXPECT_EQ(series->rows(), (Rows{{0.25, 3, 0, 0, 0, 0, 0, 0}}));
}
