// Grains of very different sizes: classes of radii, the grids of link cells made for them, and the lists made
// from these, against every pair looked at.
#include "core/rng.hpp"
#include "md/near_pairs.hpp"
#include "support/space_system.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

using namespace sandlane;
using scene::NeighbourMethod;

TEST(SizeClasses, AreOctavesOfTheSmallestRadius) {
    const auto classes = [](const std::vector<double>& radii) {
        return scene::size_classes(radii.size(), [&](std::size_t i) { return radii[i]; });
    };
    EXPECT_TRUE(classes({}).empty());
    ASSERT_EQ(classes({1, 1.9}).size(), 1U); // within `wide_ratio`
    EXPECT_EQ(classes({1, 1.9})[0].largest, 1.9);
    const auto wide = classes({100, 1.5, 1, 2, 64, 3.9, 127});
    ASSERT_EQ(wide.size(), 3U); // [1, 2), [2, 4), [64, 128); those between are empty
    EXPECT_EQ(wide[0].largest, 1.5);
    EXPECT_EQ(wide[0].grains, 2U);
    EXPECT_EQ(wide[1].largest, 3.9);
    EXPECT_EQ(wide[2].largest, 127);
    EXPECT_EQ(wide[2].grains, 3U);
    EXPECT_EQ(scene::class_of(wide, 1.5), 0U);
    EXPECT_EQ(scene::class_of(wide, 2), 1U);
    EXPECT_EQ(scene::class_of(wide, 100), 2U);
}

// A few large grains among few others: one grid serves all, and several would cost more.
TEST(SizeClasses, AreUsedWhereTheyPay) {
    scene::Scene s = test::lattice_scene(20, 20);
    std::vector<scene::GrainState> grains = test::lattice_grains(20, 20);
    grains[0].radius = 2.5; // its cell would hold 25/4 grains or so
    EXPECT_EQ(md::analyse(s, grains).sizes.size(), 1U);
    grains[0].radius = 10;
    const md::Needs needs = md::analyse(s, grains);
    ASSERT_EQ(needs.sizes.size(), 2U);
    EXPECT_EQ(needs.sizes[0].grains, 399U);
    EXPECT_EQ(needs.sizes[1].largest, 10);
}

namespace {

enum class Sides { open, periodic, sheared };

struct Mixture {
    scene::Scene scene;
    std::vector<scene::GrainState> grains;
};

// Large grains of radius about 1 apart from each other, some of a half and of a tenth, and small ones of a
// hundredth: half of them anywhere, half on the surface of the large ones. Overlaps are below 0.4 of the
// smallest radius.
class Maker {
public:
    Maker(int dimension, Sides sides)
        : dimension_(dimension), size_(sides == Sides::periodic ? Vec{3.75, 9, 4.3} : Vec{4.3, 4.3, 4.3}) {
        scene::Scene& s = mixture.scene;
        s = dimension == 3 ? test::space_scene(6) : test::lattice_scene();
        s.domain.lower = {0, 0, 0};
        s.domain.upper = {size_.x, size_.y, dimension == 3 ? size_.z : 0.0};
        const bool periodic = sides != Sides::open;
        s.domain.periodic = {periodic, periodic, periodic && dimension == 3};
        if (sides == Sides::sheared) s.domain.shear_rate = 0.7;
        s.domain.outside = scene::Outside::error;
        s.md.dt = 1e-6;
        for (int n = 0; n < 3; ++n) place(0.8 + 0.05 * n);
        for (int n = 0; n < 6; ++n) place(0.40 + 0.01 * n);
        for (int n = 0; n < 12; ++n) place(0.08 + 0.005 * n);
        for (int n = 0; n < 300; ++n) place(0.01 + 0.00001 * n);
        for (int n = 0; n < 300; ++n) place_on(static_cast<std::size_t>(n % 15), 0.01 + 0.00001 * n);
    }
    Mixture mixture;

private:
    double uniform() { return random_.uniform(counter_++); }
    bool fits(Vec p, double radius) const {
        const scene::Box box(mixture.scene.domain);
        for (const auto& g : mixture.grains)
            if (norm(box.separation(p, g.position)) < radius + g.radius - 0.004) return false;
        return true;
    }
    void add(Vec p, double radius) {
        scene::GrainState g;
        g.id = static_cast<std::int64_t>(mixture.grains.size());
        g.position = p;
        g.radius = radius;
        g.mass = radius * radius;
        g.velocity = {uniform() - 0.5, uniform() - 0.5, dimension_ == 3 ? uniform() - 0.5 : 0.0};
        mixture.grains.push_back(g);
    }
    void place(double radius) {
        const bool open = !mixture.scene.domain.periodic[0];
        const double margin = open ? radius : 0.0;
        const auto anywhere = [&](double length) { return margin + (length - 2 * margin) * uniform(); };
        for (int attempt = 0; attempt < 2000; ++attempt) {
            Vec p{anywhere(size_.x), anywhere(size_.y), 0};
            if (dimension_ == 3) p.z = anywhere(size_.z);
            if (fits(p, radius)) return add(p, radius);
        }
    }
    void place_on(std::size_t large, double radius) {
        const scene::GrainState& on = mixture.grains[large];
        for (int attempt = 0; attempt < 500; ++attempt) {
            Vec way{uniform() - 0.5, uniform() - 0.5, dimension_ == 3 ? uniform() - 0.5 : 0.0};
            Vec p = on.position + ((on.radius + radius * (0.8 + 0.4 * uniform())) / norm(way)) * way;
            const scene::Box box(mixture.scene.domain);
            p = box.wrapped(p);
            const auto inside = [](double x, double length) { return x > 0 && x < length; };
            if (!inside(p.x, size_.x) || !inside(p.y, size_.y) || (dimension_ == 3 && !inside(p.z, size_.z)))
                continue;
            if (fits(p, radius)) return add(p, radius);
        }
    }

