// Profiles, pair correlation, maps, flow; what a resumed analysis needs.
#include "analysis/flow.hpp"
#include "core/error.hpp"

#include "analysis/support.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

using namespace sandlane;
using namespace sandlane::analysis;

namespace {

scene::Scene unit_box() {
    scene::Scene s;
    s.domain.upper = {1, 1, 0};
    return s;
}

scene::AnalysisSpec spec_of(scene::AnalysisKind kind) {
    scene::AnalysisSpec spec;
    spec.name = "a";
    spec.kind = kind;
    return spec;
}

} // namespace

TEST(Profile, OfAShearFlow) {
    scene::AnalysisSpec spec = spec_of(scene::AnalysisKind::profile);
    spec.bins = 4;
    spec.to = {1, 2, 0};
    const auto profile = make_analysis(unit_box(), spec);
    for (int frame = 0; frame < 2; ++frame) {
        Hand h({1, 2, 0});
        for (const double y : {0.25, 0.75, 1.25}) {
            // Light and heavy, moving against each other: 3 u, -u about the mean weighted by mass.
            h.add({0.1, y, 0}, 0.1, 1, {2 * y + 0.3, 1, 0}, 10);
            h.add({0.9, y, 0}, 0.1, 3, {2 * y - 0.1, 1, 0}, 30);
        }
        profile->add(h.frame());
    }
    const Rows rows = profile->rows();
    ASSERT_EQ(rows.size(), 4U);
    for (std::size_t b = 0; b < 3; ++b) {
        const double y = 0.25 + 0.5 * static_cast<double>(b);
        EXPECT_DOUBLE_EQ(rows[b][0], y);
        EXPECT_DOUBLE_EQ(rows[b][1], 2);
        EXPECT_DOUBLE_EQ(rows[b][2], 4 / 0.5);
        EXPECT_NEAR(rows[b][3], 2 * y, 1e-14);
        EXPECT_NEAR(rows[b][4], 1, 1e-14);
        EXPECT_NEAR(rows[b][5], 0.5 * (0.09 + 3 * 0.01) / 4, 1e-13); // differences of squares of 10
        EXPECT_DOUBLE_EQ(rows[b][6], 20);
    }
    EXPECT_EQ(rows[3], (std::vector<double>{1.75, 0, 0, 0, 0, 0, 0}));
}

TEST(Profile, AlongX) {
    scene::AnalysisSpec spec = spec_of(scene::AnalysisKind::profile);
    spec.bins = 2;
    spec.axis = scene::Axis::x;
    const auto profile = make_analysis(unit_box(), spec);
    Hand h;
    h.add({0.9, 0.1, 0});
    h.add({1.1, 0.1, 0}); // outside
    profile->add(h.frame());
    EXPECT_EQ(profile->rows()[0][1], 0);
    EXPECT_EQ(profile->rows()[1][1], 1);
}

// For grains at random g = 1 up to noise, whatever the sides are: open ones lack the pairs beyond them.
TEST(PairCorrelation, IdealGas) {
    for (const bool periodic_x : {false, true})
        for (const bool periodic_y : {false, true}) {
            scene::Scene scene = unit_box();
            scene.domain.upper = {1, 1.5, 0};
            scene.domain.periodic = {periodic_x, periodic_y};
            scene::AnalysisSpec spec = spec_of(scene::AnalysisKind::pair_correlation);
            spec.bins = 12;
            spec.range = periodic_x ? 0.5 : periodic_y ? 0.75 : 1.0; // as far as is allowed
            const auto g = make_analysis(scene, spec);
            std::mt19937_64 random(7);
            std::uniform_real_distribution<double> uniform(0, 1);
            const int frames = 40;
            for (int frame = 0; frame < frames; ++frame) {
                Hand h({1, 1.5, 0});
                h.grains.periodic_x = periodic_x;
                h.grains.periodic_y = periodic_y;
                for (int k = 0; k < 200; ++k) {
                    const double x = uniform(random);
                    h.add({x, 1.5 * uniform(random), 0});
                }
                g->add(h.frame());
            }
            for (const std::vector<double>& row : g->rows()) {
                // Five standard deviations of independent pairs; the factor covers pairs that share a grain
                // at an open side.
                const double noise = 5 * 1.5 / std::sqrt(row[2] * frames);
                EXPECT_NEAR(row[1], 1, noise) << row[0] << " " << periodic_x << periodic_y;
            }
        }
}

