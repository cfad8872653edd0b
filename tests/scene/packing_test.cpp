// Random populations: packing fraction, overlaps, confinement, and errors for what does not fit.
#include "scene/initial_state.hpp"

#include "scene/cell_grid.hpp"
#include "scene/space.hpp"
#include "scene/wall_geometry.hpp"
#include "support.hpp"

#include <algorithm>
#include <cmath>

namespace sandlane::scene {

namespace {

// Area or volume of the grains.
double covered(const Scene& scene, const std::vector<GrainState>& grains) {
    double sum = 0;
    for (const GrainState& g : grains) sum += grain_content(g.radius, scene.domain.dimension);
    return sum;
}

// Radii +-10 %, mean 1, in a square or cube of the size that gives the packing fraction.
Scene random_scene(std::int64_t dimension, std::int64_t count, double fraction, bool periodic) {
    Scene scene;
    scene.materials.emplace_back().young = 1e8;
    const double power = static_cast<double>(dimension) + 1;
    const double mean_power = (std::pow(1.1, power) - std::pow(0.9, power)) / (0.2 * power);
    const double room = static_cast<double>(count) * mean_power * grain_content(1, dimension) / fraction;
    const double side = std::pow(room, 1 / static_cast<double>(dimension));
    scene.domain.dimension = dimension;
    scene.domain.upper = {side, side, dimension == 3 ? side : 0};
    scene.domain.periodic = {periodic, periodic, periodic && dimension == 3};
    Grains& g = scene.grains.emplace_back();
    g.kind = GrainKind::random;
    g.sizes = {SizeLaw::uniform, 0.9, 1.1};
    g.count = count;
    return scene;
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
    std::int64_t dimension, count;
    double fraction;
    bool periodic;
};

class Packing : public testing::TestWithParam<Case> {};

TEST_P(Packing, ReachesTheFractionWithoutOverlap) {
    const auto [dimension, count, fraction, periodic] = GetParam();
    const Scene scene = random_scene(dimension, count, fraction, periodic);
    const std::vector<GrainState> grains = initial_grains(scene);
    ASSERT_EQ(grains.size(), static_cast<std::size_t>(count));
    const Vec size = scene.domain.upper;
    EXPECT_NEAR(covered(scene, grains) / content(size, dimension), fraction, 0.01 * fraction);
    EXPECT_LE(worst_overlap(scene, grains), 0.01);
    if (periodic) return;
    for (const GrainState& g : grains)
        for (const AxisOfSpace& axis : axes(dimension)) {
            EXPECT_GE(g.position.*axis.component, 0.999 * g.radius);
            EXPECT_LE(g.position.*axis.component, size.*axis.component - 0.999 * g.radius);
        }
}

std::string case_name(const testing::TestParamInfo<Case>& info) {
    const Case& c = info.param;
    return fmt::format("{}grains{:.0f}percent{}{}", c.count, 100 * c.fraction,
                       c.periodic ? "Periodic" : "Closed", c.dimension == 3 ? "Space" : "");
}
INSTANTIATE_TEST_SUITE_P(Fractions, Packing,
                         testing::Values(Case{2, 1000, 0.2, true}, Case{2, 1000, 0.5, true},
                                         Case{2, 1000, 0.82, true}, Case{2, 1000, 0.2, false},
                                         Case{2, 1000, 0.5, false}, Case{2, 1000, 0.8, false},
                                         Case{3, 1000, 0.2, true}, Case{3, 1000, 0.34, true},
                                         Case{3, 1000, 0.6, true}, Case{3, 1000, 0.2, false},
                                         Case{3, 1000, 0.34, false}, Case{3, 1000, 0.55, false}),
                         case_name);
INSTANTIATE_TEST_SUITE_P(SlowFractions, Packing,
                         testing::Values(Case{2, 100000, 0.2, true}, Case{2, 100000, 0.5, true},
                                         Case{2, 100000, 0.82, true}, Case{3, 5000, 0.6, true}),
                         case_name);

// Small grains between large ones, 1:100 in the plane and 1:20 in space, denser than equal ones placed one by
// one come; every pair looked at.
TEST(WidePacking, FillsGapsWithSmallGrains) {
    for (const std::int64_t dimension : {2, 3})
        for (const bool periodic : {true, false}) {
            Scene scene = random_scene(dimension, 3000, 0.5, periodic);
            const Vec size = scene.domain.upper;
            const double side = size.x, large = dimension == 3 ? 0.16 * side : 0.2 * side;
            Grains& g = scene.grains[0];
            g.sizes = {SizeLaw::inverse_square, dimension == 3 ? large / 20 : large / 100, large};
            g.count = 0;
            g.packing_fraction = dimension == 3 ? 0.40 : 0.60;
            const std::vector<GrainState> grains = initial_grains(scene);
            const Box box(scene.domain);
            double worst = 0, smallest = large, largest = 0;
            for (std::size_t i = 0; i < grains.size(); ++i) {
                smallest = std::min(smallest, grains[i].radius);
                largest = std::max(largest, grains[i].radius);
                for (std::size_t j = 0; j < i; ++j) {
                    const double reach = grains[i].radius + grains[j].radius;
                    const double d = norm(box.separation(grains[i].position, grains[j].position));
                    worst = std::max(worst, (reach - d) / std::min(grains[i].radius, grains[j].radius));
                }
            }
            EXPECT_GT(largest, 10 * smallest);
            EXPECT_GT(grains.size(), 500U);
            EXPECT_LT(grains.size(), 10000U);
            EXPECT_LE(worst, 0.01) << dimension << periodic;
        }
}

TEST(DensePacking, OfSpheresFillsThinSlabs) {
    for (const double height : {2.2, 4.5, 7.0}) { // one layer of spheres of diameter 1.8 to 2.2, and a few
        SCOPED_TRACE(height);
        Scene scene = random_scene(3, 1000, 0.47, true);
        Vec& size = scene.domain.upper;
        const double side = std::sqrt(content(size, 3) / height);
        size = {side, side, height};
        scene.domain.periodic = {true, true, false};
        EXPECT_LE(worst_overlap(scene, initial_grains(scene)), 0.01);
    }
}

// Bond order of rank 6 (Steinhardt, Nelson, Ronchetti 1983) over pairs closer than 1.2 mean diameters: 0.575
// for the face-centred cubic lattice, 1/sqrt(bonds) for bonds in random directions.
double bond_order(const Scene& scene, const std::vector<GrainState>& grains) {
    const Box box(scene.domain);
    CellGrid grid(box, 2.4, grains.size());
    std::vector<Vec> bonds;
    for (const GrainState& g : grains) {
        grid.for_near(g.position, [&](std::size_t n) {
            const Vec d = box.separation(g.position, grains[n].position);
            if (norm(d) < 2.4) bonds.push_back((1 / norm(d)) * d);
        });
        grid.insert(g.position);
    }
    // The sum over m of |Y_6m|^2 is one over P_6 of the angles between bonds; some thousand bonds tell
    // enough.
    const std::size_t stride = std::max<std::size_t>(1, bonds.size() / 2000);
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < bonds.size(); i += stride)
        for (std::size_t j = 0; j < bonds.size(); j += stride) {
            sum += std::legendre(6U, std::clamp(dot(bonds[i], bonds[j]), -1.0, 1.0));
            ++count;
        }
    return std::sqrt(std::max(0.0, sum / count));
}

TEST(SlowDensePacking, OfSpheresIsNoCrystal) {
    Scene scene = random_scene(3, 4000, 0.6, true);
    Grains& g = scene.grains[0];
    g.sizes = {SizeLaw::constant, 1, 1};
    EXPECT_LT(bond_order(scene, initial_grains(scene)), 0.1);

    g.kind = GrainKind::lattice; // the measure sees a crystal
    g.counts = {5, 5, 12};
    g.spacing = {2, 2, std::sqrt(2.0)};
    g.staggered = true;
    scene.domain.upper = {10, 10, 12 * std::sqrt(2.0)};
    EXPECT_NEAR(bond_order(scene, initial_grains(scene)), 0.57452, 1e-4);
}

TEST(DensePacking, TooDenseIsRefusedWithWhatWasReachedSlow) {
    const Scene scene = random_scene(3, 200, 0.75, true); // more than any packing of equal spheres
    EXPECT_SAYS(refusal([&] { (void)initial_grains(scene); }), "do not fit without overlap; reached 0.");
}

TEST(DensePacking, FractionDecidesTheNumberOfSpheres) {
    Scene scene = random_scene(3, 500, 0.3, true);
    scene.grains[0].count = 0;
    scene.grains[0].packing_fraction = 0.3;
    const std::vector<GrainState> grains = initial_grains(scene);
    // One half of the largest grain at most.
    EXPECT_NEAR(covered(scene, grains), 0.3 * content(scene.domain.upper, 3), 0.5 * grain_content(1.1, 3));
}

} // namespace

} // namespace sandlane::scene