    int dimension_;
    Vec size_; // a periodic box so narrow that large grains see all columns
    Random random_{1, Stream::position};
    std::uint64_t counter_ = 0;
};

struct Case {
    int dimension;
    Sides sides;
    NeighbourMethod method;
};

std::string case_name(const testing::TestParamInfo<Case>& info) {
    static const char* sides[] = {"open", "periodic", "sheared"};
    return std::string(info.param.dimension == 3 ? "space_" : "plane_") +
           sides[static_cast<int>(info.param.sides)] +
           (info.param.method == NeighbourMethod::verlet ? "_lists" : "_cells");
}

std::vector<Case> all_cases() {
    std::vector<Case> cases;
    for (const int dimension : {2, 3}) {
        for (const Sides sides : {Sides::open, Sides::periodic})
            for (const auto method : {NeighbourMethod::link_cells, NeighbourMethod::verlet})
                cases.push_back({dimension, sides, method});
        cases.push_back({dimension, Sides::sheared, NeighbourMethod::verlet});
    }
    return cases;
}

// Made once for the tests of a process.
const Mixture& mixture(int dimension, Sides sides) {
    static std::map<std::pair<int, Sides>, Mixture> made;
    const auto found = made.find({dimension, sides});
    if (found != made.end()) return found->second;
    return made.emplace(std::pair{dimension, sides}, Maker(dimension, sides).mixture).first->second;
}

// Every pair once, nearest image: contacts.
std::int64_t touching_pairs(const Mixture& m) {
    const scene::Box box(m.scene.domain);
    std::int64_t count = 0;
    for (std::size_t i = 0; i < m.grains.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (norm(box.separation(m.grains[i].position, m.grains[j].position)) <
                m.grains[i].radius + m.grains[j].radius)
                ++count;
    return count;
}

class WideRatios : public testing::TestWithParam<Case> {};

} // namespace

TEST_P(WideRatios, ForcesOfEveryPair) {
    const Case c = GetParam();
    const Mixture& m = mixture(c.dimension, c.sides);
    scene::Scene s = m.scene;
    s.md.neighbours = c.method;
    const md::Simulation sim = test::make_simulation(s, m.grains, simd::available_isas().back());
    const std::int64_t contacts = touching_pairs(m);
    EXPECT_GT(contacts, 100);
    EXPECT_EQ(sim.observe().contacts, contacts);
    // Without shear from the start: the seam stands at zero, where every pair is seen by all methods.
    const auto every_pair = sim.forces(simd::Isa::scalar, NeighbourMethod::brute_force);
    double largest = 0;
    for (const double f : every_pair) largest = std::max(largest, std::abs(f));
    for (const simd::Isa isa : simd::available_isas()) {
        const auto found = sim.forces(isa, c.method);
        ASSERT_EQ(found.size(), every_pair.size());
        double worst = 0;
        for (std::size_t n = 0; n < found.size(); ++n)
            worst = std::max(worst, std::abs(found[n] - every_pair[n]));
        // Sums of up to a hundred forces in another order.
        EXPECT_LT(worst, 1e-12 * largest) << simd::isa_name(isa);
    }
}

TEST_P(WideRatios, SameBitsForEveryIsaAndThreadCount) {
    const Case c = GetParam();
    const Mixture& m = mixture(c.dimension, c.sides);
    scene::Scene s = m.scene;
    s.md.neighbours = c.method;
    std::string reference;
    for (const simd::Isa isa : simd::available_isas())
        for (const int threads : {1, 3}) {
            if (isa == simd::Isa::scalar && threads > 1) continue;
            md::Simulation sim = test::make_simulation(s, m.grains, isa, threads);
            sim.run(40);
            const std::string hash = sim.state_hash().hex();
            if (reference.empty()) reference = hash;
            EXPECT_EQ(hash, reference) << simd::isa_name(isa) << " threads " << threads;
        }
}

// The lists hold every contact all the way: the forces after many steps are those of every pair.
TEST_P(WideRatios, ListsKeepUp) {
    const Case c = GetParam();
    if (c.method != NeighbourMethod::verlet || c.sides == Sides::sheared) return;
    scene::Scene s = mixture(c.dimension, c.sides).scene;
    s.md.neighbours = c.method;
    s.domain.outside = scene::Outside::remove;
    s.md.dt = 2e-5; // small grains move by several times the skin
    s.materials[0].stiffness = 100;
    s.materials[0].damping = s.materials[0].tangential_damping = 0.02;
    md::Simulation sim =
        test::make_simulation(s, mixture(c.dimension, c.sides).grains, simd::available_isas().back());
    for (int n = 0; n < 4; ++n) {
        sim.run(150);
        const auto every_pair = sim.forces(simd::Isa::scalar, NeighbourMethod::brute_force);
        const auto found = sim.forces(simd::available_isas().back(), c.method);
        double worst = 0, largest = 0;
        for (std::size_t k = 0; k < found.size(); ++k) {
            worst = std::max(worst, std::abs(found[k] - every_pair[k]));
            largest = std::max(largest, std::abs(every_pair[k]));
        }
        EXPECT_LT(worst, 1e-12 * largest) << n;
    }
}

INSTANTIATE_TEST_SUITE_P(All, WideRatios, testing::ValuesIn(all_cases()), case_name);
