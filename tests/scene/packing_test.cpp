// Random populations: packing fraction, overlaps, confinement, and errors for what does not fit.
#include "scene/initial_state.hpp"

#include "scene/cell_grid.hpp"
#include "scene/wall_geometry.hpp"
#include "support.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sandlane::scene {

namespace {

// Radii +-10 %, mean 1, in a square box of the size that gives the packing fraction.
Scene random_scene(std::int64_t count, double fraction, bool periodic) {
    Scene scene;
    scene.materials.emplace_back().young = 1e8;
    const double mean_square = (1.1 * 1.1 * 1.1 - 0.9 * 0.9 * 0.9) / 0.6;
    const double side = std::sqrt(static_cast<double>(count) * std::numbers::pi * mean_square / fraction);
    scene.domain.upper = {side, side, 0};
    scene.domain.periodic = {periodic, periodic};
    Grains& g = scene.grains.emplace_back();
    g.kind = GrainKind::random;
    g.sizes = {SizeLaw::uniform, 0.9, 1.1};
    g.count = count;
    return scene;
}

double covered(const std::vector<GrainState>& grains) {
    double area = 0;
    for (const GrainState& g : grains) area += std::numbers::pi * g.radius * g.radius;
    return area;
}

// Largest overlap in units of the smaller radius; below 0: a gap.
double worst_overlap(const Scene& scene, const std::vector<GrainState>& grains) {
    const Box box(scene.domain);
    double largest = 0, worst = -1;
    for (const GrainState& g : grains) largest = std::max(largest, g.radius);
    CellGrid grid(box, 2 * largest, grains.size());
    for (const GrainState& g : grains) {
        grid.for_near(g.position, [&](std::size_t n) {
            const GrainState& o = grains[n];
            const double d = norm(box.separation(g.position, o.position));
            worst = std::max(worst, (g.radius + o.radius - d) / std::min(g.radius, o.radius));
        });
        grid.insert(g.position);
    }
    return worst;
}

struct Case {
    std::int64_t count;
    double fraction;
    bool periodic;
};

class Packing : public testing::TestWithParam<Case> {};

TEST_P(Packing, ReachesTheFractionWithoutOverlap) {
    const auto [count, fraction, periodic] = GetParam();
    const Scene scene = random_scene(count, fraction, periodic);
    const std::vector<GrainState> grains = initial_grains(scene);
    ASSERT_EQ(grains.size(), static_cast<std::size_t>(count));
    const Vec size = scene.domain.upper;
    EXPECT_NEAR(covered(grains) / (size.x * size.y), fraction, 0.01 * fraction);
    EXPECT_LE(worst_overlap(scene, grains), 0.01);
    if (periodic) return;
    for (const GrainState& g : grains) {
        EXPECT_GE(std::min(g.position.x, g.position.y), 0.999 * g.radius);
        EXPECT_LE(std::max(g.position.x, g.position.y), size.x - 0.999 * g.radius);
    }
}

INSTANTIATE_TEST_SUITE_P(Fractions, Packing,
                         testing::Values(Case{1000, 0.2, true}, Case{1000, 0.5, true}, Case{1000, 0.82, true},
                                         Case{1000, 0.2, false}, Case{1000, 0.5, false},
                                         Case{1000, 0.8, false}, Case{100000, 0.2, true},
                                         Case{100000, 0.5, true}, Case{100000, 0.82, true}),
                         [](const auto& param_info) {
                             return fmt::format("{}grains{:.0f}percent{}", param_info.param.count,
                                                100 * param_info.param.fraction,
                                                param_info.param.periodic ? "Periodic" : "Closed");
                         });

} // namespace

} // namespace sandlane::scene