TEST(PairCorrelation, NeighboursOnALattice) {
    const int n = 10;
    scene::Scene scene = unit_box();
    scene.domain.periodic = {true, true};
    scene::AnalysisSpec spec = spec_of(scene::AnalysisKind::pair_correlation);
    spec.range = 0.16;
    spec.bins = 4; // edges 0, 0.04, 0.08, 0.12, 0.16; neighbours at 0.1 and 0.1414
    const auto g = make_analysis(scene, spec);
    Hand h;
    h.grains.periodic_x = h.grains.periodic_y = true;
    for (int k = 0; k < n * n; ++k) h.add({(k % n + 0.5) / n, (k / n + 0.5) / n, 0});
    g->add(h.frame());
    const Rows rows = g->rows();
    const double pairs = n * n / 2.0;
    EXPECT_EQ(rows[0][2], 0);
    EXPECT_EQ(rows[1][2], 0);
    EXPECT_EQ(rows[2][2], 4 * pairs);
    EXPECT_EQ(rows[3][2], 4 * pairs);
    // 4 neighbours over those of (N - 1) random grains in the ring.
    const double ring = std::numbers::pi * (0.12 * 0.12 - 0.08 * 0.08);
    EXPECT_NEAR(rows[2][1], 4 / ((n * n - 1) * ring), 1e-12);
}

TEST(Map, SeparatesChainsFromTheRest) {
    scene::AnalysisSpec spec = spec_of(scene::AnalysisKind::map);
    spec.bins = 2;
    const auto map = make_analysis(unit_box(), spec);
    EXPECT_TRUE(map->grids().empty());
    Hand h;
    for (const double x : {0.1, 0.25, 0.4}) h.add({x, 0.2, 0}, 0.075, 1, {2, 0, 0}, 9);
    h.touch(0, 1, {1, 0, 0});
    h.touch(1, 2, {1, 0, 0});
    h.add({0.8, 0.8, 0}, 0.075, 1, {}, 8); // loaded, alone
    h.add({0.9, 0.6, 0}, 0.075, 1, {}, 0);
    map->add(h.frame()); // mean pressure 7
    map->add(h.frame());
    EXPECT_EQ(map->rows(), (Rows{{0.25, 0.25, 3, 9, 2, 0, 3, 0},
                                 {0.75, 0.25, 0, 0, 0, 0, 0, 0},
                                 {0.25, 0.75, 0, 0, 0, 0, 0, 0},
                                 {0.75, 0.75, 2, 4, 0, 0, 0, 1}}));
    EXPECT_EQ(map->grids().at(0).values, (std::vector<double>{9, 0, 0, 4}));
    EXPECT_EQ(map->grids().at(1).values, (std::vector<double>{3, 0, 0, 0}));
    EXPECT_EQ(map->grids().at(2).values, (std::vector<double>{0, 0, 0, 1}));
}

TEST(Map, BinsAreOneMeanDiameterWide) {
    const auto map = make_analysis(unit_box(), spec_of(scene::AnalysisKind::map));
    Hand h({1, 1, 0});
    h.add({0.5, 0.5, 0}, 0.04);
    h.add({0.7, 0.5, 0}, 0.06);
    map->add(h.frame());
    EXPECT_EQ(map->rows().size(), 100U);
}

TEST(Flow, StraightPaths) {
    const Vec from{0.5, 0.2, 0}, to{0.5, 0.8, 0}; // upwards: left is -x
    const auto moved = [&](Vec before, Vec after) {
        Hand h;
        h.add(before, 0.1, 3);
        const Places places = places_of(h.grains);
        h.grains.x[0] = after.x;
        h.grains.y[0] = after.y;
        return crossings(places, h.grains, from, to).mass;
    };
    EXPECT_EQ(moved({0.4, 0.5, 0}, {0.6, 0.5, 0}), 3);
    EXPECT_EQ(moved({0.6, 0.5, 0}, {0.4, 0.5, 0}), -3);
    EXPECT_EQ(moved({0.4, 0.5, 0}, {0.45, 0.9, 0}), 0);
    EXPECT_EQ(moved({0.4, 0.9, 0}, {0.6, 0.9, 0}), 0);  // past the end
    EXPECT_EQ(moved({0.4, 0.7, 0}, {0.6, 0.95, 0}), 0); // meets the line at 0.825
    EXPECT_EQ(moved({0.4, 0.7, 0}, {0.6, 0.85, 0}), 3); // at 0.775
    // On the line counts to the left: stopping there and going on is one crossing.
    EXPECT_EQ(moved({0.4, 0.5, 0}, {0.5, 0.5, 0}), 0);
    EXPECT_EQ(moved({0.5, 0.5, 0}, {0.6, 0.5, 0}), 3);
}

