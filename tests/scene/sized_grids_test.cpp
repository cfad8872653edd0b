// Grids per class of radii against every pair looked at.
#include "scene/sized_grids.hpp"

#include "core/rng.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <vector>

namespace sandlane::scene {

namespace {

struct Layout {
    std::int64_t dimension;
    bool periodic;
    double seam;
};

class SizedGridsOf : public testing::TestWithParam<Layout> {};

// Radii 1:100, in any order: whatever a grain may touch is found, once, among those inserted before it.
TEST_P(SizedGridsOf, WideRatiosFindWhatAllPairsFind) {
    const auto [dimension, periodic, seam] = GetParam();
    Domain domain;
    domain.dimension = dimension;
    domain.upper = {3, 4, dimension == 3 ? 3.5 : 0.0}; // the largest see all of it
    domain.periodic = {periodic, periodic, periodic && dimension == 3};
    Box box(domain);
    box.seam = seam;
    const Random random(7, Stream::position);
    std::uint64_t counter = 0;
    const auto uniform = [&](double low, double high) {
        return low + (high - low) * random.uniform(counter++);
    };
    std::vector<Vec> centres;
    std::vector<double> radii;
    for (int n = 0; n < 1500; ++n) {
        radii.push_back(0.8 * std::pow(10.0, -2 * std::sqrt(uniform(0, 1)))); // few large ones
        // And beyond the sides of an open box.
        const double out = periodic ? 0 : 0.1;
        centres.push_back({uniform(-out, 3 + out), uniform(-out, 4 + out), 0});
        if (dimension == 3) centres.back().z = uniform(-out, 3.5 + out);
    }
    SizedGrids grids(box, radii.size(), [&](std::size_t i) { return radii[i]; });
    EXPECT_GE(grids.classes().size(), 6U);
    std::size_t pairs = 0, visits = 0;
    for (std::size_t i = 0; i < centres.size(); ++i) {
        std::map<std::size_t, int> met;
        grids.for_near(centres[i], radii[i], [&](std::size_t j) { ++met[j]; });
        for (std::size_t j = 0; j < i; ++j) {
            const bool touch = norm(box.separation(centres[i], centres[j])) < radii[i] + radii[j];
            pairs += touch ? 1 : 0;
            ASSERT_TRUE(!touch || met.contains(j)) << i << " " << j;
        }
        for (const auto& [j, times] : met) ASSERT_EQ(times, 1) << i << " " << j;
        visits += met.size();
        grids.insert(centres[i], radii[i]);
    }
    EXPECT_GT(pairs, 100U);
    // One grid with cells for the largest would visit nearly all.
    EXPECT_LT(visits, centres.size() * centres.size() / 4);
}

INSTANTIATE_TEST_SUITE_P(Boxes, SizedGridsOf,
                         testing::Values(Layout{2, false, 0}, Layout{2, true, 0}, Layout{2, true, 1.3},
                                         Layout{3, false, 0}, Layout{3, true, 0}),
                         [](const auto& layout) {
                             const Layout& l = layout.param;
                             return std::to_string(l.dimension) + (l.seam != 0  ? "Sheared"
                                                                   : l.periodic ? "Periodic"
                                                                                : "Open");
                         });

} // namespace

} // namespace sandlane::scene