TEST(Flow, ThroughPeriodicSides) {
    for (const double line : {0.05, 0.97}) { // right behind and before the side
        Hand h;
        h.grains.periodic_x = true;
        h.add({0.95, 0.5, 0});
        const Places places = places_of(h.grains);
        h.grains.x[0] = 0.1; // 0.15 to the right
        h.grains.image_x[0] = 1;
        EXPECT_EQ(crossings(places, h.grains, {line, 0, 0}, {line, 1, 0}).grains, 1) << line;
        EXPECT_EQ(crossings(places, h.grains, {0.5, 0, 0}, {0.5, 1, 0}).grains, 0);
        Hand back;
        back.grains.periodic_x = true;
        back.add({0.1, 0.5, 0});
        const Places start = places_of(back.grains);
        back.grains.x[0] = 0.95;
        back.grains.image_x[0] = -1;
        EXPECT_EQ(crossings(start, back.grains, {line, 0, 0}, {line, 1, 0}).grains, -1) << line;
    }
}

TEST(Flow, GrainsThatLeftDoNotCount) {
    Hand h;
    h.add({0.4, 0.5, 0});
    const Places places = places_of(h.grains);
    EXPECT_EQ(crossings(places, Hand().grains, {0.5, 0, 0}, {0.5, 1, 0}).grains, 0);
    h.grains.id[0] = 7; // another grain on the other side
    h.grains.x[0] = 0.6;
    EXPECT_EQ(crossings(places, h.grains, {0.5, 0, 0}, {0.5, 1, 0}).grains, 0);
}

TEST(Flow, RatePerTime) {
    scene::AnalysisSpec spec = spec_of(scene::AnalysisKind::flow);
    spec.from = {0.5, 0, 0};
    spec.to = {0.5, 1, 0};
    const auto flow = make_analysis(unit_box(), spec);
    Hand h;
    h.add({0.4, 0.5, 0}, 0.1, 2);
    flow->add(h.frame());
    EXPECT_TRUE(flow->rows().empty()); // a crossing takes two frames
    h.grains.x[0] = 0.6;
    h.grains.time = 0.25;
    flow->add(h.frame());
    EXPECT_EQ(flow->rows(), (Rows{{0.25, 1, 2, 8, 2}}));
}

// Every kind: what is saved half way leads to the same rows.
TEST(Analyses, GoOnAfterLoading) {
    for (const auto kind :
         {scene::AnalysisKind::profile, scene::AnalysisKind::pair_correlation,
          scene::AnalysisKind::force_chains, scene::AnalysisKind::map, scene::AnalysisKind::flow,
          scene::AnalysisKind::stress, scene::AnalysisKind::mixing}) {
        SCOPED_TRACE(static_cast<int>(kind));
        scene::AnalysisSpec spec = spec_of(kind);
        if (kind == scene::AnalysisKind::flow) spec = {spec.name, kind, 0, 0, {0.5, 0, 0}, {0.5, 1, 0}};
        const auto straight = make_analysis(unit_box(), spec), first = make_analysis(unit_box(), spec),
                   second = make_analysis(unit_box(), spec);
        const auto frame = [](int n) {
            Hand h;
            h.grains.time = n;
            for (int k = 0; k < 3; ++k)
                h.add({0.2 + 0.2 * k + 0.1 * n, 0.5, 0}, 0.1, 1 + k, {0.1, 0, 0}, 2 + n);
            h.touch(0, 1, {1, 0, 0}, 1 + n);
            h.touch(1, 2, {1, 0, 0}, 2 + n);
            return h;
        };
        for (int n = 0; n < 4; ++n) straight->add(frame(n).frame());
        for (int n = 0; n < 2; ++n) first->add(frame(n).frame());
        ByteWriter saved;
        first->save(saved);
        ByteReader bytes(saved.bytes());
        second->load(bytes);
        EXPECT_TRUE(bytes.at_end());
        for (int n = 2; n < 4; ++n) second->add(frame(n).frame());
        EXPECT_EQ(second->rows(), straight->rows());
        EXPECT_FALSE(straight->rows().empty());
        EXPECT_EQ(straight->rows().at(0).size(), straight->columns().size());
    }
}

TEST(Analyses, SumsOfAnotherAnalysisAreRefused) {
    scene::AnalysisSpec spec = spec_of(scene::AnalysisKind::profile);
    ByteWriter saved;
    make_analysis(unit_box(), spec)->save(saved);
    spec.bins = 7;
    ByteReader bytes(saved.bytes());
    EXPECT_THROW(make_analysis(unit_box(), spec)->load(bytes), Error);
}
